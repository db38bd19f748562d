// SPDX-License-Identifier: BSD-3-Clause
// Information that follows a map which a robot makes of its images.
#include <gtest/gtest.h>

#include <random>

#include "geometry/se3.hpp"
#include "map/map_fusion.hpp"
#include "planning/belief/fields.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"
#include "render/voxel_snapshots.hpp"

namespace photonav::test {
namespace {

/// A room with two boxes, mapped by keyframes of a camera with noise at random poses.
class MappedRoom {
  public:
    explicit MappedRoom(unsigned seed) : map(0.05), random_(seed), renderer_(scene()) {}

    MapChange fuseKeyframe() {
        const Pose T_c_w = randomView();
        View view = viewFrom(T_c_w);
        std::normal_distribution<float> noise(0.F, 1.F);
        for (unsigned i = 0; i < view.depth.getSize(); ++i) {
            float& z = view.depth.bitmap[i];
            float& grey = view.intensity.bitmap[i];
            grey = std::clamp(grey + 0.02F * noise(random_), 0.F, 1.F);
            if (z > 0.F) z += 0.002F * z * z * noise(random_);
        }
        return fuseExactly(view, T_c_w);
    }

    /// The same again and again, as by a robot that hovers.
    MapChange fuseWithoutNoise(const Pose& T_c_w) { return fuseExactly(viewFrom(T_c_w), T_c_w); }

    Pose randomView() { return (randomPose() * cameraMount(uniform(0., 1.2))).inverse(); }

    /// A body pose away from the walls and the boxes.
    Pose randomPose() {
        const Eigen::Vector3d p_w{uniform(0.4, 3.6), uniform(0.4, 2.6), uniform(1., 1.6)};
        return levelPose(p_w, uniform(0., 6.28));
    }

    TexturedOcTree map;

  private:
    View viewFrom(const Pose& T_c_w) const {
        View view;
        renderer_.render(camera_, T_c_w, view);
        return view;
    }
    MapChange fuseExactly(const View& view, const Pose& T_c_w) {
        return fuse(map, view, camera_, T_c_w, {.greyTolerance = 0., .surfaceTolerance = 0.});
    }
    static Scene scene() {
        Scene room;
        const auto texture = addTexture(room, valueNoise({}));
        addBox(room, {0., 0., 0.}, {4., 3., 2.}, texture);
        addBox(room, {1., 1., 0.}, {1.5, 1.6, 0.8}, texture);
        addBox(room, {2.6, 0.9, 0.}, {2.8, 2.4, 0.6}, texture);
        return room;
    }
    double uniform(double low, double high) {
        return std::uniform_real_distribution<>(low, high)(random_);
    }

    const Camera camera_ = makeCamera(94, 60, 1.4);
    std::mt19937 random_;
    MeshRenderer renderer_;
};

/// Entries that were kept by an update, and those that a change made different.
struct Followed {
    std::size_t kept = 0, changed = 0;
};

/// Follows the changes by images of a room; entries that are not stale have to equal fresh ones.
/// @param fuse fuses the next image
template <class Fuse>
void followImages(MappedRoom& room, UnknownPolicy unknown, int views, int images, const Fuse& fuse,
                  Followed& followed) {
    VoxelSnapshots snapshots(room.map, unknown);
    const auto field = fieldOf(snapshots.current(), 0.6);
    std::vector<Pose> poses;
    for (int i = 0; i < views; ++i) poses.push_back(room.randomPose());
    const Entries entries = entriesAt(poses, *field);
    for (int image = 0; image < images; ++image) {
        const MapChange change = fuse();
        field->update(snapshots.update(room.map, change), change);
        const auto fresh = fieldOf(std::make_shared<VoxelRenderer>(room.map, unknown), 0.6);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const bool isSame = entries[i]->information == fresh->at(poses[i]).information;
            EXPECT_TRUE(isSame || entries[i]->isStale) << "image " << image << ", view " << i;
            followed.kept += entries[i]->isStale ? 0 : 1;
            followed.changed += isSame ? 0 : 1;
            ASSERT_EQ(field->current(*entries[i]).information, fresh->at(poses[i]).information);
        }
    }
}

class FieldOverImages : public testing::TestWithParam<UnknownPolicy> {};
INSTANTIATE_TEST_SUITE_P(Unknown, FieldOverImages,
                         testing::Values(UnknownPolicy::free, UnknownPolicy::occupied));

/// The weights of greys, by which views merge the faces of neighbouring layers, change even where
/// no grey does.
TEST_P(FieldOverImages, EntriesThatAreNotStaleEqualFreshOnesWhereOnlyWeightsChange) {
    MappedRoom room(3);
    std::vector<Pose> hovering(3);
    for (Pose& T_c_w : hovering) room.fuseWithoutNoise(T_c_w = room.randomView());
    room.fuseWithoutNoise(hovering[0]);
    Followed followed;
    followImages(
        room, GetParam(), 24, 7, [&] { return room.fuseWithoutNoise(hovering[0]); }, followed);
    EXPECT_GT(followed.kept, 10U);
}

/// A robot's keyframes, not changes made up for a test: fusion without tolerances lists all that
/// the views may show.
TEST_P(FieldOverImages, EntriesThatAreNotStaleEqualFreshOnesAfterFusion) {
    MappedRoom room(3);
    for (int i = 0; i < 30; ++i) room.fuseKeyframe();
    Followed followed;
    followImages(
        room, GetParam(), 40, 20, [&] { return room.fuseKeyframe(); }, followed);
    EXPECT_GT(followed.kept, 100U);
    EXPECT_GT(followed.changed, 100U);
}

}  // namespace
}  // namespace photonav::test
