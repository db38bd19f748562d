// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay_errors.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/se3.hpp"

namespace photonav {
namespace {

/// Covariance of the difference of a belief and its true pose by the errors of true poses: of this
/// one, and of the one at which odometry was made equal to the truth.
Matrix6 covarianceByTruth(const ReplayRun& run, const Pose& T_c_w) {
    const auto tie = std::ranges::find_if(
        run.frames, [&](const ReplayedFrame& frame) { return run.alignedFrame == frame.index; });
    if (tie == run.frames.end()) return run.truthCovariance;
    const Matrix6 toCamera = adjoint(T_c_w * tie->tracked.T_c_w.mean.inverse());
    return run.truthCovariance + toCamera * run.truthCovariance * toCamera.transpose();
}

EvaluatedFrame evaluateFrame(const ReplayRun& run, std::size_t i, bool beginsTrue) {
    const ReplayedFrame& frame = run.frames[i];
    const UncertainPose& belief = frame.tracked.T_c_w;
    EvaluatedFrame result;
    result.frame = i;
    result.pair = {frame.index, frame.timestamp, belief.mean.inverse(), frame.truth_c_w->inverse()};
    const PoseErrors errors = absoluteErrors({result.pair});
    result.positionError = errors.translation[0];
    result.rotationError = errors.rotation[0];
    result.positionSigma = std::sqrt(belief.covariance.diagonal().head<3>().sum());
    result.rotationSigma = std::sqrt(belief.covariance.diagonal().tail<3>().sum());
    const bool isEqual = run.alignedFrame == frame.index;  // by definition
    if (beginsTrue && !isEqual) {
        result.normalised =
            normalisedError({belief.mean, belief.covariance + covarianceByTruth(run, belief.mean)},
                            *frame.truth_c_w);
    }
    return result;
}

}  // namespace

ReplayErrors evaluate(const ReplayRun& run) {
    ReplayErrors errors;
    const auto first = firstRead(run);
    const bool beginsTrue = !run.odometry || (first != run.frames.end() && first->truth_c_w);
    std::vector<PosePair> pairs;
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        const ReplayedFrame& frame = run.frames[i];
        if (frame.status != FrameStatus::tracked || !frame.truth_c_w) continue;
        errors.frames.push_back(evaluateFrame(run, i, beginsTrue));
        pairs.push_back(errors.frames.back().pair);
    }
    if (pairs.empty()) return errors;
    if (run.odometry) {
        errors.absolute.translation = absoluteErrors(pairs, positionAlignment(pairs)).translation;
        errors.absolute.rotation = absoluteErrors(pairs, alignmentOf(pairs)).rotation;
    } else {
        errors.absolute = absoluteErrors(pairs);
    }
    errors.perFrame = relativeErrors(pairs, Spacing::frames, 1.);
    errors.perSecond = relativeErrors(pairs, Spacing::seconds, 1.);
    errors.perMetre = relativeErrors(pairs, Spacing::metres, 1.);
    return errors;
}

}  // namespace photonav
