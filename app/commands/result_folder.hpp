// SPDX-License-Identifier: BSD-3-Clause
// The folder that a command writes its results to. Files are replaced or removed only in a folder
// that an earlier result made.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "commands/command_io.hpp"

namespace photonav {

using InputPaths = std::vector<std::filesystem::path>;  ///< files and folders; empty ones count not

/// Makes a folder and checks that files can be written there, before any work is done.
/// @throws InputError otherwise
void prepareFolder(const std::filesystem::path& folder);

/// prepareFolder() for results: marks the folder as one of this program.
/// @param inputs what this run reads
/// @throws InputError also when the folder is or contains an input, and when it holds a file of a
///         name that results have although no result made the folder
void claimFolder(const std::filesystem::path& folder, const InputPaths& inputs);

/// The folder of the options, or the default one, claimed: nothing of an earlier run is left that
/// this one might not write.
/// @param inputs besides the config
std::filesystem::path resultFolder(const CommandOptions& options, const std::string& command,
                                   InputPaths inputs = {});

/// A run without a result leaves no new, empty folder behind. To be made before the folder is: one
/// that is there already, or a link to one, stays.
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

}  // namespace photonav
