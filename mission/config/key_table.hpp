// SPDX-License-Identifier: BSD-3-Clause
// The keys of a YAML file as a table: one line per key gives its name, allowed values, unit and
// meaning, and where its value is kept. Reading, writing, command-line options and the reference in
// docs/config.md all follow from it.
#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/constants.hpp"
#include "geometry/types.hpp"
#include "io/yaml_reader.hpp"

namespace photonav {

/// Allowed values of a number.
struct Range {
    double min = -kInfinity;
    double max = kInfinity;
};

/// Name, unit and meaning of a key, as its user reads them.
struct KeyWords {
    std::string name;  ///< within its section
    std::string unit;  ///< may be empty
    std::string meaning;
};

struct ConfigKey {
    std::string section = {};  ///< empty: a key of the file itself
    KeyWords words = {};
    std::string allowed = {};  ///< allowed values in words, may be empty
    bool isFile = false;       ///< a path, relative to the file that contains it
    bool isText = false;       ///< typed on a command line it is taken as it is, not as YAML
    std::function<void(YamlMap&)> read = {};
    std::function<YAML::Node()> value = {};  ///< null: no value, not written

    /// "section.name".
    std::string path() const;
    /// Meaning, unit and present value without markup, for the help of a command.
    std::string description() const;
    /// Sets the value as typed on a command line. @throws InputError without file name
    void set(const std::string& text) const;
};

class KeyTable {
  public:
    /// Keys added from now on belong to this section; "" is the file itself.
    void beginSection(const std::string& name) { section_ = name; }

    // Keys by type. Every reference must outlive the table.

    void number(const KeyWords& words, double& value, Range range);
    void number(const KeyWords& words, std::optional<double>& value, Range range);
    void flag(const KeyWords& words, bool& value);
    void text(const KeyWords& words, std::string& value);
    void file(const KeyWords& words, std::string& value);
    /// A path without which a file cannot be read.
    void requiredFile(const KeyWords& words, std::string& value);
    void choice(const KeyWords& words, std::string& value, const std::vector<std::string>& choices);
    /// Six variances in the order of a pose's error: the diagonal of the matrix.
    void variances(const KeyWords& words, Matrix6& value);

    /// A whole number.
    template <std::integral T>
    void count(const KeyWords& words, T& value, Range range) {
        addCount(
            words, range, [&value]() -> std::optional<double> { return value; },
            [&value](double number) { value = static_cast<T>(number); });
    }

    template <std::integral T>
    void count(const KeyWords& words, std::optional<T>& value, Range range) {
        addCount(
            words, range, [&value]() -> std::optional<double> { return value; },
            [&value](double number) { value = static_cast<T>(number); });
    }

    /// @param names of the values of the enumeration, in its order
    template <typename Enum>
    requires std::is_enum_v<Enum>
    void choice(const KeyWords& words, Enum& value, const std::vector<std::string>& names) {
        addNamed(
            words, names, [&value] { return static_cast<std::size_t>(value); },
            [&value](std::size_t index) { value = static_cast<Enum>(index); });
    }

    /// A key with a reader and writer of its own; the section is the current one.
    void add(ConfigKey key);

    const std::vector<ConfigKey>& keys() const { return keys_; }
    /// The key of this path; null: there is none.
    const ConfigKey* find(const std::string& path) const;

    /// Overwrites the values that the file has.
    /// @throws InputError naming file, key and reason, also for a key that the table does not have
    void read(YamlMap& root) const;
    void read(const std::string& file) const;

    /// All values as YAML that read() reads back.
    std::string toYaml() const;

    /// Rows | key | value | unit | allowed | meaning | in Markdown.
    /// @param names of sections or keys; empty: all
    /// @throws InputError for a name that is neither
    std::string toMarkdown(const std::vector<std::string>& names) const;

  private:
    void addCount(const KeyWords& words, Range range, std::function<std::optional<double>()> get,
                  std::function<void(double)> set);
    void addNamed(const KeyWords& words, const std::vector<std::string>& names,
                  std::function<std::size_t()> get, std::function<void(std::size_t)> set);

    std::vector<ConfigKey> keys_;
    std::string section_;
};

/// Numbers as a YAML list on one line, to as many digits as they need.
YAML::Node yamlList(const std::vector<double>& numbers);
YAML::Node yamlList(const std::vector<std::string>& words);
/// A number to as many digits as it needs.
YAML::Node yamlNumber(double value);

/// A path in a file is relative to the folder of that file; one without file stays as it is.
std::string resolvedPath(const std::string& path, const std::string& file);

}  // namespace photonav
