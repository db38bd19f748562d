// SPDX-License-Identifier: BSD-3-Clause
// Recordings in the layout of the TUM RGB-D benchmark.
#pragma once

#include <optional>
#include <string>

#include "dataset/sequence.hpp"
#include "io/interrupted.hpp"

namespace photonav {

struct TumOptions {
    double tolerance = 0.02;  ///< largest time between images, or image and pose [s]
    double maxPoseGap = 0.1;  ///< interpolate between poses at most this far apart [s]
    std::optional<double> depthScale = {};  ///< stored value of one metre; overrides the dataset's
    std::string cameraFile = {};            ///< instead of the dataset's camera.yaml
    /// For trackers: frames without pose are kept, groundtruth.txt need not be there, and rows that
    /// cannot be read or whose timestamps repeat or are out of order are skipped.
    bool forgiving = false;
    /// False: colour images without a depth image are kept as well, and `depth.txt` and the files
    /// that it names may be missing or unusable.
    bool needsDepth = true;
};

/// Reads the tables of a dataset, no images:
/// - `rgb.txt`, `depth.txt` (`t file`): every colour image is paired with the depth image nearest
///   in time within the tolerance, closest pairs first, each image used at most once; or, when
///   there, `assoc.txt` or `associations.txt` (`t file t file`, colour first; depth first when the
///   first file lies in a folder `depth`), whose pairs are taken as they are;
/// - `groundtruth.txt`: the pose at the time of the colour image (see poseAt);
/// - `camera.yaml` when there: what readCameraFile() reads. Without a file the benchmark's Kinect
/// is
///   assumed: 640x480, 525, 525, 319.5, 239.5, with depth_scale 5000.
/// Images without partner or pose are listed as skipped.
/// @throws InputError naming file, line or key, and reason; also when no frame is left, or no pose
///         belongs to any frame. Timestamps may repeat but never decrease.
Sequence readTumSequence(const std::string& folder, const TumOptions& options = {});

/// Loads the images of frame `index`: 8-bit colour by OpenCV's grey conversion to [0, 1], 16-bit
/// depth to metres along the optical axis, as the colour camera sees it (registeredDepth()); 0
/// everywhere in a frame without depth image, or, where the sequence needs none, without a usable
/// one.
/// @param isStopped asked between the two images
/// @throws InputError for a file that is missing, damaged or of another size than the camera's
/// @throws Interrupted when isStopped returns true
RecordedFrame loadFrame(const Sequence& sequence, std::size_t index,
                        const IsStopped& isStopped = {});

/// The depth image of frame `index` as it was recorded, in the depth camera's frame [m].
/// @throws InputError as loadFrame(), and for a frame without depth image
ImageF loadDepth(const Sequence& sequence, std::size_t index);

}  // namespace photonav
