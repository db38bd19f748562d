// SPDX-License-Identifier: BSD-3-Clause
// Maps that grow: a few images with depth, from any poses, are fused. The clearance that was
// updated after each is that of the map in the end, which can be written and read again.
#include <fuzzer/FuzzedDataProvider.h>

#include "fuzz_input.hpp"
#include "geometry/se3.hpp"
#include "map/distance_map.hpp"
#include "map/map_fusion.hpp"
#include "map/octree_file.hpp"

namespace {

using namespace photonav;

constexpr DistanceMap::Options kClearance{.maxDistance = 0.4};

/// Surfaces from 5 mm to 65 m away, and, for a byte of its own, no number at all.
float depthFrom(FuzzedDataProvider& input) {
    if (input.ConsumeIntegral<std::uint8_t>() == 7) return input.ConsumeFloatingPoint<float>();
    return 1e-3F * input.ConsumeIntegral<std::uint16_t>();
}

View viewFrom(FuzzedDataProvider& input, const Camera& camera) {
    View view{ImageF(camera.height, camera.width), ImageF(camera.height, camera.width)};
    for (unsigned i = 0; i < view.depth.getSize(); ++i) {
        view.intensity.bitmap[i] = input.ConsumeIntegral<std::uint8_t>() / 255.F;
        view.depth.bitmap[i] = depthFrom(input);
    }
    return view;
}

Pose poseFrom(FuzzedDataProvider& input) {
    Vector6 xi;
    for (double& number : xi) number = 1e-3 * input.ConsumeIntegral<std::int16_t>();
    return expSE3(xi);
}

/// Whether two clearances are the same, to the last bit, all over a box.
bool areSame(const DistanceMap& one, const DistanceMap& other, const Eigen::AlignedBox3d& box) {
    constexpr int kSteps = 6;
    for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
        const Eigen::Vector3d share(i % kSteps, i / kSteps % kSteps, i / kSteps / kSteps);
        const Eigen::Vector3d place = box.min() + box.sizes().cwiseProduct(share) / (kSteps - 1.);
        if (one.clearance(place) != other.clearance(place)) return false;
    }
    return true;
}

}  // namespace

void photonav::fuzz::run(std::string_view bytes) {
    FuzzedDataProvider input(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    const Camera camera = makeCamera(8, 6, 1.2);
    TexturedOcTree map(0.1 + 1e-3 * input.ConsumeIntegral<std::uint8_t>());
    FusionOptions options;
    options.surfaces = input.ConsumeBool();
    options.maxRange = 2.;
    const Eigen::AlignedBox3d box(Eigen::Vector3d(-1., -1., -0.5), Eigen::Vector3d(1., 1., 1.5));
    check([&] {
        DistanceMap clearance(map, box, kClearance);
        while (input.remaining_bytes() > 0) {
            const View view = viewFrom(input, camera);
            clearance.update(map, fuse(map, view, camera, poseFrom(input), options));
        }
        require(areSame(clearance, DistanceMap(map, box, kClearance), box),
                "clearance follows the map");
        const std::string file = (folder() / "grown.ot").string();
        saveTexturedOcTree(map, file);
        const auto copy = loadTexturedOcTree(file);
        require(copy->size() == map.size(), "a map that grew is read again");
    });
}
