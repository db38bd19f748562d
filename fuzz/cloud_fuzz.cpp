// SPDX-License-Identifier: BSD-3-Clause
// Point clouds of laser scanners.
#include "fuzz_input.hpp"
#include "map/point_cloud.hpp"

void photonav::fuzz::run(std::string_view input) {
    check([&] {
        const PointCloudFile cloud(write("cloud.ply", input));
        cloud.read([](const ScanPoint& point) {
            require(point.p_w.allFinite(), "points are finite");
            require(point.grey >= 0.F && point.grey <= 1.F, "grey values are in [0, 1]");
        });
    });
}
