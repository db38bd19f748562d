// SPDX-License-Identifier: BSD-3-Clause
// The text of --help: at most 80 columns wide.
#include "shared/command_line.hpp"
#include "shared/wrapped_text.hpp"

namespace photonav {
namespace {

constexpr std::size_t kColumn = 26;  // where descriptions begin

std::string row(const std::string& name, const std::string& description) {
    std::string line = "  " + name;
    if (line.size() + 1 < kColumn) {
        line.resize(kColumn, ' ');
    } else {
        line += "\n" + std::string(kColumn, ' ');
    }
    return line + wrappedText(description, kColumn) + "\n";
}

/// CLI11 appends to the name of the type the values that are allowed: a set, which is shown, or a
/// range, which only its error messages show.
std::string typeOf(const CLI::Option& option) {
    const std::string name = option.get_type_name();
    if (const auto set = name.find(":{"); set != std::string::npos) return name.substr(set + 1);
    const std::string type = name.substr(0, name.find(name.ends_with(']') ? ":" : "::"));
    return type == "INT" || type == "UINT" || type == "FLOAT" ? "NUMBER" : type;
}

class HelpFormat : public CLI::Formatter {
  public:
    HelpFormat() {
        label("Positionals", "Arguments");
        label("SUBCOMMAND", "COMMAND");
    }
    std::string make_description(const CLI::App* app) const override {
        const bool isCommand = app->get_parent() != nullptr;
        return (isCommand ? wrappedText(app->get_description(), 0) : app->get_description()) + "\n";
    }
    std::string make_subcommand(const CLI::App* command) const override {
        return row(command->get_name(), command->get_description());
    }
    std::string make_option(const CLI::Option* option, bool isPositional) const override {
        std::string name = make_option_name(option, isPositional);
        name.resize(std::min(name.find('{'), name.size()));  // "{false}" of a flag that negates
        std::string description = option->get_description();
        if (option->get_type_size() != 0) {
            const std::string type = typeOf(*option);
            if (!isPositional && !type.empty()) name += " " + type;
            const std::string& preset = option->get_default_str();
            if (!preset.empty()) description += " (default: " + preset + ")";
        }
        return row(name, description);
    }
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> helpFormat() { return std::make_shared<HelpFormat>(); }

}  // namespace photonav
