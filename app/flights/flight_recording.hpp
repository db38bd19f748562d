// SPDX-License-Identifier: BSD-3-Clause
// The recording of a flight that `--record` asks for.
#pragma once

#include <filesystem>
#include <optional>

#include "flight/flight_recorder.hpp"
#include "flight/flight_setup.hpp"
#include "io/folder_transaction.hpp"

namespace photonav {

/// Begins with the first image; its folder is there once it is committed.
class FlightRecording {
  public:
    /// @param folder empty: nothing is recorded
    /// @param result the folder of the result, from which a recording is apart
    /// @param images how they are aligned: the recording states their blur and their information
    /// @throws InputError where the folder holds a recording already, or the result
    FlightRecording(const std::filesystem::path& folder, const std::filesystem::path& result,
                    const Camera& camera, const AlignmentOptions& images);

    /// Adds an exposure; empty where nothing is recorded. Must not outlive the recording.
    OnExposure onExposure();

    /// Does nothing without an image.
    void commit();

  private:
    Camera camera_;
    double informationScale_, blur_;
    std::optional<FolderTransaction> folder_;
    std::optional<FlightRecorder> recorder_;  // from the first image on
};

}  // namespace photonav
