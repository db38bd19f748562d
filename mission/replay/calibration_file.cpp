// SPDX-License-Identifier: BSD-3-Clause
#include "replay/calibration_file.hpp"

#include <fmt/format.h>

#include <vector>

#include "io/reading.hpp"
#include "io/yaml_reader.hpp"

namespace photonav {
namespace {

const std::vector<std::string> kModes{"odometry", "map"};

const std::string& modeOf(bool odometry) { return kModes[odometry ? 0 : 1]; }

Calibration readKeys(const std::string& file, bool odometry) {
    YamlMap yaml(file, loadYaml(file));
    Calibration c;
    for (const char* key : {"scale", "least_sigma", "least_sigma_rotation"}) {
        if (!yaml.has(key)) yaml.fail(key, "missing");
    }
    std::string mode = modeOf(odometry);
    yaml.readChoice("mode", mode, kModes);
    if (mode != modeOf(odometry)) {
        yaml.fail("mode", fmt::format("is {}: alignments to {} are not worth the same", mode,
                                      odometry ? "a keyframe" : "a map"));
    }
    yaml.readNumber("scale", c.scale, 1e-12, 1e12);
    yaml.readNumber("least_sigma", c.floorTranslation, 0., 1e6);
    yaml.readNumber("least_sigma_rotation", c.floorRotation, 0., 1e6);
    yaml.readNumber("correlation_time", c.correlationTime, 1., 1e9);
    yaml.finish();
    return c;
}

}  // namespace

std::string toYaml(const Calibration& c, bool odometry) {
    std::string text = fmt::format(
        "# Single alignments: NEES per degree of freedom {:.3g} before, {:.3g} with\n"
        "# photonav replay ... --scale {:.3g} --least-sigma {:.3g} --least-sigma-rotation {:.3g}\n"
        "mode: {}\nscale: {:.3g}\nleast_sigma: {:.3g}  # m\nleast_sigma_rotation: {:.3g}  # rad\n",
        c.neesBefore, c.neesAfter, c.scale, c.floorTranslation, c.floorRotation, modeOf(odometry),
        c.scale, c.floorTranslation, c.floorRotation);
    if (c.correlationTime > 1.) {
        text += fmt::format(
            "# Images whose errors are correlated: photonav fly, which averages images, divides\n"
            "# the factor by this number.\ncorrelation_time: {:.3g}\n",
            c.correlationTime);
    }
    return text;
}

Calibration readCalibration(const std::string& file, bool odometry) {
    return reading(file, [&] { return readKeys(file, odometry); });
}

}  // namespace photonav
