// SPDX-License-Identifier: BSD-3-Clause
// Completion of command lines in shells, from the options of the commands themselves.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "config/config_keys.hpp"
#include "planners/planner_traits.hpp"
#include "shared/command_line.hpp"

namespace photonav {
namespace {

using Words = std::vector<std::string>;

/// What may follow an option, or stand as an argument.
struct Values {
    Words words = {};     ///< none: any file
    bool isList = false;  ///< several words with commas between them
    bool goesOn = false;  ///< the word is only the beginning of the value
    std::string joined() const { return fmt::format("{}", fmt::join(words, " ")); }
};

std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
    const auto all = app.get_subcommands([](const CLI::App*) { return true; });
    return {all.begin(), all.end()};
}

bool isFlag(const CLI::Option& option) { return option.get_expected_max() == 0; }

/// With which an option begins on a command line.
Words namesOf(const CLI::App& command) {
    Words names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

Words keysToSet() {
    Config config;
    Words keys;
    const KeyTable table = keysOf(config);
    for (const ConfigKey& key : table.keys()) keys.push_back(key.path());
    return keys;
}

Values valuesOf(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    if (type == kPlannersType) return {plannerNames(), true};
    if (type == kKeyType) return {keysToSet()};
    if (type == kOverrideType) {
        Words keys = keysToSet();
        for (std::string& key : keys) key += '=';
        return {keys, false, true};
    }
    const std::size_t begin = type.find('{'), end = type.find('}');
    if (begin == std::string::npos || end == std::string::npos) return {};
    return {CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',')};
}

/// The values of the arguments of a command.
Values argumentsOf(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_positional()) return valuesOf(*option);
    }
    return {};
}

/// The cases of bash that set a variable, one for all that have the same values.
std::string bashCases(const std::map<std::string, Words>& patternsOf, const char* variable) {
    std::string cases;
    for (const auto& [values, patterns] : patternsOf) {
        cases += fmt::format("        \"{}\") {}=\"{}\" ;;\n", fmt::join(patterns, "\" | \""),
                             variable, values);
    }
    return cases;
}

std::string bashScript(const CLI::App& app) {
    Words commands;
    std::map<std::string, Words> options, values, lists;
    for (const CLI::App* command : commandsOf(app)) {
        const std::string name = command->get_name();
        commands.push_back(name);
        options[fmt::format("{}", fmt::join(namesOf(*command), " "))].push_back(name);
        values[argumentsOf(*command).joined()].push_back(name + " ");
        for (const CLI::Option* option : command->get_options()) {
            const Values own = isFlag(*option) ? argumentsOf(*command) : valuesOf(*option);
            for (const std::string& word : option->get_lnames()) {
                (own.isList ? lists : values)[own.joined()].push_back(name + " --" + word);
            }
        }
    }
    values.erase("");  // files
    return fmt::format(R"(# Completion of photonav in bash; made by `photonav completion bash`.
_photonav() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
    local command=${{COMP_WORDS[1]}} options= values= list=
    if [ "$COMP_CWORD" -eq 1 ]; then
        COMPREPLY=($(compgen -W "{} --help --version" -- "$current"))
        return
    fi
    case $command in
{}    esac
    [[ $previous == -* ]] || previous=
    case "$command $previous" in
{}{}    esac
    if [[ $current == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$current"))
    elif [ -n "$list" ]; then
        compopt -o nospace
        COMPREPLY=($(compgen -P "${{current%"${{current##*,}}"}}" -W "$list" -- "${{current##*,}}"))
    elif [ -n "$values" ]; then
        [[ $previous != --set ]] || compopt -o nospace
        COMPREPLY=($(compgen -W "$values" -- "$current"))
    else
        compopt -o filenames
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
    fi
}}
complete -F _photonav photonav
)",
                       fmt::join(commands, " "), bashCases(options, "options"),
                       bashCases(values, "values"), bashCases(lists, "list"));
}

/// A text between the apostrophes of a zsh script, as part of an argument that uses `special`
/// characters itself.
std::string zshText(const std::string& text, std::string_view special) {
    std::string line;
    for (const char c : text) {
        if (c == '\'') {
            line += "'\\''";
            continue;
        }
        if (c == '\\' || special.find(c) != std::string_view::npos) line += '\\';
        line += c == '\n' ? ' ' : c;
    }
    return line;
}

/// The action of zsh's _arguments that completes values.
std::string zshAction(const Values& values) {
    if (values.words.empty()) return "_files";
    if (values.isList) return "_sequence compadd - " + values.joined();
    return values.goesOn ? "_photonav_keys" : fmt::format("({})", values.joined());
}

/// The arguments of zsh's _arguments: name, description and, unless it is a flag, its value.
std::string zshArguments(const CLI::App& command) {
    std::string arguments;
    for (const CLI::Option* option : command.get_options()) {
        const std::string value = isFlag(*option) ? "" : ":value:" + zshAction(valuesOf(*option));
        for (const std::string& name : option->get_lnames()) {
            arguments += fmt::format(" \\\n                '*--{}[{}]{}'", name,
                                     zshText(option->get_description(), "[]:"), value);
        }
    }
    return arguments +
           fmt::format(" \\\n                '*:argument:{}'", zshAction(argumentsOf(command)));
}

std::string zshScript(const CLI::App& app) {
    std::string commands, cases;
    for (const CLI::App* command : commandsOf(app)) {
        commands += fmt::format("            '{}:{}'\n", command->get_name(),
                                zshText(command->get_description(), ":"));
        cases += fmt::format("        {})\n            _arguments{} ;;\n", command->get_name(),
                             zshArguments(*command));
    }
    return fmt::format(R"(#compdef photonav
# Completion of photonav in zsh; made by `photonav completion zsh`.
_photonav_keys() {{
    compadd -S = -- {}
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
