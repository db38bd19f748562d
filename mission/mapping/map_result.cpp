// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/map_result.hpp"

#include <filesystem>
#include <map>
#include <string>

#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;
namespace {

namespace fs = std::filesystem;

/// Of the values that are numbers.
json meansOf(const json& compared) {
    json means = json::object();
    std::map<std::string, double> counts;
    for (const auto& frame : compared) {
        for (const auto& [key, value] : frame.items()) {
            if (key != "timestamp" && value.is_number()) ++counts[key];
        }
    }
    for (const auto& frame : compared) {
        for (const auto& [key, count] : counts) {
            if (frame[key].is_number()) {
                means[key] = means.value(key, 0.) + frame[key].get<double>() / count;
            }
        }
    }
    return means;
}

json datasetJson(const MapOptions& options, const Recording& recording) {
    const Sequence& sequence = recording.sequence;
    json camera = cameraJson(sequence.camera);
    camera["assumed"] = sequence.cameraAssumed;
    camera["depth_registered_here"] = sequence.depthCamera.has_value();
    const Eigen::Matrix3d R = worldUpRotation(recording.up);
    return {{"folder", fs::absolute(options.dataset).lexically_normal().string()},
            {"layout", recording.layout},
            {"stereo", recording.stereo.empty() ? json(nullptr) : json(recording.stereo)},
            {"note", recording.note},
            {"camera", camera},
            {"depth_scale", sequence.hasDepth() ? json(sequence.depthScale) : json(nullptr)},
            {"up", options.up},
            {"up_direction", vectorJson(recording.up)},
            {"tilt_degrees", tiltDegrees(recording.up)},
            {"map_from_recorded_rotation",
             {vectorJson(R.row(0)), vectorJson(R.row(1)), vectorJson(R.row(2))}}};
}

json framesJson(const MapOptions& options, const Recording& recording, const FusedRecording& run) {
    json skipped = json::array();
    for (const auto& list : {recording.sequence.skipped, run.black}) {
        for (const auto& [file, reason] : list) {
            skipped.push_back({{"file", file}, {"reason", reason}});
        }
    }
    return {{"recorded", recording.sequence.recorded},
            {"used", run.frames - run.black.size()},
            {"black", run.black.size()},
            {"every", options.every},
            {"range", options.frames},
            {"skipped", skipped}};
}

}  // namespace

nlohmann::json mapResult(const MapOptions& options, const Recording& recording,
                         const FusedRecording& run, const json& compared, bool interrupted) {
    return resultJson("map", {{"interrupted", interrupted},
                              {"dataset", datasetJson(options, recording)},
                              {"frames", framesJson(options, recording, run)},
                              {"depth", options.depth},
                              {"monocular", run.monocular},
                              {"resolution", options.resolution},
                              {"min_range", options.fusion.minRange},
                              {"max_range", options.fusion.maxRange},
                              {"comparison", {{"mean", meansOf(compared)}, {"frames", compared}}}});
}

json voxelsJson(const TexturedOcTree& map) {
    std::size_t free = 0;
    std::size_t occupied = 0;
    Eigen::AlignedBox3d box;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        const std::size_t cells = std::size_t(1) << (3 * (map.getTreeDepth() - leaf.getDepth()));
        if (!map.isNodeOccupied(*leaf)) {
            free += cells;
            continue;
        }
        occupied += cells;
        const Eigen::Vector3d center(leaf.getX(), leaf.getY(), leaf.getZ());
        const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * leaf.getSize());
        box.extend(center - half);
        box.extend(center + half);
    }
    json result = {{"occupied", occupied}, {"free", free}};
    if (!box.isEmpty()) result["bounds"] = {vectorJson(box.min()), vectorJson(box.max())};
    return result;
}

}  // namespace photonav
