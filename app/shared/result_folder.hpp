// SPDX-License-Identifier: BSD-3-Clause
// Writes the result folder of a command and prints its summary.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "io/folder_transaction.hpp"
#include "report/report.hpp"
#include "shared/command_io.hpp"

namespace photonav {

/// Files and folders that a command reads; empty paths are ignored.
using InputPaths = std::vector<std::filesystem::path>;

/// inputFiles() of a config, and what else the command reads.
InputPaths inputsOf(const Config& config, InputPaths others = {});

/// @param option names the folder in the message
/// @throws InputError if the folder is or contains an input
void checkInputsApart(const std::string& option, const std::filesystem::path& folder,
                      const InputPaths& inputs);

/// Begins to write a result folder, which appears at its place with commitResult().
/// @param inputs files and folders that the command reads
/// @param unfinished fate of the working folder if the result is not committed
/// @throws InputError if the folder is or contains an input, and as FolderTransaction does
FolderTransaction beginResult(
    const std::filesystem::path& folder, const InputPaths& inputs,
    FolderTransaction::Unfinished unfinished = FolderTransaction::Unfinished::removed);

/// Begins to write the result folder options.out, or out/<command>-<config name> if it is empty.
/// @param inputs files and folders that the command reads, without the config
FolderTransaction beginResult(const CommandOptions& options, const std::string& command,
                              InputPaths inputs = {});

/// Refuses the result folder of beginResult() before the work, for a command that begins it only
/// after the work: Ctrl-C ends that at once and leaves nothing behind.
/// @throws InputError as beginResult() does; Interrupted if Ctrl-C came in between
void checkResultFolder(const CommandOptions& options, const std::string& command,
                       const std::atomic<bool>& interrupted, InputPaths inputs = {});

/// Writes result.json, the last file of a result, and commits the folder. What an interrupted
/// command has done does not replace an earlier result, but goes to NAME-interrupted, as it says,
/// unless its work is kept for --resume (FolderTransaction::isKept()).
/// @return the folder of the result
std::filesystem::path commitResult(FolderTransaction& folder, const nlohmann::json& result);

/// Whether an interrupted command that has done nothing leaves an earlier result where it is; it
/// says so, and must not commit then.
bool keepsEarlierResult(const FolderTransaction& folder, bool isNothingDone);

/// Calls commitResult(), then prints result.json (--json), or the summary and the path of the
/// report, or nothing (--quiet).
void concludeResult(FolderTransaction& folder, const CommandOptions& options,
                    const nlohmann::json& result, const std::function<void()>& printSummary);

/// Prints result.json (--json), or the summary and the paths of `files`, or nothing (--quiet).
/// @param folder of the result
/// @param files names of files in it
void printOutput(const OutputOptions& output, const std::filesystem::path& folder,
                 const nlohmann::json& result, const ReportTable& summary,
                 const std::vector<std::string>& files);

/// Prints the rows of a table with aligned values.
void printTable(const ReportTable& table);

/// Prints the path of a file, "report: out/plan-room/report.html".
void printFile(const std::filesystem::path& file);

}  // namespace photonav
