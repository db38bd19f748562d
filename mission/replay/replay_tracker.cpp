// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay_tracker.hpp"

#include <memory>
#include <utility>

#include "alignment/image_pyramid.hpp"
#include "photometry/bilinear.hpp"

namespace photonav {
namespace {

bool isBetweenPixels(const ImageF& image, const Eigen::Vector2d& pixel) {
    return pixel.x() >= 0. && pixel.y() >= 0. && pixel.x() < image.getWidth() - 1. &&
           pixel.y() < image.getHeight() - 1.;
}

/// A keyframe as it looks from another place, by the depth seen from there.
View seenFrom(const View& keyframe, const Camera& camera, const Pose& T_k_c,
              const ImageF& depth_c) {
    View result;
    result.intensity.resize(camera.height, camera.width, 0.F);
    result.depth.resize(camera.height, camera.width, 0.F);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const double z = depth_c[v][u];
            if (!(z > 0.)) continue;
            const Eigen::Vector3d p_k = T_k_c * camera.unproject(u, v, z);
            if (!(p_k.z() > 0.)) continue;
            const Eigen::Vector2d pixel = camera.project(p_k);
            if (!isBetweenPixels(keyframe.intensity, pixel)) continue;
            result.intensity[v][u] = bilinear(keyframe.intensity, pixel.x(), pixel.y());
            result.depth[v][u] = static_cast<float>(z);
        }
    }
    return result;
}

/// The camera of a view that was halved some times.
Camera cameraOf(const View& view, Camera camera) {
    while (camera.width > view.intensity.getWidth()) camera = halved(camera);
    return camera;
}

}  // namespace

ReplayTracker odometryTracker(const Camera& camera, const UncertainPose& start,
                              const KeyframeChainOptions& options) {
    const auto odometry =
        std::make_shared<Tracker>(nullptr, camera, start, TrackerOptions{.keyframes = options});
    ReplayTracker tracker;
    tracker.odometry = true;
    tracker.trust = options.keyframe.alignment.trust;
    tracker.scale = options.keyframe.alignment.informationScale;
    tracker.camera = camera;
    tracker.track = [=](const View& view, double timestamp) {
        return odometry->track(view, timestamp);
    };
    tracker.predict = [camera](const TrackedView& frame,
                               const std::optional<TrackedView>& keyframe) {
        if (!keyframe) {  // nothing was seen yet
            View nothing = frame.view;
            nothing.depth = 0.F;
            return nothing;
        }
        const Pose T_k_c = keyframe->tracked.T_c_w.mean * frame.tracked.T_c_w.mean.inverse();
        return seenFrom(keyframe->view, cameraOf(frame.view, camera), T_k_c, frame.view.depth);
    };
    return tracker;
}

ReplayTracker mapTracker(const std::shared_ptr<const ViewSource>& map, const Camera& camera,
                         const UncertainPose& start, const TrackerOptions& given,
                         unsigned maxWidth) {
    TrackerOptions options = given;
    ReplayTracker tracker;
    tracker.trust = options.map.trust;
    tracker.scale = options.map.informationScale;
    tracker.camera = camera;
    while (tracker.camera.width > maxWidth) {
        tracker.camera = halved(tracker.camera);
        options.map.blur = blurAfterHalving(options.map.blur);
        ++tracker.halvings;
    }
    tracker.blur = options.map.blur;
    const auto localizer = std::make_shared<Tracker>(map, tracker.camera, start, options);
    tracker.hasGivenUp = [=] { return localizer->loss().isStartWrong(); };
    tracker.track = [=](const View& view, double timestamp) {
        return localizer->track(view, timestamp);
    };
    tracker.predict = [map, small = tracker.camera](const TrackedView& frame, const auto&) {
        View view;
        map->render(cameraOf(frame.view, small), frame.tracked.T_c_w.mean, view);
        return view;
    };
    return tracker;
}

}  // namespace photonav
