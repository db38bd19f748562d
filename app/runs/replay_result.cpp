// SPDX-License-Identifier: BSD-3-Clause
#include "runs/replay_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "evaluation/averages.hpp"
#include "io/atomic_file.hpp"
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

JudgedFrame judgeFrame(const ReplayRun& run, std::size_t i, bool beginsTrue) {
    const ReplayedFrame& frame = run.frames[i];
    const UncertainPose& belief = frame.tracked.T_c_w;
    JudgedFrame result;
    result.frame = i;
    result.pair = {frame.index, frame.timestamp, belief.mean.inverse(), frame.truth_c_w->inverse()};
    const PoseErrors errors = absoluteErrors({result.pair});
    result.positionError = errors.translation[0];
    result.rotationError = errors.rotation[0];
    result.positionSigma = std::sqrt(belief.covariance.diagonal().head<3>().sum());
    result.rotationSigma = std::sqrt(belief.covariance.diagonal().tail<3>().sum());
    if (beginsTrue) result.nees = squaredNormalisedError(belief, *frame.truth_c_w);
    if (result.nees) *result.nees /= 6.;
    return result;
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

std::vector<double> neesOf(const ReplayErrors& errors) {
    std::vector<double> all;
    for (const JudgedFrame& frame : errors.judged) {
        if (frame.nees) all.push_back(*frame.nees);
    }
    return all;
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

json skippedJson(const ReplaySource& source, const ReplayRun& run) {
    json list = json::array();
    for (const auto& [file, reason] : source.skipped) {
        list.push_back({{"file", file}, {"reason", reason}});
    }
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.status != FrameStatus::unreadable) continue;
        const std::string& file = source.frames[frame.index].file;
        std::string reason = frame.words;
        if (reason.starts_with(file + ": ")) reason.erase(0, file.size() + 2);
        list.push_back({{"file", file}, {"reason", reason}});
    }
    return list;
}

const char* nameOf(FrameStatus status) {
    switch (status) {
        case FrameStatus::tracked:
            return "tracked";
        case FrameStatus::lost:
            return "lost";
        case FrameStatus::unreadable:
            break;
    }
    return "unreadable";
}

constexpr const char* kOverlapHint = "; a smaller --min-overlap asks for less";

bool isLostFrame(const ReplayedFrame& frame) { return frame.status == FrameStatus::lost; }

bool isShortOfOverlap(const ReplayedFrame& frame) {
    return frame.tracked.alignment.verdict == Verdict::lostOverlap;
}

std::size_t countBlack(const ReplayRun& run) {
    return static_cast<std::size_t>(
        std::count_if(run.frames.begin(), run.frames.end(),
                      [](const ReplayedFrame& f) { return isLostFrame(f) && f.isBlack; }));
}

std::string whyLostAtOnce(const ReplayRun& run, std::size_t lost, bool inMap) {
    if (countBlack(run) == lost) {
        return fmt::format("all {} images{} are black", lost, run.interrupted ? " so far" : "");
    }
    const auto first =
        std::find_if(run.frames.begin(), run.frames.end(),
                     [](const ReplayedFrame& f) { return isLostFrame(f) && !f.isBlack; });
    std::string text = run.stopped.empty() ? "" : run.stopped + "; ";
    text += first == run.frames.begin() ? "first image: " : fmt::format("image {}: ", first->index);
    text += first->words;
    if (isShortOfOverlap(*first)) text += kOverlapHint;
    if (inMap) text += "; poses and map must share a world (--up, --start)";
    return text;
}

/// Quoted: file names and verdicts may have commas.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

std::string row(const ReplayedFrame& frame, const JudgedFrame* judged) {
    const std::optional<double>& keyframe = frame.tracked.keyframe;
    std::string line =
        fmt::format("{},{:.6f},{},{}", frame.index, frame.timestamp, nameOf(frame.status),
                    keyframe ? fmt::format("{:.6f}", *keyframe) : "");
    if (frame.status == FrameStatus::unreadable) {
        line += ",,,,,,,";
    } else {
        const Alignment& a = frame.tracked.alignment;
        line += fmt::format(",{},{:.4f},{:.6f},{:.4f},{:.5f},{:.5f},{:.3f}", a.iterations,
                            a.overlap, a.residual.rms, a.residual.unexplained, a.exposure.gain,
                            a.exposure.offset, 1e3 * frame.seconds);
    }
    if (judged) {
        line += fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g},{}", judged->positionError,
                            kDegrees * judged->rotationError, judged->positionSigma,
                            kDegrees * judged->rotationSigma,
                            judged->nees ? fmt::format("{:.6g}", *judged->nees) : "");
    } else {
        line += ",,,,,";
    }
    return line + "," + quoted(frame.words) + "\n";
}

}  // namespace

