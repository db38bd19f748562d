// SPDX-License-Identifier: BSD-3-Clause
// Bags, written by ROS's own library. Its headers are of C++17: so is what includes them.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace photonav::test {

struct BagWords {
    std::string compression = "none";  ///< of chunks: none, bz2, lz4
    std::vector<std::string> imageTopics = {"/camera/rgb/image_raw"};
    std::string imageEncoding = "mono8";  ///< also rgb8, bgr8; "png" or "jpeg": CompressedImage
    std::string depthTopic = "/camera/depth_registered/image_raw";  ///< empty: none
    std::string depthEncoding = "16UC1";   ///< values of the files; 32FC1: metres; or "png"
    std::string poseType = "PoseStamped";  ///< PoseWithCovarianceStamped, ...; empty: none
    std::string cameraTopic = "/camera/rgb/camera_info";  ///< empty: none
    std::string distortionModel = "plumb_bob";
    std::vector<double> distortion = {0., 0., 0., 0., 0.};
    double depthFocal = 1.;  ///< factor on that of a camera_info beside the depth; 1: no such topic
    bool stampsInHeader = true;  ///< false: messages have only the time at which they were recorded
};

struct BagFrame {
    double time;                  ///< [s]
    std::array<double, 7> T_w_c;  ///< position, quaternion (w last)
    std::string colour, depth;    ///< image files
};

struct BagCameraWords {
    unsigned width, height;
    double fx, fy, cx, cy;
};

/// @param depthScale value of one metre in the depth images
void writeBag(const std::string& file, const std::vector<BagFrame>& frames,
              const BagCameraWords& camera, double depthScale, const BagWords& words);

}  // namespace photonav::test
