// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "problem/world.hpp"

namespace photonav::test {

/// One world until it becomes another.
class ChangingViews : public ViewSource {
  public:
    ChangingViews(const World& before, const World& after, const bool& hasChanged)
        : before_(before), after_(after), hasChanged_(hasChanged) {}
    void render(const Camera& camera, const Pose& T_c_w, View& view) const override {
        (hasChanged_ ? after_ : before_).views().render(camera, T_c_w, view);
    }

  private:
    const World& before_;
    const World& after_;
    const bool& hasChanged_;
};

}  // namespace photonav::test
