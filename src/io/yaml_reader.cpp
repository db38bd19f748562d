// SPDX-License-Identifier: BSD-3-Clause
#include "io/yaml_reader.hpp"

#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <sstream>

#include "io/number.hpp"
#include "io/reading.hpp"

namespace photonav {
namespace {

std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
        }
    }
    return row.back();
}

/// Where the documents of a YAML text start; what they hold is passed over.
struct DocumentStarts final : YAML::EventHandler {
    std::vector<YAML::Mark> marks;

    void OnDocumentStart(const YAML::Mark& mark) override { marks.push_back(mark); }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
    void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
    void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  const std::string& /*value*/) override {}
    void OnSequenceStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/,
                         YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {}
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/,
                    YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {}
    void OnMapEnd() override {}
};

/// Refuses a second document. yaml-cpp finds one document after another, without end, where a text
/// goes on with what cannot start a value, such as a comma: so at most two are asked for.
void requireOneDocument(const std::string& file, const std::string& text) {
    DocumentStarts starts;
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (starts.marks.size() < 2 && parser.HandleNextDocument(starts)) {
    }
    if (starts.marks.size() < 2) return;
    const YAML::Mark &first = starts.marks[0], &second = starts.marks[1];
    if (first.pos == second.pos) {
        throw InputError(file, fmt::format("line {}", first.line + 1), "is not YAML");
    }
    throw InputError(file, "", "holds several documents ('---'); only one is read");
}

}  // namespace

std::vector<std::string> pathsOf(const std::string& key, const std::vector<std::string>& paths) {
    std::vector<std::string> found;
    for (const std::string& path : paths) {
        if (path == key || path.ends_with("." + key)) found.push_back(path);
    }
    return found;
}

std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates) {
    std::string best;
    std::size_t bestDistance = std::max<std::size_t>(word.size() / 2, 2) + 1;
    for (const auto& candidate : candidates) {
        const std::size_t distance = editDistance(word, candidate);
        if (distance < bestDistance) {
            bestDistance = distance;
            best = candidate;
        }
    }
    return best;
}

YAML::Node loadYaml(const std::string& file) {
    std::ifstream stream = openToRead(file);
    return parseYaml({std::istreambuf_iterator<char>(stream), {}}, file);
}

YAML::Node parseYaml(const std::string& text, const std::string& name) {
    if (text.find('\0') != std::string::npos) {
        throw InputError(name, "", "is no text in UTF-8: it has zero bytes");
    }
    try {
        requireOneDocument(name, text);
        return YAML::Load(text);
    } catch (const YAML::DeepRecursion& error) {
        throw InputError(name, fmt::format("line {}", error.mark.line + 1), "is nested too deeply");
    } catch (const YAML::ParserException& error) {
        throw InputError(name, fmt::format("line {}", error.mark.line + 1), error.msg);
    } catch (const YAML::Exception& error) {
        throw InputError(name, "", error.msg);
    }
}

void setFrom(const YAML::Node& node, double& value) {
    if (!node.IsScalar()) throw YAML::TypedBadConversion<double>(node.Mark());
    std::string text = node.Scalar();
    for (const char* word : {".nan", ".inf", "-.inf"}) {
        if (text == word) std::erase(text, '.');
    }
    const std::optional<double> number = numberIn(text);
    if (!number) throw YAML::TypedBadConversion<double>(node.Mark());
    value = *number;
}

YamlMap::YamlMap(std::string file, const YAML::Node& node, std::string prefix)
    : file_(std::move(file)), node_(node), prefix_(std::move(prefix)) {
    if (node_.IsNull()) node_ = YAML::Node(YAML::NodeType::Map);
    if (!node_.IsMap()) throw InputError(file_, prefix_, "expected 'key: value' lines");
    std::set<std::string> keys;
    for (const auto& entry : node_) {
        if (!entry.first.IsScalar()) throw InputError(file_, prefix_, "a key is not a word");
        const auto& key = entry.first.Scalar();
        if (!keys.insert(key).second) fail(key, "is there twice");
        const bool isText = entry.second.IsScalar();
        if (isText && entry.second.Scalar().find('\0') != std::string::npos) {
            fail(key, "holds a zero byte");
        }
    }
}

