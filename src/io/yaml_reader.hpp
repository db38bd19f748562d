// SPDX-License-Identifier: BSD-3-Clause
// Strict reading of YAML mappings: every key must be known, every value must parse, and every
// error is an InputError that names file, key and reason. The only includer of yaml-cpp in src.
#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Dense>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "io/error.hpp"

namespace photonav {

/// The candidate closest to `word` by edit distance, or "" when none is near.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates);

/// Those of the dotted paths whose last component is a key.
std::vector<std::string> pathsOf(const std::string& key, const std::vector<std::string>& paths);

/// The shortest text of a number: "1e+12", not twelve zeros.
std::string numberText(double value);

/// Loads a YAML file. @throws InputError when it is missing or does not parse.
YAML::Node loadYaml(const std::string& file);

/// As loadYaml(), for a text. @param name file name that stands for the text in messages
YAML::Node parseYaml(const std::string& text, const std::string& name);

/// Sets a value from a node as yaml-cpp does. Numbers are read with a decimal point in every
/// locale, which yaml-cpp does not do. @throws YAML::Exception
template <typename T>
void setFrom(const YAML::Node& node, T& value) {
    value = node.as<T>();
}
void setFrom(const YAML::Node& node, double& value);
template <typename T>
void setFrom(const YAML::Node& node, std::vector<T>& values) {
    if (!node.IsSequence()) throw YAML::TypedBadConversion<std::vector<T>>(node.Mark());
    values.assign(node.size(), T());
    for (std::size_t i = 0; i < values.size(); ++i) {
        // For yaml-cpp an empty place is the word "null".
        if (node[i].IsNull()) throw YAML::TypedBadConversion<T>(node[i].Mark());
        setFrom(node[i], values[i]);
    }
}

/// One YAML mapping being read. read() the keys you know, then finish().
class YamlMap {
  public:
    /// @param prefix dotted path of this mapping inside the file, for messages
    /// @throws InputError when the node is no mapping, and for a key that is given twice
    YamlMap(std::string file, const YAML::Node& node, std::string prefix = "");

    bool has(const std::string& key) const { return node_[key].IsDefined(); }

    /// Overwrites `value` if the key is present; otherwise keeps it as the default.
    template <typename T>
    void read(const std::string& key, T& value) {
        known_.insert(key);
        if (!has(key)) return;
        if (node_[key].IsNull()) fail(key, "has no value");  // for yaml-cpp the word "null"
        try {
            setFrom(node_[key], value);
        } catch (const YAML::Exception&) {
            fail(key, "cannot read the value '" + YAML::Dump(node_[key]) + "'");
        }
    }

    /// Reads a list of finite numbers; its length must be within [least, most].
    void readNumbers(const std::string& key, std::vector<double>& value, std::size_t least,
                     std::size_t most);

    /// Reads exactly N finite numbers into a vector.
    template <int N>
    void readVector(const std::string& key, Eigen::Matrix<double, N, 1>& value) {
        std::vector<double> numbers(value.data(), value.data() + N);
        readNumbers(key, numbers, N, N);
        value = Eigen::Map<const Eigen::Matrix<double, N, 1>>(numbers.data());
    }

    /// Reads a number and demands that it is finite and within [least, most].
    void readNumber(const std::string& key, double& value, double least, double most);

    /// Reads a word and demands that it is one of `choices`.
    void readChoice(const std::string& key, std::string& value,
                    const std::vector<std::string>& choices);

    /// The mapping below `key`; empty when the key is absent.
    YamlMap map(const std::string& key);

    /// The mappings of the sequence below `key`; empty when the key is absent.
    std::vector<YamlMap> list(const std::string& key);

    /// @param elsewhere dotted paths of keys of other mappings of the file
    /// @throws InputError for the first key that was not read. The message suggests the paths of
    ///         keys in `elsewhere` with the same name, or else of keys with the most similar name
    void finish(const std::vector<std::string>& elsewhere = {}) const;

    /// @throws InputError naming this file and the dotted key
    [[noreturn]] void fail(const std::string& key, const std::string& reason) const;

    const std::string& file() const { return file_; }

  private:
    /// Dotted path of a key of this mapping inside the file.
    std::string pathOf(const std::string& key) const;
    /// Paths of keys, here or elsewhere, that may be meant by an unknown one.
    std::vector<std::string> similarPaths(const std::string& key,
                                          const std::vector<std::string>& elsewhere) const;

    std::string file_;
    YAML::Node node_;
    std::string prefix_;
    std::set<std::string> known_;
};

}  // namespace photonav
