// SPDX-License-Identifier: BSD-3-Clause
// Completion of command lines in shells, from the options of the commands themselves.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/config_keys.hpp"
#include "shared/command_line.hpp"

namespace photonav {
namespace {

/// A text without the characters that may not stand in quotes of a shell script.
std::string plain(const std::string& text) {
    std::string line;
    for (const char c : text) {
        if (c == '\n') line += ' ';
        if (std::string_view("[]:'\"`$\\\n").find(c) == std::string_view::npos) line += c;
    }
    return line;
}

std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
    const auto all = app.get_subcommands([](const CLI::App*) { return true; });
    return {all.begin(), all.end()};
}

/// With which an option begins on a command line.
std::vector<std::string> namesOf(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

std::vector<std::string> keysToSet() {
    Config config;
    std::vector<std::string> keys;
    const KeyTable table = keysOf(config);
    for (const ConfigKey& key : table.keys()) keys.push_back(key.path() + "=");
    return keys;
}

std::string bashScript(const CLI::App& app) {
    std::string commands, cases;
    for (const CLI::App* command : commandsOf(app)) {
        commands += command->get_name() + " ";
        cases += fmt::format("        {}) options=\"{}\" ;;\n", command->get_name(),
                             fmt::join(namesOf(*command), " "));
    }
    return fmt::format(R"(# Completion of photonav in bash; made by `photonav completion bash`.
_photonav() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} options=
    if [ "$COMP_CWORD" -eq 1 ]; then
        COMPREPLY=($(compgen -W "{}--help --version" -- "$current"))
        return
    fi
    if [ "${{COMP_WORDS[COMP_CWORD - 1]}}" = --set ]; then
        compopt -o nospace
        COMPREPLY=($(compgen -W "{}" -- "$current"))
        return
    fi
    case ${{COMP_WORDS[1]}} in
{}    esac
    if [[ $current == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$current"))
    else
        compopt -o filenames
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
    fi
}}
complete -F _photonav photonav
)",
                       commands, fmt::join(keysToSet(), " "), cases);
}

/// An argument of zsh's _arguments: name, description and, unless it is a flag, its value.
std::string zshArguments(const CLI::App& command) {
    std::string arguments;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            const bool isFlag = option->get_type_size() == 0;
            const char* value = isFlag          ? ""
                                : name == "set" ? ":key:_photonav_keys"
                                                : ":value:_files";
            arguments += fmt::format(" \\\n                '*--{}[{}]{}'", name,
                                     plain(option->get_description()), value);
        }
    }
    return arguments;
}

std::string zshScript(const CLI::App& app) {
    std::string commands, cases;
    for (const CLI::App* command : commandsOf(app)) {
        commands += fmt::format("            '{}:{}'\n", command->get_name(),
                                plain(command->get_description()));
        cases += fmt::format(
            "        {})\n            _arguments{} \\\n                '*:file:_files' ;;\n",
            command->get_name(), zshArguments(*command));
    }
    return fmt::format(R"(#compdef photonav
# Completion of photonav in zsh; made by `photonav completion zsh`.
_photonav_keys() {{
    compadd -S '' -- {}
}}
_photonav() {{
    if (( CURRENT == 2 )); then
        local -a commands=(
{}        )
        _describe command commands
        return
    fi
    local command=$words[2]
    shift words
    (( CURRENT-- ))
    case $command in
{}    esac
}}
_photonav "$@"
)",
                       fmt::join(keysToSet(), " "), commands, cases);
}

}  // namespace

Command completionCommand(CLI::App& app) {
    auto shell = std::make_shared<std::string>();
    CLI::App* parser = app.add_subcommand("completion", "Print the completion script of a shell.")
                           ->group("Commands");
    parser->add_option("shell", *shell, "bash or zsh")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh"}));
    return {parser, [&app, shell] {
                fmt::print("{}", *shell == "bash" ? bashScript(app) : zshScript(app));
                return static_cast<int>(kDone);
            }};
}

}  // namespace photonav
