// SPDX-License-Identifier: BSD-3-Clause
// The information expected of surfaces that are not in the map yet.
#pragma once

#include <memory>

#include "belief/view_models.hpp"

namespace photonav {

/// Predicts the information of unknown space: a running average over about the last 20 views of the
/// flight. In the paper, unknown space has no information; its prediction is named as future work.
class UnseenInformation {
  public:
    /// Adds a view of the map from a pose of the flight. Views in which less than half of the
    /// pixels show a surface are ignored.
    /// @param information of the view, from its pixels with a surface, camera frame
    void observe(const View& shown, const Matrix6& information);

    /// A model that adds the expected information for the pixels of a view without a surface. The
    /// expectation is the one at the time at which the model is evaluated. The model may outlive
    /// this object.
    InformationModel complete(InformationModel model) const;

    /// Expected information of a view in which all pixels show a surface, camera frame; zero before
    /// the first observation.
    const Matrix6& expected() const { return *expected_; }

  private:
    std::shared_ptr<Matrix6> expected_ = std::make_shared<Matrix6>(Matrix6::Zero());
    int views_ = 0;
};

}  // namespace photonav
