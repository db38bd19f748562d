// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/photometry/synthetic_floor.hpp"
#include "map/map_fusion.hpp"

namespace photonav::test {

inline constexpr unsigned kTop = 5;  ///< face +z

/// A few views of a carpet from above.
inline TexturedOcTree carpetMap(double resolution = 0.05) {
    TexturedOcTree map(resolution);
    const Camera camera = makeCamera(160, 120, 1.2);
    for (const double x : {-0.3, 0., 0.3}) {
        const Pose T_c_w = lookDown(x, 0.1, 1.5, kDown, x);
        fuse(map, floorView(camera, T_c_w, carpet, 0.02), camera, T_c_w);
    }
    return map;
}

}  // namespace photonav::test
