// SPDX-License-Identifier: BSD-3-Clause
// A recorded sequence in the world of the map that was made of it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "dataset/sequence.hpp"
#include "io/reading.hpp"

namespace photonav {

/// What is mapped, and what a plan in that map is compared with.
struct RecordingOptions {
    std::string dataset;      ///< folder in the TUM RGB-D, the EuRoC or the COLMAP layout, or a bag
    std::string up = "z";     ///< what points up in the recorded world: an axis (x ... -z), a
                              ///< direction "x,y,z", or "floor": found in the depth images
    int every = 1;            ///< use every n-th frame
    std::string frames;       ///< "a:b": only the frames from a on and before b; either may be
                              ///< missing
    bool forgiving = false;   ///< frames without pose are kept, see TumOptions
    double tolerance = 0.02;  ///< of timestamps, see TumOptions [s]
    bool needsDepth = true;   ///< see TumOptions
    std::string cameraFile;   ///< instead of the dataset's camera.yaml
    std::optional<double> depthScale;  ///< depth image value of one metre, instead of the dataset's
    std::string stereo;  ///< EuRoC: "bm" or "sgbm", block matching (the default) or semi-global
    std::string topics;  ///< bags: "image=/a,depth=/b,camera=/c,pose=/d", those that need a name
    std::string mount;   ///< bags: "x,y,z,qx,qy,qz,qw" of the camera on what the poses are of
};

struct Recording {
    Sequence sequence;  ///< the frames to use, in the world of the map (z up)
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< in the recorded world
    std::string layout;                             ///< "TUM RGB-D", "EuRoC", "COLMAP", "ROS bag"
    bool hasImageFiles = true;                      ///< false: images are not files as they are
    std::string stereo;                             ///< how depth is found; empty: it is recorded
    std::string note;  ///< about the poses, for a reader of the results

    /// Images of a frame of the sequence: rectified, with depth. @throws InputError for those that
    /// cannot be used
    std::function<View(std::size_t frame)> view;

    RecordedFrame load(std::size_t frame) const {
        const Sequence::Entry& entry = sequence.frames.at(frame);
        return {entry.T_c_w, reading(entry.colourFile, [&] { return view(frame); }),
                entry.timestamp};
    }
};

/// Reads the tables of a dataset (and, for "floor", some images) and turns its world upright. The
/// floor is sought within 50 degrees of the upper edge of the images: a camera that looks straight
/// down needs an axis or a direction.
/// @throws InputError for a dataset that cannot be used and for options: `up` ("--up"), a range
///         without frames, and those that mean nothing for this recording
Recording readRecording(const RecordingOptions& options);

/// A depth scale wrong by 1000 is found here, before it looks like bad tracking or an empty map.
/// @param median of depths that were measured [m]
/// @param cameraFile whose scale is used when the options have none; may be empty
/// @throws InputError unless the median lies in 5 cm to 100 m
void requirePlausibleDepth(double median, const RecordingOptions& options,
                           const std::string& cameraFile);

/// A pose from "x,y,z,qx,qy,qz,qw".
/// @throws InputError naming the option for anything else
Pose parsePose(const std::string& text, const char* option);

/// An axis name or "x,y,z"; nothing for anything else.
std::optional<Eigen::Vector3d> parseUp(const std::string& text);

/// The other direction: "-y" for an axis, otherwise "x,y,z" to 17 digits.
std::string upText(const Eigen::Vector3d& up);

/// Half-open range of indices from text "a:b", "a:", ":b" or "", cut to [0, count).
/// @throws InputError ("--frames") for anything else and for a range without frames
std::pair<std::size_t, std::size_t> parseFrames(const std::string& text, std::size_t count);

/// Degrees between a direction and the nearest axis.
double tiltDegrees(const Eigen::Vector3d& up);

}  // namespace photonav