void YamlMap::readNumbers(const std::string& key, std::vector<double>& value, std::size_t least,
                          std::size_t most) {
    read(key, value);
    if (value.size() < least || value.size() > most) {
        const auto count =
            least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
        fail(key, fmt::format("expected {} numbers, found {}", count, value.size()));
    }
    for (const double number : value) {
        if (!std::isfinite(number)) fail(key, "not a finite number");
    }
}

std::string numberText(double value) {
    const std::string text = fmt::format("{:g}", value);
    return numberIn(text) == value ? text : fmt::format("{}", value);
}

void YamlMap::readNumber(const std::string& key, double& value, double least, double most) {
    read(key, value);
    if (!(value >= least && value <= most)) {
        fail(key, fmt::format("{} is outside [{:g}, {:g}]", value, least, most));
    }
    if (!std::isfinite(value)) fail(key, "not a finite number");
}

void YamlMap::readChoice(const std::string& key, std::string& value,
                         const std::vector<std::string>& choices) {
    read(key, value);
    if (std::find(choices.begin(), choices.end(), value) != choices.end()) return;
    fail(key, fmt::format("'{}' is not one of {}", value, fmt::join(choices, ", ")));
}

YamlMap YamlMap::map(const std::string& key) {
    known_.insert(key);
    const YAML::Node child = has(key) ? node_[key] : YAML::Node(YAML::NodeType::Map);
    return {file_, child, pathOf(key)};
}

std::vector<YamlMap> YamlMap::list(const std::string& key) {
    known_.insert(key);
    std::vector<YamlMap> maps;
    if (!has(key)) return maps;
    if (!node_[key].IsSequence()) fail(key, "expected a list");
    for (std::size_t i = 0; i < node_[key].size(); ++i) {
        maps.emplace_back(file_, node_[key][i], fmt::format("{}[{}]", pathOf(key), i));
    }
    return maps;
}

std::string YamlMap::pathOf(const std::string& key) const {
    return prefix_.empty() || key.empty() ? prefix_ + key : prefix_ + "." + key;
}

std::vector<std::string> YamlMap::similarPaths(const std::string& key,
                                               const std::vector<std::string>& elsewhere) const {
    const std::vector<std::string> same = pathsOf(key, elsewhere);
    if (!same.empty()) return same;
    std::vector<std::string> names(known_.begin(), known_.end());  // first: they win a draw
    for (const std::string& path : elsewhere) names.push_back(path.substr(path.rfind('.') + 1));
    const std::string nearest = nearestWord(key, names);
    if (known_.contains(nearest)) return {pathOf(nearest)};
    return pathsOf(nearest, elsewhere);
}

void YamlMap::finish(const std::vector<std::string>& elsewhere) const {
    for (const auto& entry : node_) {
        const auto key = entry.first.as<std::string>();
        if (known_.contains(key)) continue;
        const std::vector<std::string> paths = similarPaths(key, elsewhere);
        fail(key, paths.empty()
                      ? fmt::format("unknown key; known: {}", fmt::join(known_, ", "))
                      : fmt::format("unknown key, did you mean '{}'?", fmt::join(paths, "' or '")));
    }
}

void YamlMap::fail(const std::string& key, const std::string& reason) const {
    constexpr std::size_t kLongest = 1000;  // of a value of megabytes, say
    const auto cut = [](const std::string& text) {
        return text.size() > kLongest ? text.substr(0, kLongest) + " ..." : text;
    };
    throw InputError(file_, cut(pathOf(key)), cut(reason));
}

}  // namespace photonav