ReplayErrors judge(const ReplayRun& run, bool odometry) {
    ReplayErrors errors;
    const auto first = firstRead(run);
    const bool beginsTrue = !odometry || (first != run.frames.end() && first->truth_c_w);
    std::vector<PosePair> pairs;
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        const ReplayedFrame& frame = run.frames[i];
        if (frame.status != FrameStatus::tracked || !frame.truth_c_w) continue;
        errors.judged.push_back(judgeFrame(run, i, beginsTrue));
        pairs.push_back(errors.judged.back().pair);
    }
    if (pairs.empty()) return errors;
    if (odometry) {
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

std::vector<TimeInterval> gaps(const ReplaySource& source) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < source.frames.size(); ++i) {
        steps.push_back(source.frames[i].timestamp - source.frames[i - 1].timestamp);
    }
    const double usual = median(steps, 0.);
    std::vector<TimeInterval> result;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (steps[i] > 3. * usual) {
            result.push_back({source.frames[i].timestamp, source.frames[i + 1].timestamp});
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

std::string verdictOf(const ReplayRun& run, bool inMap) {
    const std::size_t tracked = count(run, FrameStatus::tracked);
    const std::size_t lost = count(run, FrameStatus::lost);
    if (tracked == 0 && lost > 0) return "lost at once: " + whyLostAtOnce(run, lost, inMap);
    std::string text = fmt::format("tracked {} of {} frames", tracked, run.frames.size());
    if (lost > 0) text += fmt::format(", lost {}", lost);
    const std::size_t black = countBlack(run);
    if (black > 0) text += fmt::format(" ({} of them black)", black);
    const std::size_t unreadable = count(run, FrameStatus::unreadable);
    if (unreadable > 0) text += fmt::format(", unreadable {}", unreadable);
    if (isLostForGood(run) && lost > 0) {
        text += fmt::format(", and for good from {:.3f} s on", lostIntervals(run).back().first);
        const auto last = std::find_if(run.frames.rbegin(), run.frames.rend(), isLostFrame);
        if (isShortOfOverlap(*last)) text += ": " + last->words + kOverlapHint;
    }
    return text;
}

std::vector<StampedBelief> beliefsOf(const ReplayRun& run) {
    std::vector<StampedBelief> beliefs;
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.status != FrameStatus::tracked) continue;
        beliefs.push_back({frame.timestamp, frame.tracked.T_c_w});
    }
    return beliefs;
}

json replayResult(const ReplaySource& source, const ReplayRun& run, const ReplayErrors& errors,
                  bool aligned) {
    const auto tracked = count(run, FrameStatus::tracked);
    const auto lost = count(run, FrameStatus::lost);
    const double looked = tracked > 0 ? double(tracked + lost) : 0.;
    const ErrorSummary absolute = summarise(errors.absolute.translation);
    const bool judged = !errors.judged.empty();
    const std::vector<double> nees = neesOf(errors);
    const double none = std::numeric_limits<double>::quiet_NaN();
    const auto degenerate = std::count_if(run.frames.begin(), run.frames.end(), [](const auto& f) {
        return f.status == FrameStatus::tracked &&
               f.tracked.alignment.verdict == Verdict::degenerate;
    });
    std::set<double> keyframes;
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.tracked.keyframe) keyframes.insert(*frame.tracked.keyframe);
    }
    return {{"verdict", verdictOf(run, !aligned)},
            {"frames", run.frames.size()},
            {"recorded", source.recorded},
            {"tracked", tracked},
            {"degenerate", degenerate},
            {"lost", lost},
            {"unreadable", count(run, FrameStatus::unreadable)},
            {"keyframes", keyframes.size()},
            {"lost_intervals", intervalsJson(lostIntervals(run))},
            {"gaps", intervalsJson(gaps(source))},
            {"judged", errors.judged.size()},
            {"laid_on_frame", run.laidOn ? json(*run.laidOn) : json(nullptr)},
            {"ate_rmse_m", judged ? json(absolute.rmse) : json(nullptr)},
            {"ate_max_m", judged ? json(absolute.max) : json(nullptr)},
            {"ate_median_m", judged ? json(absolute.median) : json(nullptr)},
            {"ate_rotation_rmse_deg",
             judged ? json(kDegrees * summarise(errors.absolute.rotation).rmse) : json(nullptr)},
            {"ate_alignment", aligned ? "SE(3), by the positions" : "none"},
            {"rpe",
             {{"frame", summaryJson(errors.perFrame)},
              {"second", summaryJson(errors.perSecond)},
              {"metre", summaryJson(errors.perMetre)}}},
            {"nees_per_dof", finiteOrNull(mean(nees, none))},
            {"nees_median_per_dof", finiteOrNull(median(nees, none))},
            {"fps", framesPerSecond(looked, run.trackSeconds)},
            {"fps_with_reading", framesPerSecond(looked, run.trackSeconds + run.loadSeconds)},
            {"depth_density", densityJson(run)},
            {"skipped", skippedJson(source, run)},
            {"covariance_frame",
             "camera, left perturbation T_c_w = exp(xi) mean, order (rho, phi), upper triangle by "
             "rows"}};
}

void writeReplayTables(const std::filesystem::path& folder, const ReplayRun& run,
                       const ReplayErrors& errors) {
    std::string csv =
        "frame,timestamp_s,status,keyframe_s,iterations,overlap,residual_rms,unexplained,gain,"
        "offset,"
        "time_ms,position_error_m,rotation_error_deg,position_sigma_m,rotation_sigma_deg,"
        "nees_per_dof,verdict\n";
    auto judged = errors.judged.begin();
    Trajectory truth;
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        const bool isJudged = judged != errors.judged.end() && judged->frame == i;
        csv += row(run.frames[i], isJudged ? &*judged : nullptr);
        if (isJudged) ++judged;
        if (run.frames[i].truth_c_w) {
            truth.push_back({run.frames[i].timestamp, run.frames[i].truth_c_w->inverse()});
        }
    }
    writeFileAtomically(folder / "frames.csv", csv);
    const std::vector<StampedBelief> beliefs = beliefsOf(run);
    const auto file = [&](const char* name) { return (folder / name).string(); };
    writeTrajectory(file("trajectory.tum"), meansOf(beliefs));
    writeCovariances(file("trajectory.cov"), beliefs);
    writeOpenVinsTrajectory(file("trajectory.ov"), beliefs);
    if (!truth.empty()) writeTrajectory(file("groundtruth.tum"), truth);
}

}  // namespace photonav
