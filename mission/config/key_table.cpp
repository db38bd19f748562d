// SPDX-License-Identifier: BSD-3-Clause
#include "config/key_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "io/reading.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

std::string textOf(Range range) {
    if (range.min == 0. && std::isinf(range.max)) return ">= 0";
    if (std::isinf(range.min)) return "";
    if (std::isinf(range.max)) return fmt::format(">= {}", range.min);
    return fmt::format("{}{} to {}", range.orZero ? "0, " : "", numberText(range.min),
                       numberText(range.max));
}

void readInRange(YamlMap& map, const std::string& name, double& value, Range range) {
    double found = value;
    map.read(name, found);
    map.readNumber(name, value, range.orZero && found == 0. ? 0. : range.min, range.max);
}

/// For a cell of a Markdown table.
std::string quoted(const std::string& value) {
    return value.empty() ? value : fmt::format("`{}`", value);
}

std::string valueText(const ConfigKey& key) {
    const YAML::Node value = key.value();
    if (value.IsNull() || (value.IsScalar() && value.Scalar().empty())) return "";
    return YAML::Dump(value);
}

}  // namespace

YAML::Node yamlNumber(double value) { return YAML::Node(fmt::format("{}", value)); }

YAML::Node yamlList(const std::vector<double>& numbers) {
    YAML::Node list(YAML::NodeType::Sequence);
    for (const double number : numbers) list.push_back(yamlNumber(number));
    list.SetStyle(YAML::EmitterStyle::Flow);
    return list;
}

YAML::Node yamlList(const std::vector<std::string>& words) {
    YAML::Node list(words);
    list.SetStyle(YAML::EmitterStyle::Flow);
    return list;
}

std::string resolvedPath(const std::string& path, const std::string& file) {
    if (path.empty() || file.empty() || fs::path(path).is_absolute()) return path;
    return fs::weakly_canonical(fs::absolute(file).parent_path() / path).string();
}

std::string ConfigKey::path() const {
    return section.empty() ? words.name : section + "." + words.name;
}

std::string ConfigKey::description() const {
    std::string text = words.meaning;
    std::erase(text, '`');
    if (!words.unit.empty()) text += fmt::format(" [{}]", words.unit);
    const std::string present = valueText(*this);
    return present.empty() ? text : fmt::format("{} (default: {})", text, present);
}

void ConfigKey::set(const std::string& text) const {
    YAML::Node node(YAML::NodeType::Map);
    try {
        node[words.name] = isFile || isText ? YAML::Node(text) : parseYaml(text, "");
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) {
        throw InputError("", "", "cannot read the value '" + text + "'");
    }
    YamlMap map("", node);
    read(map);
}

void KeyTable::number(const KeyWords& words, double& value, Range range) {
    add({.words = words,
         .allowed = textOf(range),
         .read = [&value, range,
                  name = words.name](YamlMap& map) { readInRange(map, name, value, range); },
         .value = [&value] { return yamlNumber(value); }});
}

void KeyTable::number(const KeyWords& words, std::optional<double>& value, Range range) {
    add({.words = words,
         .allowed = textOf(range),
         .read =
             [&value, range, name = words.name](YamlMap& map) {
                 double number = value.value_or(range.min);
                 readInRange(map, name, number, range);
                 if (map.has(name)) value = number;
             },
         .value = [&value] { return value ? yamlNumber(*value) : YAML::Node(); }});
}

void KeyTable::flag(const KeyWords& words, bool& value) {
    add({.words = words,
         .allowed = "true, false",
         .read = [&value, name = words.name](YamlMap& map) { map.read(name, value); },
         .value = [&value] { return YAML::Node(value); }});
}

void KeyTable::text(const KeyWords& words, std::string& value) {
    add({.words = words,
         .isText = true,
         .read = [&value, name = words.name](YamlMap& map) { map.read(name, value); },
         .value = [&value] { return value.empty() ? YAML::Node() : YAML::Node(value); }});
}

void KeyTable::file(const KeyWords& words, std::string& value) {
    add({.words = words,
         .isFile = true,
         .read =
             [&value, name = words.name](YamlMap& map) {
                 map.read(name, value);
                 if (map.has(name)) value = resolvedPath(value, map.file());
             },
         .value =
             [&value] {
                 return value.empty() ? YAML::Node()
                                      : YAML::Node(fs::absolute(value).lexically_normal().string());
             }});
}

void KeyTable::requiredFile(const KeyWords& words, std::string& value) {
    file(words, value);
    keys_.back().read = [read = keys_.back().read, name = words.name](YamlMap& map) {
        if (!map.has(name)) map.fail(name, "missing");
        read(map);
    };
}

void KeyTable::choice(const KeyWords& words, std::string& value,
                      const std::vector<std::string>& choices) {
    add({.words = words,
         .allowed = fmt::format("{}", fmt::join(choices, ", ")),
         .choices = choices,
         .read =
             [&value, choices, name = words.name](YamlMap& map) {
                 if (map.has(name) || !value.empty()) map.readChoice(name, value, choices);
             },
         .value = [&value] { return value.empty() ? YAML::Node() : YAML::Node(value); }});
}

