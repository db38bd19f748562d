// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay_calibration.hpp"

#include "geometry/se3.hpp"

namespace photonav {

std::vector<AlignmentError> alignmentErrors(const ReplayRun& run) {
    std::vector<AlignmentError> errors;
    for (const ReplayedFrame& frame : run.frames) {
        const Alignment& alignment = frame.tracked.alignment;
        if (frame.status != FrameStatus::tracked || !frame.truth_c_w ||
            alignment.verdict != Verdict::converged ||
            alignment.information.diagonal().minCoeff() <= 0.) {
            continue;
        }
        Pose sinceKeyframe = Pose::Identity();
        Pose truth = *frame.truth_c_w;
        Pose estimate = frame.tracked.T_c_w.mean;
        if (run.odometry) {
            const ReplayedFrame& keyframe = frameAt(run, *frame.tracked.keyframe);
            if (!keyframe.truth_c_w) continue;
            truth = truth * keyframe.truth_c_w->inverse();
            estimate = estimate * keyframe.tracked.T_c_w.mean.inverse();
            sinceKeyframe = estimate;
        }
        errors.push_back(
            {deviation(truth, estimate), alignment.information / run.scale, sinceKeyframe});
    }
    return errors;
}

std::optional<Calibration> calibrationOf(const ReplayRun& run, bool leastSigmaOnly) {
    const auto errors = alignmentErrors(run);
    if (errors.size() < kLeastForCalibration) return {};
    return leastSigmaOnly ? calibrateLeastSigma(errors, run.scale) : calibrate(errors);
}

std::optional<double> depthErrorOf(const ReplayRun& run, double counted) {
    const auto errors = alignmentErrors(run);
    if (!run.odometry || errors.size() < kLeastForCalibration) return {};
    return calibrateDepthError(errors, counted);
}

}  // namespace photonav
