// SPDX-License-Identifier: BSD-3-Clause
#include "recording/recording_config.hpp"

namespace photonav {

void addKeys(KeyTable& keys, RecordingOptions& options) {
    keys.requiredFile(
        {"dataset", "", "folder in the TUM RGB-D, the EuRoC or the COLMAP layout, or a ROS 1 bag"},
        options.dataset);
    keys.file({"camera", "", "camera file instead of the dataset's"}, options.cameraFile);
    keys.text({"up", "", "upward direction of the recorded world: x ... -z, \"x,y,z\" or floor"},
              options.up);
    keys.count({"every", "", "use every n-th frame"}, options.every, {1., 1e9});
    keys.number({"tolerance", "s", "largest difference of timestamps"}, options.tolerance,
                {1e-9, 1e5});
    keys.number({"depth_scale", "1/m", "depth image value of one metre; none: the dataset's"},
                options.depthScale, {1e-6, 1e12});
    keys.text({"frames", "", "\"a:b\": only the frames from a on and before b"}, options.frames);
    keys.choice({"stereo", "",
                 "stereo matching of EuRoC recordings: bm, block matching, or sgbm, semi-global "
                 "matching; none: bm"},
                options.stereo, {"bm", "sgbm"});
    keys.text(
        {"topics", "",
         "topics of a bag that has several of a type: \"image=/a,depth=/b,camera=/c,pose=/d\""},
        options.topics);
    keys.text(
        {"mount", "m",
         "\"x,y,z,qx,qy,qz,qw\": pose of the camera in the frame whose poses a bag holds; none: "
         "the poses are the camera's"},
        options.mount);
}

}  // namespace photonav
