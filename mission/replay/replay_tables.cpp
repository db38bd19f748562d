// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay_tables.hpp"

#include <fmt/format.h>

#include "dataset/trajectory.hpp"
#include "geometry/constants.hpp"
#include "io/atomic_file.hpp"

namespace photonav {
namespace {

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

/// Quoted: file names and verdicts may have commas.
std::string csvField(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

std::string row(const ReplayedFrame& frame, const EvaluatedFrame* evaluated) {
    const std::optional<double>& keyframe = frame.tracked.keyframe;
    std::string line =
        fmt::format("{},{:.6f},{},{}", frame.index, frame.timestamp, nameOf(frame.status),
                    keyframe ? fmt::format("{:.6f}", *keyframe) : "");
    if (frame.status == FrameStatus::unreadable) {
        line += ",,,,,,,,";
    } else {
        const Alignment& a = frame.tracked.alignment;
        const std::optional<SharedTexture>& texture = a.residual.texture;
        line += fmt::format(",{},{:.4f},{:.6f},{:.4f},{},{:.5f},{:.5f},{:.3f}", a.iterations,
                            a.overlap, a.residual.rms, a.residual.unexplained,
                            texture ? fmt::format("{:.3f}", texture->share) : "", a.exposure.gain,
                            a.exposure.offset, 1e3 * frame.seconds);
    }
    if (evaluated) {
        line += fmt::format(
            ",{:.6g},{:.6g},{:.6g},{:.6g},{}", evaluated->positionError,
            evaluated->rotationError / kDegree, evaluated->positionSigma,
            evaluated->rotationSigma / kDegree,
            evaluated->normalised ? fmt::format("{:.6g}", evaluated->normalised->pose) : "");
    } else {
        line += ",,,,,";
    }
    return line + "," + csvField(frame.message) + "\n";
}

}  // namespace

std::vector<StampedBelief> beliefsOf(const ReplayRun& run) {
    std::vector<StampedBelief> beliefs;
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.status != FrameStatus::tracked) continue;
        beliefs.push_back({frame.timestamp, frame.tracked.T_c_w});
    }
    return beliefs;
}

void writeReplayTables(const std::filesystem::path& folder, const ReplayRun& run,
                       const ReplayErrors& errors) {
    std::string csv =
        "frame,timestamp_s,status,keyframe_s,iterations,overlap,residual_rms,unexplained,texture,"
        "gain,offset,"
        "time_ms,position_error_m,rotation_error_deg,position_sigma_m,rotation_sigma_deg,"
        "nees_per_dof,verdict\n";
    auto evaluated = errors.frames.begin();
    Trajectory truth;
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        const bool hasTruth = evaluated != errors.frames.end() && evaluated->frame == i;
        csv += row(run.frames[i], hasTruth ? &*evaluated : nullptr);
        if (hasTruth) ++evaluated;
        if (run.frames[i].truth_c_w) {
            truth.push_back({run.frames[i].timestamp, run.frames[i].truth_c_w->inverse()});
        }
    }
    writeFileAtomically(folder / "frames.csv", csv);
    const std::vector<StampedBelief> beliefs = beliefsOf(run);
    const auto file = [&](const char* name) { return (folder / name).string(); };
    writeTrajectory(file("trajectory.tum"), meansOf(beliefs));
    writeKittiTrajectory(file("trajectory.kitti"), meansOf(beliefs));
    writeCovariances(file("trajectory.cov"), beliefs);
    writeOpenVinsTrajectory(file("trajectory.ov"), beliefs);
    if (!truth.empty()) writeTrajectory(file("groundtruth.tum"), truth);
}

}  // namespace photonav
