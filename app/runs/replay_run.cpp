// SPDX-License-Identifier: BSD-3-Clause
#include "runs/replay_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "alignment/image_pyramid.hpp"
#include "evaluation/averages.hpp"
#include "io/error.hpp"
#include "io/stopwatch.hpp"

namespace photonav {
namespace {

constexpr std::size_t kStrips = 5;
constexpr std::size_t kFirstFrames = 10;  // at least one of them must be readable
constexpr std::size_t kPatience = 10;

/// The grey value between four pixels; nothing outside.
std::optional<float> sample(const ImageF& image, double u, double v) {
    if (!(u >= 0. && v >= 0. && u < image.getWidth() - 1. && v < image.getHeight() - 1.)) return {};
    const auto x = static_cast<unsigned>(u);
    const auto y = static_cast<unsigned>(v);
    const auto a = static_cast<float>(u - x);
    const auto b = static_cast<float>(v - y);
    return (1.F - b) * ((1.F - a) * image[y][x] + a * image[y][x + 1]) +
           b * ((1.F - a) * image[y + 1][x] + a * image[y + 1][x + 1]);
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
            const Eigen::Vector3d p_k =
                T_k_c * (z * Eigen::Vector3d((u - camera.cx()) / camera.fx(),
                                             (v - camera.cy()) / camera.fy(), 1.));
            if (!(p_k.z() > 0.)) continue;
            const auto grey =
                sample(keyframe.intensity, camera.fx() * p_k.x() / p_k.z() + camera.cx(),
                       camera.fy() * p_k.y() / p_k.z() + camera.cy());
            if (!grey) continue;
            result.intensity[v][u] = *grey;
            result.depth[v][u] = static_cast<float>(z);
        }
    }
    return result;
}

View halvedView(const View& view) {
    View half;
    half.intensity = halvedAsRendered(view.intensity);
    half.depth.resize(half.intensity.getHeight(), half.intensity.getWidth());
    for (unsigned v = 0; v < half.depth.getHeight(); ++v) {
        for (unsigned u = 0; u < half.depth.getWidth(); ++u) {
            half.depth[v][u] = view.depth[2 * v][2 * u];
        }
    }
    return half;
}

void halve(View& view, int times) {
    for (int i = 0; i < times; ++i) view = halvedView(view);
}

bool isStripFrame(std::size_t i, std::size_t count) {
    if (count <= kStrips) return true;
    for (std::size_t k = 0; k < kStrips; ++k) {
        if (i == (2 * k + 1) * count / (2 * kStrips)) return true;
    }
    return false;
}

/// Loads a frame or says why it cannot be.
std::optional<View> tryToLoad(const ReplaySource& source, ReplayedFrame& frame) {
    try {
        return source.load(frame.index);
    } catch (const InputError& error) {
        frame.words = error.what();
        return {};
    }
}

/// When nothing can be read from the beginning, it is not the images that are wrong.
void checkReadable(const std::vector<ReplayedFrame>& frames, const ReplaySource& source) {
    if (frames.size() != std::min(kFirstFrames, source.frames.size())) return;
    const bool anyRead = std::any_of(frames.begin(), frames.end(), [](const auto& f) {
        return f.status != FrameStatus::unreadable;
    });
    if (!anyRead) source.load(0);  // throws
}

/// Share of the pixels with depth.
double shareKnown(const ImageF& depth) {
    const auto known = std::count_if(depth.bitmap, depth.bitmap + depth.getSize(),
                                     [](float z) { return z > 0.F; });
    return static_cast<double>(known) / depth.getSize();
}

/// What the tracker compares the observed image with.
void expose(ImageF& predicted, const Exposure& exposure) {
    for (unsigned i = 0; i < predicted.getSize(); ++i) {
        predicted.bitmap[i] =
            static_cast<float>(exposure.gain * predicted.bitmap[i] + exposure.offset);
    }
}

void track(const ReplayTracker& tracker, View& view, ReplayedFrame& frame, ReplayRun& run) {
    frame.density = shareKnown(view.depth);
    Stopwatch watch;
    halve(view, tracker.halvings);
    frame.isBlack = isBlack(view.intensity);
    frame.tracked = tracker.track(view, frame.timestamp);
    frame.seconds = watch.lap();
    run.trackSeconds += frame.seconds;
    frame.status = frame.tracked.lost ? FrameStatus::lost : FrameStatus::tracked;
    const Alignment& alignment = frame.tracked.alignment;
    frame.words = frame.tracked.lost && !isLost(alignment.verdict)
                      ? fmt::format("lost: nothing certain to be seen ({})",
                                    describe(alignment, tracker.trust))
                      : describe(alignment, tracker.trust);
}

/// What was seen, and what the model says of it, that of odometry being an earlier image.
ReplayStrip stripOf(const ReplaySource& source, const ReplayTracker& tracker, const ReplayRun& run,
                    View observed) {
    const ReplayedFrame& frame = run.frames.back();
    std::optional<TrackedView> keyframe;
    if (frame.tracked.keyframe) {
        const ReplayedFrame& earlier = frameAt(run, *frame.tracked.keyframe);
        keyframe = {source.load(earlier.index), earlier.tracked};
        halve(keyframe->view, tracker.halvings);
    }
    const TrackedView seen{std::move(observed), frame.tracked};
    View predicted = tracker.predict(seen, keyframe);
    expose(predicted.intensity, frame.tracked.alignment.exposure);
    return {fmt::format("frame {}: {}", frame.index, frame.words), seen.view, std::move(predicted)};
}

}  // namespace

