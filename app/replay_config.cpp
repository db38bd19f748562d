// SPDX-License-Identifier: BSD-3-Clause
#include "replay_config.hpp"

#include <fmt/format.h>

#include "constants.hpp"
#include "recording_config.hpp"

namespace photonav {
namespace {

constexpr double kLeast = 1e-12;

void readOptional(YamlMap& yaml, const char* key, std::optional<double>& value, double least) {
    if (yaml.has(key)) yaml.readNumber(key, value.emplace(least), least, kInfinity);
}

}  // namespace

std::string toYaml(const ReplayOptions& o, const ReplaySource& source,
                   const ReplayTracker& tracker) {
    const RecordingOptions& given = o;
    RecordingOptions recording = given;
    recording.stereo = source.stereo;
    std::string text = toYaml(recording);
    if (!o.mapFile.empty()) text += fmt::format("map: {}\n", absolutePath(o.mapFile));
    text += fmt::format("odometry: {}\n", o.odometry);
    if (!o.odometry) text += fmt::format("start_sigma: {}\n", o.startSigma.value_or(kStartSigma));
    if (!o.start.empty()) text += fmt::format("start: {}\n", YAML::Dump(YAML::Node(o.start)));
    if (o.maxWidth) text += fmt::format("max_width: {}\n", *o.maxWidth);
    return text + fmt::format(
                      "sigma: {}\nscale: {}\nfloor: {}\n"
                      "floor_rotation: {}\nmin_overlap: {}\nexposure: {}\ncalibrate: {}\n",
                      o.sigma, tracker.scale, tracker.trust.floorTranslation,
                      tracker.trust.floorRotation, o.minOverlap, o.exposure, o.calibrate);
}

void readReplayConfig(const std::string& file, ReplayOptions& options) {
    YamlMap yaml(file, loadYaml(file));
    readRecordingKeys(yaml, options);
    yaml.read("map", options.mapFile);
    options.mapFile = resolvedPath(options.mapFile, file);
    yaml.read("odometry", options.odometry);
    yaml.read("start", options.start);
    readOptional(yaml, "start_sigma", options.startSigma, kLeast);
    yaml.readNumber("sigma", options.sigma, kLeast, kInfinity);
    readOptional(yaml, "scale", options.scale, kLeast);
    readOptional(yaml, "floor", options.floorTranslation, 0.);
    readOptional(yaml, "floor_rotation", options.floorRotation, 0.);
    yaml.readNumber("min_overlap", options.minOverlap, kLeast, 1. - kLeast);
    if (yaml.has("max_width")) {
        yaml.read("max_width", options.maxWidth.emplace());
        if (*options.maxWidth < kLeastWidth) {
            yaml.fail("max_width", fmt::format("must be at least {}", kLeastWidth));
        }
    }
    yaml.read("exposure", options.exposure);
    yaml.read("calibrate", options.calibrate);
    yaml.finish();
}

}  // namespace photonav
