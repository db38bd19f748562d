// SPDX-License-Identifier: BSD-3-Clause
// Recordings of a stereo camera in the layout of the EuRoC MAV dataset (ASL format).
#pragma once

#include <string>
#include <vector>

#include "dataset/sequence.hpp"

namespace photonav {

/// A pinhole camera with radial-tangential distortion; its images are not rectified.
struct DistortedCamera {
    Camera camera;  ///< size and intrinsics, as if there were no distortion
    Eigen::Vector4d distortion = Eigen::Vector4d::Zero();  ///< k1, k2, p1, p2
    Pose T_b_c = Pose::Identity();                         ///< mount on the body (T_BS)
    std::string file;                                      ///< sensor.yaml that this was read from
};

/// The tables of a stereo dataset, without the images.
struct StereoSequence {
    struct Entry {
        double timestamp = 0.;          ///< of the left image [s]
        Pose T_c_w = Pose::Identity();  ///< of the left camera, not rectified
        bool hasPose = false;
        std::string leftFile;
        std::string rightFile;
    };

    DistortedCamera left, right;
    std::vector<Entry> frames;  ///< in order of time
    std::size_t recorded = 0;   ///< left images that the dataset lists
    std::vector<Sequence::Skipped> skipped;
    std::string
        groundtruthOf;  ///< "body" or "cam0": frame whose poses are recorded; "": no ground truth
};

struct EurocOptions {
    double stereoTolerance = 0.002;  ///< largest time between left and right image [s]
    double tolerance = 0.02;         ///< largest time between image and pose [s]
    double maxPoseGap = 0.1;         ///< interpolate between poses at most this far apart [s]
};

/// Reads the tables of a dataset, no images: `mav0/cam0` and `mav0/cam1` (`data.csv`,
/// `sensor.yaml` with resolution, intrinsics, radial-tangential distortion and T_BS) and, when
/// there, `mav0/state_groundtruth_estimate0/data.csv` (`t, p, q (w first), ...`). `folder` holds
/// mav0 or is it.
///
/// The `sensor.yaml` of the ground truth determines whose poses it holds: T_BS if present (EuRoC's
/// own is the identity, hence the body), else the left camera if its comment names cam0, else the
/// body. Images without partner, and those whose timestamps repeat or go back, are skipped and
/// listed; images without pose are kept.
/// @throws InputError naming file, line or key, and reason: also for a missing camera, another
///         camera or distortion model, cameras that differ in size, no pair of images, and ground
///         truth that belongs to none
StereoSequence readEurocSequence(const std::string& folder, const EurocOptions& options = {});

/// Whether readEurocSequence() is the reader for a folder: it has mav0 or cam0 inside.
bool isEurocFolder(const std::string& folder);

struct StereoImages {
    vpImage<unsigned char> left, right;
};

/// @throws InputError for a file that is missing, damaged or of another size than the camera's
StereoImages loadStereo(const StereoSequence& sequence, std::size_t index);

}  // namespace photonav
