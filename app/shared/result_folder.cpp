// SPDX-License-Identifier: BSD-3-Clause
#include "shared/result_folder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "io/interrupted.hpp"
#include "result/json_values.hpp"
#include "shared/command_io.hpp"
#include "shared/path_inside.hpp"
#include "shared/wrapped_text.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

constexpr const char* kInterruptedSuffix = "-interrupted";

bool isInterrupted(const nlohmann::json& result) {
    return result.value("interrupted", false) || result.value("status", "") == "interrupted";
}

}  // namespace

void checkInputsApart(const std::string& option, const fs::path& folder, const InputPaths& inputs) {
    for (const fs::path& input : inputs) {
        if (input.empty() || !isInside(input, folder)) continue;
        throw InputError(option, folder.string(),
                         fmt::format("is or contains {}, which this run reads; give another folder",
                                     input.string()));
    }
}

InputPaths inputsOf(const Config& config, InputPaths others) {
    const std::vector<std::string> files = inputFiles(config);
    others.insert(others.end(), files.begin(), files.end());
    return others;
}

bool keepsEarlierResult(const FolderTransaction& folder, bool isNothingDone) {
    if (!isNothingDone || !folder.hasEarlier()) return false;
    printMessage(
        fmt::format("nothing was done; the earlier result in {} stays", folder.target().string()));
    return true;
}

FolderTransaction beginResult(const fs::path& folder, const InputPaths& inputs,
                              FolderTransaction::Unfinished unfinished) {
    if (resolvedFolder(folder).string().ends_with(kInterruptedSuffix)) {
        throw InputError(
            "--out", folder.string(),
            fmt::format("ends in {}, as folders of interrupted commands do; give another folder",
                        kInterruptedSuffix));
    }
    checkInputsApart("--out", folder, inputs);
    checkInputsApart("--out", FolderTransaction::placeBeside(folder, kInterruptedSuffix), inputs);
    return FolderTransaction(folder, unfinished);
}

FolderTransaction beginResult(const CommandOptions& options, const std::string& command,
                              InputPaths inputs) {
    fs::path folder = options.out;
    if (folder.empty()) {
        folder = fs::path("out") / (command + "-" + fs::path(options.config).stem().string());
    }
    inputs.emplace_back(options.config);
    return beginResult(folder, inputs);
}

void checkResultFolder(const CommandOptions& options, const std::string& command,
                       const std::atomic<bool>& interrupted, InputPaths inputs) {
    beginResult(options, command, std::move(inputs));
    throwIfStopped(interrupted);
}

fs::path commitResult(FolderTransaction& folder, const nlohmann::json& result) {
    writeFileAtomically(folder.path() / "result.json", jsonText(result));
    if (!isInterrupted(result) || folder.isKept() || !folder.hasEarlier()) {
        folder.commit();
        return folder.target();
    }
    const std::string earlier = folder.target().string();
    folder.commitBeside(kInterruptedSuffix);
    printMessage(fmt::format("the earlier result in {} stays; what was done is in {}", earlier,
                             folder.target().string()));
    return folder.target();
}

void concludeResult(FolderTransaction& folder, const CommandOptions& options,
                    const nlohmann::json& result, const std::function<void()>& printSummary) {
    commitResult(folder, result);
    if (options.json) {
        fmt::print("{}", jsonText(result));
    } else if (!options.quiet) {
        printSummary();
        printFile(folder.target() / "report.html");
    }
}

void printOutput(const OutputOptions& output, const fs::path& folder, const nlohmann::json& result,
                 const ReportTable& summary, const std::vector<std::string>& files) {
    if (output.json) {
        fmt::print("{}", jsonText(result));
    } else if (!output.quiet) {
        printTable(summary);
        for (const std::string& file : files) printFile(folder / file);
    }
}

void printTable(const ReportTable& table) {
    std::size_t width = 0;
    for (const auto& row : table.rows) width = std::max(width, row.first.size() + 2);
    for (const auto& [label, value] : table.rows) {
        fmt::print("{:<{}}{}\n", label, width, wrappedText(value, width));
    }
}

void printFile(const fs::path& file) {
    fmt::print("{}: {}\n", file.stem().string(), file.string());
}

}  // namespace photonav