ReplayTracker odometryTracker(const Camera& camera, const UncertainPose& start,
                              const KeyframeChainOptions& options) {
    const auto odometry =
        std::make_shared<Tracker>(nullptr, camera, start, TrackerOptions{.keyframes = options});
    ReplayTracker tracker;
    tracker.trust = options.keyframe.alignment.trust;
    tracker.scale = options.keyframe.alignment.photometric.scale;
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
        return seenFrom(keyframe->view, camera, T_k_c, frame.view.depth);
    };
    return tracker;
}

ReplayTracker mapTracker(const std::shared_ptr<const ViewSource>& map, const Camera& camera,
                         const UncertainPose& start, const TrackerOptions& options,
                         unsigned maxWidth) {
    ReplayTracker tracker;
    tracker.trust = options.map.trust;
    tracker.scale = options.map.photometric.scale;
    tracker.camera = camera;
    while (tracker.camera.width > maxWidth) {
        tracker.camera = halved(tracker.camera);
        ++tracker.halvings;
    }
    const auto localizer = std::make_shared<Tracker>(map, tracker.camera, start, options);
    tracker.patience = kPatience;
    tracker.track = [=](const View& view, double timestamp) {
        return localizer->track(view, timestamp);
    };
    tracker.predict = [map, small = tracker.camera](const TrackedView& frame, const auto&) {
        View view;
        map->render(small, frame.tracked.T_c_w.mean, view);
        return view;
    };
    return tracker;
}

ReplayRun replay(const ReplaySource& source, const ReplayTracker& tracker,
                 const std::atomic<bool>& interrupted,
                 const std::function<void(std::size_t)>& progress) {
    ReplayRun run;
    Stopwatch watch;
    std::size_t tracked = 0;
    std::size_t lost = 0;
    std::size_t notFound = 0;  // though there was something to be seen
    for (std::size_t i = 0; i < source.frames.size(); ++i) {
        if (interrupted) {
            run.interrupted = true;
            break;
        }
        ReplayedFrame frame;
        frame.index = i;
        frame.timestamp = source.frames[i].timestamp;
        frame.truth_c_w = source.frames[i].T_c_w;
        watch.lap();
        std::optional<View> view = tryToLoad(source, frame);
        run.loadSeconds += watch.lap();
        if (view) track(tracker, *view, frame, run);
        run.frames.push_back(frame);
        if (view) {
            const bool isFirstLoss = frame.tracked.lost && lost == 0;
            if (isFirstLoss || isStripFrame(i, source.frames.size())) {
                run.strips.push_back(stripOf(source, tracker, run, std::move(*view)));
            }
            ++(frame.tracked.lost ? lost : tracked);
            notFound += frame.tracked.lost && !frame.isBlack;
        }
        checkReadable(run.frames, source);
        if (progress) progress(run.frames.size());
        if (tracked == 0 && notFound > 0 && notFound == tracker.patience) {
            run.stopped =
                fmt::format("none of {} images that show something could be found", notFound);
            break;
        }
    }
    return run;
}

const ReplayedFrame& frameAt(const ReplayRun& run, double timestamp) {
    return *std::lower_bound(
        run.frames.begin(), run.frames.end(), timestamp,
        [](const ReplayedFrame& frame, double time) { return frame.timestamp < time; });
}

std::vector<ReplayedFrame>::const_iterator firstRead(const ReplayRun& run) {
    return std::find_if(run.frames.begin(), run.frames.end(), [](const ReplayedFrame& frame) {
        return frame.status != FrameStatus::unreadable;
    });
}

void layOnTruth(ReplayRun& run) {
    auto tie = firstRead(run);
    if (tie == run.frames.end()) return;
    if (!tie->truth_c_w) {
        tie = std::find_if(tie, run.frames.cend(), [](const ReplayedFrame& frame) {
            return frame.status == FrameStatus::tracked && frame.truth_c_w;
        });
        if (tie == run.frames.end()) return;
    }
    run.laidOn = tie->index;
    const Pose T_estimate_truth = tie->tracked.T_c_w.mean.inverse() * *tie->truth_c_w;
    for (ReplayedFrame& frame : run.frames) {
        frame.tracked.T_c_w.mean = frame.tracked.T_c_w.mean * T_estimate_truth;
    }
}

std::optional<double> medianDepth(const ReplaySource& source) {
    constexpr std::size_t kLooks = 5;
    std::vector<float> depths;
    bool anyRead = false;
    const std::size_t step = std::max<std::size_t>(1, source.frames.size() / kLooks);
    for (std::size_t i = 0; i < source.frames.size(); i += step) {
        ReplayedFrame frame;
        frame.index = i;
        const auto view = tryToLoad(source, frame);
        if (!view) continue;
        anyRead = true;
        for (unsigned k = 0; k < view->depth.getSize(); k += 7) {
            if (view->depth.bitmap[k] > 0.F) depths.push_back(view->depth.bitmap[k]);
        }
    }
    if (!anyRead) return {};
    return median(std::move(depths), 0.);
}

}  // namespace photonav
