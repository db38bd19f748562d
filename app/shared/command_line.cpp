// SPDX-License-Identifier: BSD-3-Clause
#include "shared/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/error.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

/// The list that somebody typed, with or without its brackets, as help and files write it.
std::string asList(const std::string& typed) {
    return typed.starts_with("[") ? typed : "[" + typed + "]";
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

/// The name of the type of a key's value: a fixed set of values as "{a,b}".
std::string typeNameOf(const ConfigKey& key) {
    if (!key.choices.empty()) return fmt::format("{{{}}}", fmt::join(key.choices, ","));
    return key.isFile ? "FILE" : "VALUE";
}

}  // namespace

const CLI::Validator& notEmpty() {
    static const CLI::Validator validator(
        [](const std::string& text) {
            return std::string(text.empty() ? "must not be empty" : "");
        },
        "");
    return validator;
}

void addOutput(CLI::App& parser, const OutputOptions& output, const std::string& defaultFolder) {
    parser
        .add_option("--out", output.out, fmt::format("result folder (default: {})", defaultFolder))
        ->type_name("DIR")
        ->check(notEmpty());
    addQuiet(parser, output.quiet);
    parser.add_flag("--json", output.json, "print result.json on standard output");
}

void addQuiet(CLI::App& parser, bool& quiet) {
    parser.add_flag("--quiet", quiet, "print no progress and no summary");
}

void addOverrides(CLI::App& parser, std::vector<std::string>& overrides) {
    parser
        .add_option_function<std::vector<std::string>>(
            "--set",
            [&overrides](const std::vector<std::string>& typed) {
                overrides.insert(overrides.end(), typed.begin(), typed.end());
            },
            "override a value of the config; can be repeated (photonav keys lists the keys)")
        ->type_name(kOverrideType)
        ->allow_extra_args(false);
}

CLI::Option* addValue(CLI::App& parser, std::vector<std::string>& overrides,
                      const std::string& name, const std::string& key,
                      const std::string& description,
                      std::function<std::string(const std::string&)> text) {
    return parser
        .add_option_function<std::string>(
            name,
            [&overrides, key, text = std::move(text)](const std::string& value) {
                overrides.insert(overrides.begin(), key + "=" + (text ? text(value) : value));
            },
            description + " (default: the config's)")
        ->type_name("VALUE");
}

void addSeed(CLI::App& parser, std::vector<std::string>& overrides, const std::string& what) {
    limit(addValue(parser, overrides, "--seed", "seed", what), 1U, 4294967295U);
}

void addPlanners(CLI::App& parser, std::vector<std::string>& overrides, const std::string& key,
                 const std::string& name) {
    addValue(parser, overrides, name, key, "names of planners: a,b,c", asList)
        ->type_name(kPlannersType);
}

void addCommon(CLI::App& parser, CommandOptions& options, bool needsConfig) {
    parser.add_option("config", options.config, "YAML file of the planning problem")
        ->required(needsConfig);
    addOverrides(parser, options.overrides);
    addOutput(parser, options, "out/<command>-<config>");
}

void addJobs(CLI::App& parser, unsigned& jobs) {
    addNumber(parser, "--jobs", jobs, "number of threads", 1U, 4096U);
}

void addManyRuns(CLI::App& parser, ManyRunsOptions& options, const RunWords& words) {
    addJobs(parser, options.jobs);
    parser.add_option("--shard", options.shard, "do only part K of N of the work")
        ->type_name("K/N");
    parser.add_option("--merge", options.merge, "make one result of the folders of all N shards")
        ->type_name("DIR...");
    parser.add_flag("--resume", options.resume,
                    fmt::format("go on with the {}s of the result folder", words.run));
}

void addRecord(CLI::App& parser, std::filesystem::path& folder) {
    parser.add_option("--record", folder, "write the first flight as a TUM RGB-D recording")
        ->type_name("DIR")
        ->check(notEmpty());
}

std::string optionOf(const ConfigKey& key) {
    std::string name = key.words.name;
    std::replace(name.begin(), name.end(), '_', '-');
    return "--" + name;
}

std::string valueOf(const ConfigKey& key, const std::string& text) {
    return key.allowed.starts_with("`[") ? asList(text) : text;
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
                ->type_name(typeNameOf(key))
                ->check([&key](const std::string& text) { return complaintAbout(key, text); });
        }
    }
}

void addKeyOverrides(CLI::App& parser, const KeyTable& keys, const std::set<std::string>& without,
                     std::vector<std::string>& overrides) {
    addKeyOptions(parser, keys, without);
    for (const ConfigKey& key : keys.keys()) {
        CLI::Option* option = parser.get_option_no_throw(optionOf(key));
        if (option == nullptr || without.contains(key.words.name)) continue;
        constexpr std::string_view kDefault = "(default: ";
        std::string description = option->get_description();
        const std::size_t place = description.find(kDefault);
        if (place == std::string::npos) continue;
        option->description(description.insert(place + kDefault.size(), "the config's, else "));
    }
    parser.parse_complete_callback([&parser, &keys, without, &overrides] {
        std::vector<std::string> typed;
        for (const ConfigKey& key : keys.keys()) {
            const CLI::Option* option = parser.get_option_no_throw(optionOf(key));
            const bool isTyped = option != nullptr && option->count() > 0;
            if (!isTyped || without.contains(key.words.name)) continue;
            std::string value = valueOf(key, option->results().back());
            if (key.isFile) value = std::filesystem::absolute(value).lexically_normal().string();
            typed.push_back(fmt::format("{}={}", key.path(), value));
        }
        overrides.insert(overrides.begin(), typed.begin(), typed.end());
    });
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
