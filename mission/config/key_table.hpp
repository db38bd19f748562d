// SPDX-License-Identifier: BSD-3-Clause
// The keys of a YAML file as a table. One entry per key gives its name, allowed values, unit,
// meaning and a reference to its value. Reading, writing, command-line options and the reference in
// docs/config.md are all generated from the table.
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

/// Allowed interval of a number, limits included.
struct Range {
    double min = -kInfinity;
    double max = kInfinity;
    bool orZero = false;  ///< 0 is allowed as well
};

/// Name, unit and meaning of a key, as shown to users.
struct KeyWords {
    std::string name;  ///< within its section
    std::string unit;  ///< may be empty
    std::string meaning;
};

struct ConfigKey {
    std::string section = {};  ///< empty: a key at the top level of the file
    KeyWords words = {};
    std::string allowed = {};               ///< allowed values in words, may be empty
    std::vector<std::string> choices = {};  ///< the allowed values, if they are a fixed set
    bool isFile = false;  ///< the value is a path, relative to the file that contains it
    bool isText = false;  ///< set() takes a text literally, not as YAML
    std::function<void(YamlMap&)> read = {};  ///< reads the value, if the section has the key
    std::function<YAML::Node()> value = {};   ///< the present value; null: none, the key is not
                                              ///< written

    /// "section.name", or "name" at the top level.
    std::string path() const;
    /// Meaning, unit and present value without markup, for the help of a command.
    std::string description() const;
    /// Sets the value from the text of a command-line option. @throws InputError without file name
    void set(const std::string& text) const;
};

class KeyTable {
  public:
    /// Keys added from now on belong to this section; "" is the top level of the file.
    void beginSection(const std::string& name) { section_ = name; }

    // Add a key of each type. `value` must outlive the table.

    void number(const KeyWords& words, double& value, Range range);
    void number(const KeyWords& words, std::optional<double>& value, Range range);
    void flag(const KeyWords& words, bool& value);
    void text(const KeyWords& words, std::string& value);
    void file(const KeyWords& words, std::string& value);
    /// A path that must be given: read() throws if the key is missing.
    void requiredFile(const KeyWords& words, std::string& value);
    void choice(const KeyWords& words, std::string& value, const std::vector<std::string>& choices);
    /// Six variances, the diagonal of a covariance in the order (rho, phi) [m^2, rad^2].
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

    /// @param names name of each value of the enumeration, in the order of their definition
    template <typename Enum>
    requires std::is_enum_v<Enum>
    void choice(const KeyWords& words, Enum& value, const std::vector<std::string>& names) {
        addNamed(
            words, names, [&value] { return static_cast<std::size_t>(value); },
            [&value](std::size_t index) { value = static_cast<Enum>(index); });
    }

    /// A key with its own reader and writer. It is added to the current section.
    void add(ConfigKey key);

    const std::vector<ConfigKey>& keys() const { return keys_; }
    /// The key with this path (ConfigKey::path()); null if there is none.
    const ConfigKey* find(const std::string& path) const;

    /// Sets the values of all keys in the file; other values are not changed.
    /// @throws InputError naming file, key and reason, also for a key that the table does not have
    void read(YamlMap& root) const;
    void read(const std::string& file) const;

    /// All values as YAML that read() can read.
    std::string toYaml() const;

    /// A Markdown table with the columns key, default (the present value), unit, allowed values and
    /// meaning.
    /// @param names sections or key paths to list; empty: all
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

/// Numbers as a YAML list on one line, with the fewest digits that give the same numbers back.
YAML::Node yamlList(const std::vector<double>& numbers);
YAML::Node yamlList(const std::vector<std::string>& words);
/// A number with the fewest digits that give the same number back.
YAML::Node yamlNumber(double value);

/// A path that was read from a file, made absolute relative to the folder of that file. Returned
/// unchanged if it is absolute, or if `path` or `file` is empty.
std::string resolvedPath(const std::string& path, const std::string& file);

}  // namespace photonav
