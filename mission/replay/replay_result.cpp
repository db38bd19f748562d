// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <set>

#include "evaluation/averages.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

using nlohmann::json;

constexpr double kDegrees = 180. / std::numbers::pi;

std::size_t count(const ReplayRun& run, FrameStatus status) {
    return static_cast<std::size_t>(
        std::count_if(run.frames.begin(), run.frames.end(),
                      [status](const ReplayedFrame& f) { return f.status == status; }));
}

json summaryJson(const PoseErrors& errors) {
    if (errors.translation.empty()) return nullptr;
    const ErrorSummary t = summarise(errors.translation);
    const ErrorSummary r = summarise(errors.rotation);
    return {{"translation_m", t.rmse},
            {"rotation_deg", kDegrees * r.rmse},
            {"pairs", t.count},
            {"median_translation_m", t.median},
            {"median_rotation_deg", kDegrees * r.median},
            {"p90_translation_m", t.p90},
            {"p90_rotation_deg", kDegrees * r.p90}};
}

std::vector<double> neesOf(const ReplayErrors& errors, double NormalisedError::*part) {
    std::vector<double> all;
    for (const EvaluatedFrame& frame : errors.frames) {
        if (frame.normalised) all.push_back((*frame.normalised).*part);
    }
    return all;
}

json meanAndMedian(const std::vector<double>& values) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {{"mean", finiteOrNull(mean(values, none))},
            {"median", finiteOrNull(median(values, none))}};
}

bool isBeyond5Sigma(const EvaluatedFrame& frame) {
    return frame.normalised && frame.normalised->largest > 5.;
}

/// Of the frames that converged.
std::size_t countConvergedBeyond(const ReplayRun& run, const ReplayErrors& errors) {
    return static_cast<std::size_t>(
        std::ranges::count_if(errors.frames, [&](const EvaluatedFrame& f) {
            return isBeyond5Sigma(f) &&
                   run.frames[f.frame].tracked.alignment.verdict == Verdict::converged;
        }));
}

json framesPerSecond(double frames, double seconds) {
    return frames > 0. && seconds > 0. ? json(frames / seconds) : json(nullptr);
}

/// Mean share of the pixels with depth, of the images that could be read.
json densityJson(const ReplayRun& run) {
    double sum = 0.;
    int n = 0;
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.status == FrameStatus::unreadable) continue;
        sum += frame.density;
        ++n;
    }
    return n > 0 && sum > 0. ? json(sum / n) : json(nullptr);
}

json intervalsJson(const std::vector<TimeInterval>& intervals) {
    json list = json::array();
    for (const auto& [from, to] : intervals) list.push_back({from, to});
    return list;
}

json skippedJson(const Sequence& sequence, const ReplayRun& run) {
    json list = json::array();
    for (const auto& [file, reason] : sequence.skipped) {
        list.push_back({{"file", file}, {"reason", reason}});
    }
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.status != FrameStatus::unreadable) continue;
        const std::string& file = sequence.frames[frame.index].colourFile;
        std::string reason = frame.message;
        if (reason.starts_with(file + ": ")) reason.erase(0, file.size() + 2);
        list.push_back({{"file", file}, {"reason", reason}});
    }
    return list;
}

constexpr const char* kOverlapHint =
    "; a smaller --min-overlap accepts images that show less of the map";

bool isLostFrame(const ReplayedFrame& frame) { return frame.status == FrameStatus::lost; }

bool isShortOfOverlap(const ReplayedFrame& frame) {
    return frame.tracked.alignment.verdict == Verdict::lostOverlap;
}

std::size_t countBlack(const ReplayRun& run) {
    return static_cast<std::size_t>(
        std::count_if(run.frames.begin(), run.frames.end(),
                      [](const ReplayedFrame& f) { return isLostFrame(f) && f.isBlack; }));
}

std::string whyLostAtOnce(const ReplayRun& run, std::size_t lost) {
    if (countBlack(run) == lost) {
        return fmt::format("all {} images{} are black", lost, run.interrupted ? " so far" : "");
    }
    const auto first =
        std::find_if(run.frames.begin(), run.frames.end(),
                     [](const ReplayedFrame& f) { return isLostFrame(f) && !f.isBlack; });
    std::string text = run.stopped.empty() ? "" : run.stopped + "; ";
    text += first == run.frames.begin() ? "first image: " : fmt::format("image {}: ", first->index);
    text += first->message;
    if (isShortOfOverlap(*first)) text += kOverlapHint;
    if (!run.odometry)
        text += "; check that start pose and map use the same world frame (--up, --start)";
    return text;
}

/// Whether an alignment of the trajectory would hide its errors.
bool isTooShortToAlign(const ReplayRun& run, const ReplayErrors& errors) {
    constexpr std::size_t kLeast = 3;  // fewer poses are aligned nearly exactly, wherever they are
    return run.odometry && errors.frames.size() < kLeast;
}

}  // namespace

std::vector<TimeInterval> lostIntervals(const ReplayRun& run) {
    std::vector<TimeInterval> intervals;
    bool wasLost = false;
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.status == FrameStatus::unreadable) continue;
        const bool isLost = frame.status == FrameStatus::lost;
        if (isLost && !wasLost) intervals.push_back({frame.timestamp, frame.timestamp});
        if (isLost) intervals.back().second = frame.timestamp;
        wasLost = isLost;
    }
    return intervals;
}

