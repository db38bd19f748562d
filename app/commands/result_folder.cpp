// SPDX-License-Identifier: BSD-3-Clause
#include "commands/result_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/atomic_file.hpp"
#include "io/error.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

constexpr const char* kMarker = ".photonav";
constexpr const char* kMarkerText =
    "This folder was made by photonav, which replaces and removes results in it.\n";

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

/// What commands write besides.
constexpr std::array kAlsoWritten{
    "config.yaml",    "report.html",      "report.json",      "runs.jsonl",      "runs.csv",
    "summary.csv",    "sweep.png",        "paths.png",        "benchmark.log",   "pareto.png",
    "map.ot",         "map_color.ot",     "map.bt",           "convergence.png", "comparison_0.png",
    "trajectory.tum", "trajectory.cov",   "trajectory.ov",    "groundtruth.tum", "frames.csv",
    "strips.png",     "calibration.yaml", "comparison_1.png", "comparison_2.png"};

/// Whether result.json is one that this program wrote.
bool isResult(const fs::path& file) {
    std::ifstream stream(file);
    const auto result = nlohmann::json::parse(stream, nullptr, false);
    return result.is_object() && result.contains("schema") && result.contains("command") &&
           result.contains("version");
}

bool isOfResults(const fs::path& folder) {
    return fs::exists(folder / kMarker) || isResult(folder / "result.json");
}

/// The first file that a result would replace or remove; nothing: there is none.
std::optional<fs::path> firstInTheWay(const fs::path& folder) {
    const auto isThere = [&](const char* name) { return fs::exists(folder / name); };
    const auto a = std::ranges::find_if(kAlsoWritten, isThere);
    if (a != kAlsoWritten.end()) return folder / *a;
    const auto b = std::ranges::find_if(kSometimesWritten, isThere);
    if (b != kSometimesWritten.end()) return folder / *b;
    return {};
}

bool isInside(const fs::path& path, const fs::path& folder) {
    const fs::path way =
        fs::weakly_canonical(fs::absolute(path))
            .lexically_relative((fs::weakly_canonical(fs::absolute(folder)) / "").parent_path());
    return !way.empty() && *way.begin() != "..";
}

}  // namespace

void prepareFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InputError(folder.string(), "", "cannot be made: " + error.message());
    const fs::path probe = folder / ".probe";
    writeFileAtomically(probe, "");
    fs::remove(probe, error);
}

void claimFolder(const fs::path& folder, const InputPaths& inputs) {
    for (const fs::path& input : inputs) {
        if (input.empty() || !isInside(input, folder)) continue;
        throw InputError("--out", folder.string(),
                         fmt::format("is or contains {}, which this run reads; give another folder",
                                     input.string()));
    }
    if (!isOfResults(folder)) {
        if (const auto file = firstInTheWay(folder)) {
            throw InputError("--out", file->string(),
                             "would be replaced, and no earlier result made this folder");
        }
    }
    prepareFolder(folder);
    writeFileAtomically(folder / kMarker, kMarkerText);
}

fs::path resultFolder(const CommandOptions& options, const std::string& command,
                      InputPaths inputs) {
    fs::path folder = options.out;
    if (folder.empty()) {
        folder = fs::path("out") / (command + "-" + fs::path(options.config).stem().string());
    }
    inputs.emplace_back(options.config);
    claimFolder(folder, inputs);
    for (const char* stale : kSometimesWritten) fs::remove(folder / stale);
    return folder;
}

NoEmptyFolder::NoEmptyFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code ignored;
    isNew_ = fs::symlink_status(folder_, ignored).type() == fs::file_type::not_found;
}

NoEmptyFolder::~NoEmptyFolder() {
    std::error_code error;
    const auto files = std::distance(fs::directory_iterator(folder_, error), {});
    if (error) return;
    if (files == 1) fs::remove(folder_ / kMarker, error);
    if (isNew_) fs::remove(folder_, error);  // fails unless it is empty
}

}  // namespace photonav
