// SPDX-License-Identifier: BSD-3-Clause
#include "flights/flight_recording.hpp"

#include "io/error.hpp"
#include "shared/path_inside.hpp"

namespace photonav {
namespace {

/// Of an earlier recording images would be left over, and it may be one that cannot be had again.
void checkRecordFolder(const std::filesystem::path& folder) {
    for (const char* list : {"rgb.txt", "assoc.txt", "rgb"}) {
        if (!std::filesystem::exists(folder / list)) continue;
        throw InputError(folder.string(), "", "holds a recording already: remove it first");
    }
}

}  // namespace

FlightRecording::FlightRecording(const std::filesystem::path& folder,
                                 const std::filesystem::path& result, const InputPaths& inputs,
                                 const Camera& camera, const AlignmentOptions& images)
    : camera_(camera), informationScale_(images.photometric.scale), blur_(images.blur) {
    if (folder.empty()) return;
    checkInputsApart("--record", folder, inputs);
    if (isInside(folder, result) || isInside(result, folder)) {
        throw InputError("--record", folder.string(),
                         "and the result's folder " + result.string() + " need to be apart");
    }
    checkRecordFolder(folder);
    folder_.emplace(folder);
}

OnExposure FlightRecording::onExposure() {
    if (!folder_) return {};
    return [this](const Exposed& exposed) {
        if (!recorder_) recorder_.emplace(folder_->path(), camera_, informationScale_, blur_);
        recorder_->add(exposed);
    };
}

void FlightRecording::commit() {
    if (!recorder_) return;
    recorder_->finish();
    folder_->commit();
}

}  // namespace photonav
