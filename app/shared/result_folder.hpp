// SPDX-License-Identifier: BSD-3-Clause
// The folder that a command writes its results to, and what it prints at the end.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "io/folder_transaction.hpp"
#include "report/report.hpp"
#include "shared/command_io.hpp"

namespace photonav {

using InputPaths = std::vector<std::filesystem::path>;  ///< files and folders; empty ones are none

/// Begins the result at a folder; it is there once it is committed.
/// @param inputs what this run reads
/// @throws InputError also when the folder is or contains an input
FolderTransaction beginResult(
    const std::filesystem::path& folder, const InputPaths& inputs,
    FolderTransaction::Unfinished unfinished = FolderTransaction::Unfinished::removed);

/// The same at the folder of the options, or at out/<command>-<config name>.
/// @param inputs besides the config
FolderTransaction beginResult(const CommandOptions& options, const std::string& command,
                              InputPaths inputs = {});

/// Writes result.json, the last file of a result, and commits the folder.
void commitResult(FolderTransaction& folder, const nlohmann::json& result);

/// The same, and then prints result.json as asked for, else a summary and where the report is.
void concludeResult(FolderTransaction& folder, const CommandOptions& options,
                    const nlohmann::json& result, const std::function<void()>& printSummary);

/// Prints result.json as asked for, else the summary and where the `files` of the folder are.
void printOutput(const OutputOptions& output, const nlohmann::json& result,
                 const ReportTable& summary, const std::vector<std::string>& files);

/// Prints the rows, values below each other.
void printTable(const ReportTable& table);

/// "report: out/plan-room/report.html"
void printFile(const std::filesystem::path& file);

}  // namespace photonav