std::vector<TimeInterval> gaps(const Sequence& sequence) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < sequence.frames.size(); ++i) {
        steps.push_back(sequence.frames[i].timestamp - sequence.frames[i - 1].timestamp);
    }
    const double usual = median(steps, 0.);
    std::vector<TimeInterval> result;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (steps[i] > 3. * usual) {
            result.push_back({sequence.frames[i].timestamp, sequence.frames[i + 1].timestamp});
        }
    }
    return result;
}

bool isLostForGood(const ReplayRun& run) {
    for (auto frame = run.frames.rbegin(); frame != run.frames.rend(); ++frame) {
        if (frame->status != FrameStatus::unreadable) return frame->status == FrameStatus::lost;
    }
    return !run.interrupted;
}

/// Tracked images that do not determine all directions.
std::ptrdiff_t countDegenerate(const ReplayRun& run) {
    return std::ranges::count_if(run.frames, [](const ReplayedFrame& frame) {
        return frame.status == FrameStatus::tracked &&
               frame.tracked.alignment.verdict == Verdict::degenerate;
    });
}

std::string verdictOf(const ReplayRun& run) {
    const std::size_t tracked = count(run, FrameStatus::tracked);
    const std::size_t lost = count(run, FrameStatus::lost);
    if (tracked == 0 && lost > 0) return "lost at once: " + whyLostAtOnce(run, lost);
    std::string text = fmt::format("tracked {} of {} frames", tracked, run.frames.size());
    if (const auto degenerate = countDegenerate(run); degenerate > 0) {
        text += fmt::format(" ({} degenerate)", degenerate);
    }
    if (lost > 0) text += fmt::format(", lost {}", lost);
    const std::size_t black = countBlack(run);
    if (black > 0) text += fmt::format(" ({} of them black)", black);
    const std::size_t unreadable = count(run, FrameStatus::unreadable);
    if (unreadable > 0) text += fmt::format(", unreadable {}", unreadable);
    if (isLostForGood(run) && lost > 0) {
        text += fmt::format(", and for good from {:.3f} s on", lostIntervals(run).back().first);
        const auto last = std::find_if(run.frames.rbegin(), run.frames.rend(), isLostFrame);
        if (isShortOfOverlap(*last)) text += ": " + last->message + kOverlapHint;
    }
    return text;
}

json replayResult(const Sequence& sequence, const ReplayRun& run, const ReplayErrors& errors) {
    const auto tracked = count(run, FrameStatus::tracked);
    const auto lost = count(run, FrameStatus::lost);
    const double looked = tracked > 0 ? double(tracked + lost) : 0.;
    const ErrorSummary absolute = summarise(errors.absolute.translation);
    const bool evaluated = !errors.frames.empty() && !isTooShortToAlign(run, errors);
    const std::vector<double> nees = neesOf(errors, &NormalisedError::pose);
    const double none = std::numeric_limits<double>::quiet_NaN();
    std::set<double> keyframes;
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.tracked.keyframe) keyframes.insert(*frame.tracked.keyframe);
    }
    return {{"verdict", verdictOf(run)},
            {"frames", run.frames.size()},
            {"recorded", sequence.recorded},
            {"tracked", tracked},
            {"degenerate", countDegenerate(run)},
            {"lost", lost},
            {"unreadable", count(run, FrameStatus::unreadable)},
            {"keyframes", keyframes.size()},
            {"lost_intervals", intervalsJson(lostIntervals(run))},
            {"gaps", intervalsJson(gaps(sequence))},
            {"judged", errors.frames.size()},
            {"aligned_frame", run.alignedFrame ? json(*run.alignedFrame) : json(nullptr)},
            {"ate_rmse_m", evaluated ? json(absolute.rmse) : json(nullptr)},
            {"ate_max_m", evaluated ? json(absolute.max) : json(nullptr)},
            {"ate_median_m", evaluated ? json(absolute.median) : json(nullptr)},
            {"ate_rotation_rmse_deg",
             evaluated ? json(kDegrees * summarise(errors.absolute.rotation).rmse) : json(nullptr)},
            {"ate_alignment", run.odometry ? "SE(3), by the positions" : "none"},
            {"rpe",
             {{"frame", summaryJson(errors.perFrame)},
              {"second", summaryJson(errors.perSecond)},
              {"metre", summaryJson(errors.perMetre)}}},
            {"nees_per_dof", finiteOrNull(mean(nees, none))},
            {"nees_median_per_dof", finiteOrNull(median(nees, none))},
            {"nees_position_per_dof", meanAndMedian(neesOf(errors, &NormalisedError::position))},
            {"nees_rotation_per_dof", meanAndMedian(neesOf(errors, &NormalisedError::rotation))},
            {"beyond_5_sigma", std::ranges::count_if(errors.frames, isBeyond5Sigma)},
            {"converged_beyond_5_sigma", countConvergedBeyond(run, errors)},
            {"fps", framesPerSecond(looked, run.trackSeconds)},
            {"fps_with_reading", framesPerSecond(looked, run.trackSeconds + run.loadSeconds)},
            {"depth_density", densityJson(run)},
            {"skipped", skippedJson(sequence, run)},
            {"covariance_frame",
             "camera, left perturbation T_c_w = exp(xi) mean, order (rho, phi), upper triangle by "
             "rows"}};
}

}  // namespace photonav
