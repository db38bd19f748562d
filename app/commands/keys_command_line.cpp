// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include "commands/command_line.hpp"
#include "commands/replay_command.hpp"
#include "config/config_keys.hpp"
#include "mapping/map_config.hpp"

namespace photonav {
namespace {

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

}  // namespace

Command keysCommand(CLI::App& app) {
    auto names = std::make_shared<std::vector<std::string>>();
    auto command = std::make_shared<std::string>("plan");
    CLI::App* parser =
        app.add_subcommand("keys", "List the keys of a config: values, units, meaning.");
    parser->add_option("names", *names, "sections or keys (default: all)");
    parser->add_option("--of", *command, "plan (also sweep, fly, ...), map, scans (map) or replay")
        ->check(CLI::IsMember({"plan", "map", "scans", "replay"}))
        ->capture_default_str();
    return {parser, [names, command] {
                Config config;
                MapOptions map;
                ScanMapOptions scans;
                ReplayCommandOptions replay;
                const KeyTable keys = *command == "map"      ? keysOf(map)
                                      : *command == "scans"  ? keysOf(scans)
                                      : *command == "replay" ? keysOf(replay)
                                                             : keysOf(config);
                const std::string table = keys.toMarkdown(*names);
                const bool isTerminal = isatty(STDOUT_FILENO) == 1;
                fmt::print("{}", isTerminal ? withoutLinks(table) : table);
                return static_cast<int>(kDone);
            }};
}

}  // namespace photonav
