// SPDX-License-Identifier: BSD-3-Clause
#include "commands/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/error.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

const CLI::Validator& notEmpty() {
    static const CLI::Validator validator(
        [](const std::string& text) {
            return std::string(text.empty() ? "must not be empty" : "");
        },
        "");
    return validator;
}

/// Sets a key. @returns why it cannot be set, or nothing
std::string complaintAbout(const ConfigKey& key, const std::string& text) {
    try {
        key.set(valueOf(key, text));
    } catch (const InputError& error) {
        const std::string prefix = key.words.name + ": ";
        const std::string& reason = error.reason();
        return reason.starts_with(prefix) ? reason.substr(prefix.size()) : reason;
    }
    return "";
}

}  // namespace

void addOutput(CLI::App& parser, OutputOptions output, const std::string& defaultFolder) {
    parser
        .add_option("--out", output.out, fmt::format("result folder (default: {})", defaultFolder))
        ->check(notEmpty());
    parser.add_flag("--quiet", output.quiet, "no progress, no summary");
    parser.add_flag("--json", output.json, "result.json on standard output");
}

void printOutput(const OutputOptions& output, const nlohmann::json& result,
                 const ReportTable& summary, const std::vector<std::string>& files) {
    if (output.json) {
        fmt::print("{}", jsonText(result));
        return;
    }
    if (output.quiet) return;
    std::size_t width = 0;
    for (const auto& row : summary.rows) width = std::max(width, row.first.size() + 2);
    for (const auto& [label, value] : summary.rows) fmt::print("{:<{}}{}\n", label, width, value);
    for (const std::string& file : files) {
        fmt::print("{}: {}\n", std::filesystem::path(file).stem().string(),
                   (output.out / file).string());
    }
}

void addOverrides(CLI::App& parser, std::vector<std::string>& overrides) {
    parser
        .add_option("--set", overrides, "override a value of the config (photonav keys lists them)")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
}

void addValue(CLI::App& parser, CommandOptions& options, const std::string& name,
              const std::string& key, const std::string& description) {
    parser
        .add_option_function<std::string>(
            name,
            [&options, key](const std::string& value) {
                options.overrides.insert(options.overrides.begin(), key + "=" + value);
            },
            description + " (overrides the config)")
        ->type_name("VALUE");
}

void addCommon(CLI::App& parser, CommandOptions& options, bool needsConfig) {
    parser.add_option("config", options.config, "YAML file of the planning problem")
        ->required(needsConfig);
    addOverrides(parser, options.overrides);
    addOutput(parser, {options.out, options.quiet, options.json}, "out/<command>-<config>");
}

void addManyRuns(CLI::App& parser, ManyRunsOptions& options, const RunWords& words) {
    parser.add_option("--jobs", options.jobs, "threads")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    parser.add_option("--shard", options.shard, "do only part k of n")->type_name("K/N");
    parser.add_option("--merge", options.merge, "one result from the folders of all n shards")
        ->type_name("DIR...");
    parser.add_flag("--resume", options.resume,
                    fmt::format("continue the {}s of the result folder", words.run));
}

std::string optionOf(const ConfigKey& key) {
    std::string name = key.words.name;
    std::replace(name.begin(), name.end(), '_', '-');
    return "--" + name;
}

std::string valueOf(const ConfigKey& key, const std::string& text) {
    return key.allowed.starts_with("`[") ? "[" + text + "]" : text;
}

void addKeyOptions(CLI::App& parser, const KeyTable& keys, const std::set<std::string>& without) {
    for (const ConfigKey& key : keys.keys()) {
        if (without.contains(key.words.name)) continue;
        const std::string option = optionOf(key);
        const std::string description = key.description();
        if (key.allowed == "true, false") {
            parser.add_flag_function(
                fmt::format("{0},!--no-{1}", option, option.substr(2)),
                [&key](std::int64_t count) { key.set(count > 0 ? "true" : "false"); }, description);
        } else {
            parser.add_option(option, description)
                ->type_name(key.isFile ? "FILE" : "VALUE")
                ->check([&key](const std::string& text) { return complaintAbout(key, text); });
        }
    }
}

std::string folderName(const std::string& path) {
    return (std::filesystem::path(path) / "").lexically_normal().parent_path().filename().string();
}

void refuseOptionsBeside(const std::string& config, const CLI::App& parser) {
    static const std::set<std::string> allowed{"--out", "--quiet", "--json"};
    for (const CLI::Option* option : parser.get_options()) {
        const std::string name = option->get_name();
        if (option->count() > 0 && name.starts_with("--") && !allowed.contains(name)) {
            throw InputError(name, "", "not together with a config; edit " + config);
        }
    }
}

}  // namespace photonav
