// SPDX-License-Identifier: BSD-3-Clause
// A flight as a recording: the layout of the TUM RGB-D benchmark.
#pragma once

#include <filesystem>
#include <string>

#include "geometry/camera.hpp"
#include "simulation/simulated_camera.hpp"

namespace photonav {

/// Writes rgb/, depth/, rgb.txt, depth.txt, assoc.txt, groundtruth.txt and camera.yaml, which
/// readTumSequence() and `photonav map` read. Grey images of 8 bits, depth of 16 bits.
class FlightRecorder {
  public:
    /// Makes the folder.
    /// @param blur point spread of the images [pixels]
    /// @throws InputError when it cannot be written
    FlightRecorder(const std::filesystem::path& folder, const Camera& camera,
                   double informationScale, double blur);

    /// Depth 0 or beyond 13 m: none. @throws InputError when a file cannot be written
    void add(const Exposed& exposed);

    /// Writes the tables: until then the folder is no recording.
    void finish() const;

    std::size_t frames() const { return frames_; }

  private:
    std::filesystem::path folder_;
    std::string colour_ = "# timestamp file\n", depth_ = colour_, pairs_, poses_;
    std::size_t frames_ = 0;
};

}  // namespace photonav
