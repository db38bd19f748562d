// SPDX-License-Identifier: BSD-3-Clause
// When tracking counts as lost, and where it was last certain.
#pragma once

#include <optional>

#include "flight.hpp"

namespace photonav {

class LostWatch {
  public:
    LostWatch(const LostOptions& options, const Pose& T_start_w)
        : options_(options), T_certain_w_(T_start_w) {}

    /// An image was aligned, or not. One that tells nothing but agrees with the map, because there
    /// is nothing to be seen or it looks alike in two places, is not lost: plans lead over white
    /// floors and along stripes, too.
    void onAlignment(double time, const Alignment& alignment) {
        lastImage_ = time;
        if (isLost(alignment.verdict)) {
            if (++badInRow_ >= options_.badImages) begin(time);
            return;
        }
        onFound(time);
        if (alignment.verdict == Verdict::converged) T_certain_w_ = alignment.T_c_w;
    }

    void onFound(double time) {
        badInRow_ = 0;
        if (since_) lost_ += time - *since_;
        since_.reset();
    }

    void onTime(double time) {
        if (time - lastImage_ > options_.blindTime) begin(time);
    }

    bool isLostNow() const { return since_.has_value(); }
    bool isHovering(double time) const { return since_ && time - *since_ < options_.hoverTime; }
    bool hasGivenUp(double time) const {
        return since_ && time - *since_ > options_.hoverTime + options_.giveUpTime;
    }

    /// Camera pose of the last image that told everything.
    const Pose& lastCertainView() const { return T_certain_w_; }

    double lostTime(double time) const { return lost_ + (since_ ? time - *since_ : 0.); }
    int timesLost() const { return timesLost_; }

  private:
    void begin(double time) {
        if (since_) return;
        since_ = time;
        ++timesLost_;
    }

    LostOptions options_;
    Pose T_certain_w_;
    double lastImage_ = 0.;
    int badInRow_ = 0;
    std::optional<double> since_;
    double lost_ = 0.;
    int timesLost_ = 0;
};

}  // namespace photonav
