// SPDX-License-Identifier: BSD-3-Clause
#include "render/interruptible_views.hpp"

#include <gtest/gtest.h>

#include "core/photometry/image_difference.hpp"
#include "core/photometry/synthetic_floor.hpp"
#include "render/area_sensor.hpp"
#include "render/mesh_renderer.hpp"

namespace photonav {
namespace {

/// A box seen from inside and obliquely: all rows differ.
std::shared_ptr<const ViewSource> texturedBox() {
    Scene scene;
    const auto texture = addTexture(scene, valueNoise({.size = {1., 1.}, .seed = 3}));
    addBox(scene, {-2., -3., -1.}, {4., 3., 2.}, texture, BoxInside::hollow);
    return std::make_shared<MeshRenderer>(std::move(scene));
}

const Pose kOblique =
    (Pose(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ())) * cameraMount(0.6)).inverse();

TEST(RenderingInBands, GivesTheViewThatIsRenderedAtOnce) {
    const auto views = texturedBox();
    const Camera camera = makeCamera(64, 47, 1.2);
    View whole, banded;
    views->render(camera, kOblique, whole);
    unsigned bands = 0;
    renderInBands(
        camera, 64 * 10,
        [&](const Camera& band, View& part) {
            ++bands;
            EXPECT_LE(band.height, 14U);
            views->render(band, kOblique, part);
        },
        banded);
    EXPECT_EQ(bands, 5U);
    ASSERT_EQ(banded.intensity.getSize(), whole.intensity.getSize());
    EXPECT_LT(test::largestDifference(whole.intensity, banded.intensity), 1e-4);
    EXPECT_LT(test::largestDifference(whole.depth, banded.depth), 1e-4);
}

TEST(RenderingInBands, SmallViewsAreRenderedAtOnce) {
    const Camera camera = makeCamera(64, 47, 1.2);
    View view;
    renderInBands(
        camera, 64 * 47, [&](const Camera& all, View&) { EXPECT_EQ(&all, &camera); }, view);
}

/// Counts the bands of large views.
class CountedViews : public ViewSource {
  public:
    void render(const Camera& camera, const Pose&, View& view) const override {
        ++count;
        view.intensity.resize(camera.height, camera.width);
        view.depth.resize(camera.height, camera.width);
    }
    mutable int count = 0;
};

TEST(InterruptibleViews, ALargeViewEndsWithinABand) {
    const auto counted = std::make_shared<CountedViews>();
    const InterruptibleViews views(counted, [&] { return counted->count == 2; });
    View view;
    EXPECT_THROW(views.render(makeCamera(8000, 6000, 1.2), kOblique, view), Interrupted);
    EXPECT_EQ(counted->count, 2);
}

TEST(InterruptibleViews, ASmallViewIsFinished) {
    const auto counted = std::make_shared<CountedViews>();
    const InterruptibleViews views(counted, [] { return true; });
    View view;
    EXPECT_NO_THROW(views.render(makeCamera(752, 480, 1.2), kOblique, view));
    EXPECT_EQ(counted->count, 1);
}

/// The rays of 8000 x 6000 pixels at once would be 432 million.
TEST(AreaSensor, LimitsTheRaysOfLargeImages) {
    class LimitedViews : public CountedViews {
      public:
        void render(const Camera& camera, const Pose& T_c_w, View& view) const override {
            EXPECT_LT(pixelsOf(camera), 3 * kBandPixels);
            CountedViews::render(camera, T_c_w, view);
        }
    };
    const LimitedViews views;
    View view;
    AreaSensor(views).render(makeCamera(4000, 300, 1.2), kOblique, view);
    EXPECT_GT(views.count, 1);
    EXPECT_EQ(view.intensity.getSize(), 4000U * 300U);
}

}  // namespace
}  // namespace photonav
