// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay_config.hpp"

#include "recording/recording_config.hpp"

namespace photonav {

void addKeys(KeyTable& keys, ReplayOptions& o) {
    addKeys(keys, static_cast<RecordingOptions&>(o));
    keys.file({"map", "", "textured octree (.ot), mesh or scene file to localise in"}, o.mapFile);
    keys.flag({"odometry", "", "track from image to image, without a map"}, o.odometry);
    keys.text(
        {"start", "m", "\"x,y,z,qx,qy,qz,qw\": camera pose of the first frame; none: the true one"},
        o.start);
    keys.number(
        {"start_sigma", "m, rad", "standard deviation of the start pose in a map; none: 0.05"},
        o.startSigma, {1e-12, 100.});
    keys.number({"sigma", "grey value", "standard deviation of the image noise"}, o.sigma,
                {1e-12, 1.});
    keys.number({"scale", "", "factor on the information of an alignment; none: 1"}, o.scale,
                {1e-12, 1e12});
    keys.number({"least_sigma", "m", "least standard deviation of an aligned position; none: 0"},
                o.leastSigma, {0., 1.});
    keys.number(
        {"least_sigma_rotation", "rad", "least standard deviation of an aligned rotation; none: 0"},
        o.leastSigmaRotation, {0., 1.});
    keys.number({"min_overlap", "", "least share of an image that the model must cover"},
                o.minOverlap, {1e-12, 1. - 1e-12});
    keys.count({"max_width", "pixels",
                "images are halved until they are at most this wide; none: 320 in a "
                "map, one halving in odometry"},
               o.maxWidth, {1. * kLeastWidth, 1e6});
    keys.flag({"exposure", "", "estimate gain and offset of every image"}, o.exposure);
    keys.number({"truth_sigma", "m",
                 "standard deviation of the recording's true positions, per axis; it counts where "
                 "errors are compared with covariances (NEES)"},
                o.truthSigma, {0., 1.});
    keys.number({"truth_sigma_rotation", "rad", "the same of the true rotations, per axis"},
                o.truthSigmaRotation, {0., 1.});
}

}  // namespace photonav
