// SPDX-License-Identifier: BSD-3-Clause
#include "replay/calibration_file.hpp"

#include <fmt/format.h>

#include <vector>

#include "io/reading.hpp"
#include "io/yaml_reader.hpp"

namespace photonav {
namespace {

constexpr const char* kOdometry = "odometry";
constexpr const char* kAnyMap = "map";  // of files before maps had kinds

struct CalibrationFile {
    Calibration calibration;
    std::string mode;  ///< empty: not said
};

CalibrationFile readFile(YamlMap& yaml) {
    static const std::vector<std::string> kModes{kOdometry, "mesh", "cells", "surfaces", kAnyMap};
    CalibrationFile file;
    Calibration& c = file.calibration;
    for (const char* key : {"scale", "least_sigma", "least_sigma_rotation"}) {
        if (!yaml.has(key)) yaml.fail(key, "missing");
    }
    if (yaml.has("mode")) {
        file.mode = kOdometry;
        yaml.readChoice("mode", file.mode, kModes);
    }
    yaml.readNumber("scale", c.scale, 1e-12, 1e12);
    yaml.readNumber("least_sigma", c.leastSigma, 0., 1.);
    yaml.readNumber("least_sigma_rotation", c.leastSigmaRotation, 0., 1.);
    yaml.readNumber("correlation_time", c.correlationTime, 1., 1e9);
    yaml.finish();
    return file;
}

/// The calibration of a file, refused if it is of another kind.
Calibration readOfKind(const std::string& file, std::optional<MapKind> map) {
    YamlMap yaml(file, loadYaml(file));
    const CalibrationFile read = readFile(yaml);
    const std::string wanted = modeOf(map);
    if (read.mode.empty() || read.mode == wanted) return read.calibration;
    if (read.mode == kAnyMap && map) {
        yaml.fail("mode", fmt::format("does not say of which kind of map; calibrate again in this "
                                      "one, of kind {}",
                                      wanted));
    }
    yaml.fail("mode", fmt::format("is {}: alignments to {} err otherwise (mode {})", read.mode,
                                  map ? "this kind of map" : "keyframes", wanted));
}

}  // namespace

const char* modeOf(std::optional<MapKind> map) {
    if (!map) return kOdometry;
    if (*map == MapKind::mesh) return "mesh";
    return *map == MapKind::cells ? "cells" : "surfaces";
}

std::string toYaml(const Calibration& c, std::optional<MapKind> map) {
    const auto digits = [](double value) { return fmt::format("{:.3g}", value); };
    YAML::Emitter yaml;
    yaml << YAML::Comment(fmt::format(
        "Single alignments: NEES per degree of freedom {:.3g} before, {:.3g} with\n"
        "photonav replay ... --scale {:.3g} --least-sigma {:.3g} --least-sigma-rotation {:.3g}",
        c.neesBefore, c.neesAfter, c.scale, c.leastSigma, c.leastSigmaRotation));
    yaml << YAML::BeginMap << "mode" << modeOf(map) << "scale" << digits(c.scale) << "least_sigma"
         << digits(c.leastSigma) << YAML::Comment("m") << "least_sigma_rotation"
         << digits(c.leastSigmaRotation) << YAML::Comment("rad");
    if (c.correlationTime > 1.) {
        yaml << "correlation_time" << digits(c.correlationTime)
             << YAML::Comment(
                    "images whose errors are correlated: photonav fly divides the scale by it");
    }
    yaml << YAML::EndMap;
    return std::string(yaml.c_str()) + "\n";
}

Calibration readCalibration(const std::string& file) {
    return reading(file, [&] {
        YamlMap yaml(file, loadYaml(file));
        return readFile(yaml).calibration;
    });
}

Calibration readCalibration(const std::string& file, std::optional<MapKind> map) {
    return reading(file, [&] { return readOfKind(file, map); });
}

}  // namespace photonav
