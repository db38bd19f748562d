// SPDX-License-Identifier: BSD-3-Clause
#include "command_io.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "atomic_file.hpp"
#include "error.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

/// What `plan`, `info`, `fly` and `benchmark` write into their folder, but not always.
constexpr std::array kSometimesWritten{
    "result.json",
    "path.tum",
    "top_view.png",
    "perspective.png",
    "information.png",
    "trace.png",
    "recorded_frames.png",
    "tree_evolution.png",
    "uncertainty.png",
    "view.png",
    "contribution.png",
    "contribution_right.png",
    "contribution_down.png",
    "contribution_forward.png",
    "contribution_about_right.png",
    "contribution_about_down.png",
    "contribution_about_forward.png",
    "overview.png",
    "progress.png",
    "errors.png",
    "nees.png",
};

}  // namespace

NoEmptyFolder::NoEmptyFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code ignored;
    isNew_ = fs::symlink_status(folder_, ignored).type() == fs::file_type::not_found;
}

NoEmptyFolder::~NoEmptyFolder() {
    std::error_code isNotEmpty;
    if (isNew_) fs::remove(folder_, isNotEmpty);
}

void prepareFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InputError(folder.string(), "", "cannot be made: " + error.message());
    const fs::path probe = folder / ".probe";
    writeFileAtomically(probe, "");
    fs::remove(probe, error);
}

fs::path resultFolder(const CommandOptions& options, const std::string& command) {
    fs::path folder = options.out;
    if (folder.empty()) {
        folder = fs::path("out") / (command + "-" + fs::path(options.config).stem().string());
    }
    prepareFolder(folder);
    for (const char* stale : kSometimesWritten) fs::remove(folder / stale);
    return folder;
}

ProgressLine::ProgressLine(bool quiet) : enabled_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
    if (enabled_ && width_ > 0) fmt::print(stderr, "\r{:{}}\r", "", width_);
    width_ = 0;
}

void ProgressLine::show(const std::string& text) {
    if (!enabled_) return;
    fmt::print(stderr, "\r{:{}}", text, std::max(width_, text.size()));
    std::fflush(stderr);
    width_ = text.size();
}

nlohmann::json finiteOrNull(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

nlohmann::json orNull(const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

nlohmann::json cameraJson(const Camera& camera) {
    return {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx()},
            {"fy", camera.fy()},     {"cx", camera.cx()},       {"cy", camera.cy()}};
}

}  // namespace photonav
