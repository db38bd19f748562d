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
    keys.choice(
        {"stereo", "",
         "bm: block matching (none: this), sgbm: semi-global matching; of EuRoC recordings"},
        options.stereo, {"bm", "sgbm"});
    keys.text({"topics", "",
               "of a bag, where a type has more than one: \"image=/a,depth=/b,camera=/c,pose=/d\""},
              options.topics);
    keys.text({"mount", "m",
               "\"x,y,z,qx,qy,qz,qw\": pose of the camera on what the poses of a bag are of; none: "
               "they are the camera's"},
              options.mount);
}

}  // namespace photonav
