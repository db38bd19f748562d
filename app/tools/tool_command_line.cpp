// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <sstream>
#include <string>
#include <vector>

#include "bag/mcap_writer.hpp"
#include "config/config_keys.hpp"
#include "interchange/result_export.hpp"
#include "io/atomic_file.hpp"
#include "io/durable_file.hpp"
#include "io/folder_transaction.hpp"
#include "mapping/map_config.hpp"
#include "recordings/replay_command.hpp"
#include "shared/command_line.hpp"
#include "shared/result_folder.hpp"
#include "shared/wrapped_text.hpp"
#include "tools/doctor_command.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

/// The words of Markdown links alone: a terminal cannot follow links to pages of the docs.
std::string withoutLinks(const std::string& markdown) {
    std::string text;
    std::size_t end = 0;
    for (std::size_t middle = 0; (middle = markdown.find("](", end)) != std::string::npos;) {
        const std::size_t begin = markdown.rfind('[', middle), close = markdown.find(')', middle);
        if (begin == std::string::npos || begin < end || close == std::string::npos) break;
        text += markdown.substr(end, begin - end) + markdown.substr(begin + 1, middle - begin - 1);
        end = close + 1;
    }
    return text + markdown.substr(end);
}

/// A table of keys in Markdown for a terminal of 80 columns: the key, its default and its unit,
/// below them the values and what it does.
std::string asText(const std::string& table) {
    std::istringstream rows(withoutLinks(table));
    std::string text;
    for (std::string row; std::getline(rows, row);) {
        std::erase(row, '`');
        std::vector<std::string> cells;
        std::istringstream stream(row);
        for (std::string cell; std::getline(stream, cell, '|');) {
            cells.push_back(CLI::detail::trim_copy(cell));
        }
        constexpr std::size_t kCells = 6;  // with the empty one before the first bar
        const bool isKey =
            cells.size() >= kCells && row.starts_with("| ") && !row.starts_with("| key");
        if (!isKey) continue;
        const std::string unit = cells[3].empty() ? "" : fmt::format(" [{}]", cells[3]);
        text += wrappedText(fmt::format("{} = {}{}", cells[1], cells[2], unit), 0) + "\n";
        for (const std::string& words : {cells[4], cells[5]}) {
            if (!words.empty()) text += "    " + wrappedText(words, 4) + "\n";
        }
    }
    return text;
}

struct KeysOptions {
    std::vector<std::string> names;
    std::string of = "plan";
    bool markdown = false;
};

void addKeysOptions(CLI::App& parser, KeysOptions& options) {
    parser.add_option("names", options.names, "sections or keys (default: all)")
        ->type_name(kKeyType);
    parser
        .add_option("--of", options.of,
                    "command: plan (also of sweep, fly, ...), map, scans (map of point clouds) or "
                    "replay")
        ->check(CLI::IsMember({"plan", "map", "scans", "replay"}))
        ->capture_default_str();
    parser.add_flag("--markdown", options.markdown, "print a table of Markdown");
}

int printKeys(const KeysOptions& options, const std::atomic<bool>& /*interrupted*/) {
    Config config;
    MapOptions map;
    ScanMapOptions scans;
    ReplayCommandOptions replay;
    const KeyTable keys = options.of == "map"      ? keysOf(map)
                          : options.of == "scans"  ? keysOf(scans)
                          : options.of == "replay" ? keysOf(replay)
                                                   : keysOf(config);
    const std::string table = keys.toMarkdown(options.names);
    fmt::print("{}", options.markdown ? table : asText(table));
    return kDone;
}

struct ReportOptions {
    fs::path folder;
};

void addReportOptions(CLI::App& parser, ReportOptions& options) {
    parser.add_option("folder", options.folder, "result folder")->required();
}

/// A page that is not of this result is never replaced.
void checkIsOwnReport(const fs::path& folder, const fs::path& file) {
    std::error_code ignored;
    if (!fs::exists(file, ignored) || !Manifest::read(folder).empty()) return;
    throw InputError(file.string(), "",
                     "is there, in a folder without a list of its files; move it away");
}

int rebuildReport(const ReportOptions& options, const std::atomic<bool>& /*interrupted*/) {
    const fs::path file = options.folder / "report.html";
    const FolderLock lock(options.folder);
    checkIsOwnReport(options.folder, file);
    writeReport(file, readReportOf(options.folder));
    Manifest::renew(options.folder, "report.html");
    fmt::print("report: {}\n", file.string());
    return kDone;
}

struct ExportOptions {
    fs::path folder, out;
    bool quiet = false;
};

void addExportOptions(CLI::App& parser, ExportOptions& options) {
    parser.add_option("folder", options.folder, "result folder")->required();
    parser.add_option("--out", options.out, "the file (default: <folder>.mcap)")
        ->type_name("FILE")
        ->check(notEmpty());
    parser.add_flag("--quiet", options.quiet, "print nothing");
}

/// Only an earlier export is replaced, never a file of a result or of the user.
void checkExportTarget(const fs::path& file) {
    if (fs::exists(file.parent_path() / Manifest::kFileName)) {
        throw InputError("--out", file.string(), "is inside a result folder");
    }
    if (!fs::is_regular_file(file) || McapWriter::isOurs(file.string())) return;
    throw InputError("--out", file.string(),
                     "exists, and photonav did not write it; give another name");
}

int exportResult(const ExportOptions& options, const std::atomic<bool>& /*interrupted*/) {
    fs::path folder = options.folder.lexically_normal();
    if (!folder.has_filename()) folder = folder.parent_path();  // without a closing slash
    const std::string file = options.out.empty() ? folder.string() + ".mcap" : options.out.string();
    checkExportTarget(file);
    const McapExport result = exportMcap(folder, readReportOf(folder));
    replaceFile(file, result.content);
    if (!options.quiet) {
        fmt::print("{}: {} message{} over {:.1f} s, {:.1f} MB\n", file, result.messages,
                   result.messages == 1 ? "" : "s", result.duration,
                   1e-6 * static_cast<double>(result.content.size()));
    }
    return kDone;
}

struct DoctorOptions {};

}  // namespace

Commands toolCommands(CLI::App& app, const Invocation& invocation) {
    Commands commands{
        makeCommand<ReportOptions>(app, invocation, "report",
                                   "Make report.html of a result folder again.", addReportOptions,
                                   rebuildReport),
        makeCommand<ExportOptions>(app, invocation, "export",
                                   "Write a result as an MCAP file for Foxglove.", addExportOptions,
                                   exportResult),
        makeCommand<KeysOptions>(app, invocation, "keys",
                                 "List the keys of a config: values, units, meaning.",
                                 addKeysOptions, printKeys),
        completionCommand(app),
        makeCommand<DoctorOptions>(
            app, invocation, "doctor",
            "Check this installation: versions, processor, programs, a sample plan.",
            [](CLI::App&, DoctorOptions&) {},
            [](const DoctorOptions&, const std::atomic<bool>&) { return runDoctor(); })};
    for (Command& command : commands) command.onInterrupt = OnInterrupt::finishAlways;
    return commands;
}

}  // namespace photonav
