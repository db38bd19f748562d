// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/exposed_fusion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/camera.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

const Camera kCamera = makeCamera(160, 120, 1.2);

Pose poseOf(int i) { return lookFrom({2. + 0.1 * i, 3., 1.5}, 0.7, 0.15 * i); }

double gainOf(int i) { return 1. - 0.25 * std::sin(0.8 * i); }

View takenFrom(const Pose& T_c_w, double gain) {
    View view;
    test::room().render(kCamera, T_c_w, view);
    for (unsigned k = 0; k < view.intensity.getSize(); ++k) {
        view.intensity.bitmap[k] *= static_cast<float>(gain);
    }
    return view;
}

/// Root mean square difference of the map's views from those of the room, over what is mapped.
double errorOfMap(bool estimate, double& worstGain) {
    TexturedOcTree map(0.05);
    ExposedFusion fusion(map, kCamera, estimate);
    worstGain = 0.;
    for (int i = 0; i < 15; ++i) {
        fusion.add(takenFrom(poseOf(i), gainOf(i)), poseOf(i), {});
        worstGain = std::max(worstGain, std::abs(fusion.gain() / gainOf(i) - 1.));
    }
    const VoxelRenderer views(map, UnknownPolicy::free);
    double sum = 0., pixels = 0.;
    View seen;
    for (int i = 0; i < 15; ++i) {
        views.render(kCamera, poseOf(i), seen);
        const View truth = takenFrom(poseOf(i), 1.);
        for (unsigned k = 0; k < seen.depth.getSize(); ++k) {
            if (!(seen.depth.bitmap[k] > 0.F)) continue;
            sum += std::pow(seen.intensity.bitmap[k] - truth.intensity.bitmap[k], 2);
            pixels += 1.;
        }
    }
    return std::sqrt(sum / pixels);
}

TEST(ExposedFusion, MapsImagesOfAutomaticExposureAsIfItWereFixed) {
    double gainError = 0., unused = 0.;
    const double compensated = errorOfMap(true, gainError);
    const double asTaken = errorOfMap(false, unused);
    EXPECT_LT(gainError, 0.02);
    EXPECT_LT(compensated, 0.5 * asTaken);
}

TEST(ExposedFusion, LeavesImagesOfAFixedExposureAsTheyAre) {
    TexturedOcTree map(0.05);
    ExposedFusion fusion(map, kCamera, true);
    for (int i = 0; i < 35; ++i) {
        fusion.add(takenFrom(poseOf(i), 1.), poseOf(i), {});
        EXPECT_NEAR(fusion.gain(), 1., 0.01) << i;
    }
}

}  // namespace
}  // namespace photonav
