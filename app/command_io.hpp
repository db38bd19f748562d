// SPDX-License-Identifier: BSD-3-Clause
// What all commands share: the result folder and the terminal.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "camera.hpp"

namespace photonav {

enum ExitCode { kDone = 0, kNoAnswer = 1, kBadInput = 2, kInterrupted = 130 };

struct CommandOptions {
    std::string config;                  ///< YAML file
    std::vector<std::string> overrides;  ///< key.path=value
    std::filesystem::path out;           ///< result folder; empty: out/<command>-<config name>
    bool quiet = false;                  ///< no progress, no summary
    bool json = false;                   ///< result.json on standard output as well
    std::string commandLine;             ///< as typed, for the report
};

/// Makes the result folder and checks that files can be written there, before any work is done.
/// @throws InputError otherwise
void prepareFolder(const std::filesystem::path& folder);

/// What ends without a result leaves no new, empty folder behind. To be made before the folder is:
/// one that is there already, or a link to one, stays.
class NoEmptyFolder {
  public:
    explicit NoEmptyFolder(std::filesystem::path folder);
    ~NoEmptyFolder();
    NoEmptyFolder(const NoEmptyFolder&) = delete;
    NoEmptyFolder& operator=(const NoEmptyFolder&) = delete;

  private:
    std::filesystem::path folder_;
    bool isNew_;
};

/// The folder of the options, or the default one, prepared: nothing of an earlier run is left that
/// this one might not write.
std::filesystem::path resultFolder(const CommandOptions& options, const std::string& command);

/// A single line on standard error that is overwritten on a terminal, and dropped elsewhere.
class ProgressLine {
  public:
    explicit ProgressLine(bool quiet);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    void show(const std::string& text);
    void clear();

  private:
    bool enabled_;
    std::size_t width_ = 0;
};

/// A JSON number, or null where there is none (infinite or NaN).
nlohmann::json finiteOrNull(double value);
nlohmann::json orNull(const std::optional<double>& value);

/// Size and intrinsics [pixels].
nlohmann::json cameraJson(const Camera& camera);

}  // namespace photonav