void KeyTable::variances(const KeyWords& words, Matrix6& value) {
    static const Vector6 kLargest =
        (Vector6() << Eigen::Vector3d::Constant(100.), Eigen::Vector3d::Constant(10.)).finished();
    add({.words = words,
         .allowed = "0 to 100 m^2, 0 to 10 rad^2",
         .read =
             [&value, name = words.name](YamlMap& map) {
                 Vector6 variances = value.diagonal();
                 map.readVector<6>(name, variances);
                 if ((variances.array() < 0.).any()) map.fail(name, "negative variance");
                 if ((variances.array() > kLargest.array()).any()) {
                     map.fail(name,
                              "variance above 100 m^2 (position) or 10 rad^2 (rotation: any "
                              "heading at all)");
                 }
                 value = variances.asDiagonal();
             },
         .value =
             [&value] {
                 const Vector6 d = value.diagonal();
                 return yamlList(std::vector<double>(d.data(), d.data() + 6));
             }});
}

void KeyTable::addCount(const KeyWords& words, Range range,
                        std::function<std::optional<double>()> get,
                        std::function<void(double)> set) {
    add({.words = words,
         .allowed = textOf(range),
         .read =
             [=, name = words.name](YamlMap& map) {
                 double number = get().value_or(range.min);
                 readInRange(map, name, number, range);
                 if (number != std::floor(number)) map.fail(name, "not a whole number");
                 if (map.has(name)) set(number);
             },
         .value =
             [get] {
                 const std::optional<double> number = get();
                 return number ? yamlNumber(*number) : YAML::Node();
             }});
}

void KeyTable::addNamed(const KeyWords& words, const std::vector<std::string>& names,
                        std::function<std::size_t()> get, std::function<void(std::size_t)> set) {
    add({.words = words,
         .allowed = fmt::format("{}", fmt::join(names, ", ")),
         .choices = names,
         .read =
             [=, name = words.name](YamlMap& map) {
                 std::string chosen = names.at(get());
                 map.readChoice(name, chosen, names);
                 set(static_cast<std::size_t>(std::find(names.begin(), names.end(), chosen) -
                                              names.begin()));
             },
         .value = [=] { return YAML::Node(names.at(get())); }});
}

void KeyTable::add(ConfigKey key) {
    key.section = section_;
    keys_.push_back(std::move(key));
}

const ConfigKey* KeyTable::find(const std::string& path) const {
    const auto key = std::ranges::find(keys_, path, &ConfigKey::path);
    return key == keys_.end() ? nullptr : &*key;
}

void KeyTable::read(YamlMap& root) const {
    std::map<std::string, YamlMap> sections;
    for (const ConfigKey& key : keys_) {
        if (key.section.empty()) {
            key.read(root);
        } else {
            auto section = sections.find(key.section);
            if (section == sections.end()) {
                section = sections.emplace(key.section, root.map(key.section)).first;
            }
            key.read(section->second);
        }
    }
    std::vector<std::string> paths;
    for (const ConfigKey& key : keys_) paths.push_back(key.path());
    for (const auto& [name, section] : sections) section.finish(paths);
    root.finish(paths);
}

void KeyTable::read(const std::string& file) const {
    reading(file, [&] {
        YamlMap root(file, loadYaml(file));
        read(root);
    });
}

std::string KeyTable::toYaml() const {
    YAML::Node root(YAML::NodeType::Map);
    for (const ConfigKey& key : keys_) {
        const YAML::Node value = key.value();
        if (value.IsNull()) continue;
        if (key.section.empty()) {
            root[key.words.name] = value;
        } else {
            root[key.section][key.words.name] = value;
        }
    }
    return YAML::Dump(root) + "\n";
}

std::string KeyTable::toMarkdown(const std::vector<std::string>& names) const {
    for (const std::string& name : names) {
        const bool isKnown = std::ranges::any_of(
            keys_, [&](const ConfigKey& key) { return key.section == name || key.path() == name; });
        if (isKnown) continue;
        std::vector<std::string> known;
        for (const ConfigKey& key : keys_) known.insert(known.end(), {key.section, key.path()});
        const std::vector<std::string> same = pathsOf(name, known);
        const std::string near =
            same.empty() ? nearestWord(name, known) : fmt::format("{}", fmt::join(same, "' or '"));
        throw InputError(name, "",
                         "is neither a key nor a section of a config" +
                             (near.empty() ? "" : ", did you mean '" + near + "'?"));
    }
    std::string text = "| key | default | unit | values | |\n|---|---|---|---|---|\n";
    for (const ConfigKey& key : keys_) {
        const bool isAsked = std::ranges::any_of(names, [&](const std::string& name) {
            return key.section == name || key.path() == name;
        });
        if (!isAsked && !names.empty()) continue;
        text += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.path(), quoted(valueText(key)),
                            key.words.unit, key.allowed, key.words.meaning);
    }
    return text;
}

}  // namespace photonav
