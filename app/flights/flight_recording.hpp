// SPDX-License-Identifier: BSD-3-Clause
// The recording of a flight, for the option --record.
#pragma once

#include <filesystem>
#include <optional>

#include "flight/flight_recorder.hpp"
#include "flight/flight_setup.hpp"
#include "io/folder_transaction.hpp"
#include "shared/result_folder.hpp"

namespace photonav {

/// Writes the images of a flight as a TUM RGB-D recording. The folder appears at its place with
/// commit().
class FlightRecording {
  public:
    /// @param folder folder of the recording; empty: nothing is recorded
    /// @param result result folder of the command; neither folder may contain the other
    /// @param inputs files and folders that the command reads
    /// @param camera camera of the flight
    /// @param images give blur and information scale of the images, for the recording's camera file
    /// @throws InputError if the folder already holds a recording, contains an input, or contains
    ///         or is inside the result folder
    FlightRecording(const std::filesystem::path& folder, const std::filesystem::path& result,
                    const InputPaths& inputs, const Camera& camera, const AlignmentOptions& images);

    /// A callback that adds an exposure; empty if nothing is recorded. It must not outlive the
    /// recording.
    OnExposure onExposure();

    /// Completes the recording; does nothing if no image was added.
    void commit();

  private:
    Camera camera_;
    double informationScale_, blur_;
    std::optional<FolderTransaction> folder_;
    std::optional<FlightRecorder> recorder_;  // created with the first image
};

}  // namespace photonav
