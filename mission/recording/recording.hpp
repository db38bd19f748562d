// SPDX-License-Identifier: BSD-3-Clause
// A recorded sequence, rotated into a world with z up: the world of a map made from it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "dataset/sequence.hpp"
#include "io/interrupted.hpp"
#include "io/reading.hpp"

namespace photonav {

/// Which recording to read, and how. The recording is mapped, tracked or compared with a plan.
struct RecordingOptions {
    std::string dataset;      ///< folder in the TUM RGB-D, the EuRoC or the COLMAP layout, or a bag
    std::string up = "z";     ///< upward direction in the recorded world: an axis (x ... -z), a
                              ///< direction "x,y,z", or "floor", found in the depth images
    int every = 1;            ///< use every n-th frame
    std::string frames;       ///< "a:b": only the frames from a on and before b; a or b may be
                              ///< left out
    bool forgiving = false;   ///< keep frames without pose, see TumOptions
    double tolerance = 0.02;  ///< largest difference of time stamps, see TumOptions [s]
    bool needsDepth = true;   ///< see TumOptions
    std::string cameraFile;   ///< camera file in place of the dataset's camera.yaml
    std::optional<double> depthScale;  ///< depth image value of 1 m, in place of the dataset's
    std::string stereo;  ///< EuRoC: stereo matching, "bm" (block matching; the default) or "sgbm"
                         ///< (semi-global)
    std::string topics;  ///< bags: "image=/a,depth=/b,camera=/c,pose=/d"; only topics whose type
                         ///< occurs more than once must be named
    std::string mount;   ///< bags: "x,y,z,qx,qy,qz,qw", pose of the camera in the frame whose poses
                         ///< the bag holds; empty: the poses are the camera's
    IsStopped isStopped;  ///< asked between the two images of a frame; Recording::view then throws
                          ///< Interrupted
};

struct Recording {
    Sequence sequence;  ///< the frames to use, in the world of the map (z up)
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< in the recorded world
    std::string layout;                             ///< "TUM RGB-D", "EuRoC", "COLMAP", "ROS bag"
    bool hasImageFiles = true;  ///< false: images come from a bag or are rectified, so that no file
                                ///< holds them
    std::string stereo;  ///< stereo matching that gives depth; empty: depth is recorded or missing
    std::string note;    ///< remark about images, camera or poses, for result files

    /// The rectified image of a frame, with depth if there is any. @throws InputError for images
    /// that cannot be used
    std::function<View(std::size_t frame)> view;

    /// A frame with its image and pose. @throws InputError for images that cannot be used
    RecordedFrame load(std::size_t frame) const {
        const Sequence::Entry& entry = sequence.frames.at(frame);
        return {entry.T_c_w, reading(entry.colourFile, [&] { return view(frame); }),
                entry.timestamp};
    }
};

/// Reads the tables of a dataset (and, for "floor", some images) and rotates its world so that z
/// points up. The normal of the floor is sought within 50 degrees of the direction of the images'
/// upper edge: for a camera that looks straight down, give an axis or a direction.
/// @throws InputError for a dataset that cannot be used, for a bad value of `up` ("--up"), for a
///         range without frames, and for options that do not apply to this recording
Recording readRecording(const RecordingOptions& options);

/// Detects a wrong depth scale, such as millimetres taken for metres, which would otherwise appear
/// as bad tracking or an empty map.
/// @param median median of measured depths [m]
/// @param cameraFile file whose depth_scale was used if the options have none; may be empty
/// @throws InputError unless the median is between 5 cm and 100 m
void requirePlausibleDepth(double median, const RecordingOptions& options,
                           const std::string& cameraFile);

/// Parses a pose "x,y,z,qx,qy,qz,qw" [m].
/// @param option the command-line option that is named in errors
/// @throws InputError for any other text, and unless the quaternion's norm is within 0.1 of 1
Pose parsePose(const std::string& text, const char* option);

/// Parses an upward direction: the name of an axis (x ... -z) or "x,y,z". Returns a unit vector, or
/// nothing for any other text.
std::optional<Eigen::Vector3d> parseUp(const std::string& text);

/// The inverse of parseUp(): the name of an axis ("-y"), else "x,y,z" with 17 digits.
std::string upText(const Eigen::Vector3d& up);

/// Parses a range of frames "a:b", "a:", ":b" or "". Returns the half-open range [a, b), cut to
/// [0, count).
/// @throws InputError ("--frames") for any other text and for a range without frames
std::pair<std::size_t, std::size_t> parseFrames(const std::string& text, std::size_t count);

/// Angle between a direction (unit vector) and the nearest axis [degrees].
double tiltDegrees(const Eigen::Vector3d& up);

}  // namespace photonav
