// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mesh_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "io/error.hpp"
#include "io/image_bytes.hpp"
#include "io/json_nesting.hpp"
#include "io/reading.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr std::size_t kMostGltfDepth = 200;
constexpr unsigned kMostNodeDepth = 500;  // of a node in a scene; real scenes have tens

std::size_t binarySize(const std::string& type) {
    if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
    if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
    if (type == "double" || type == "float64") return 8;
    const bool isKnown = type == "int" || type == "uint" || type == "float" || type == "int32" ||
                         type == "uint32" || type == "float32";
    return isKnown ? 4 : 0;
}

/// What a PLY header says, line by line.
class PlyHeader {
  public:
    explicit PlyHeader(const std::string& file)
        : file_(file), size_(static_cast<double>(fs::file_size(file))) {}

    void check() {
        std::ifstream in = openToRead(file_);
        std::string line;
        std::getline(in, line);
        if (line.substr(0, 3) != "ply") throw InputError(file_, "", "does not begin with 'ply'");
        while (std::getline(in, line)) {
            std::istringstream words = wordsOf(line);
            std::string word;
            words >> word;
            if (word == "format") {
                readFormat(words);
            } else if (word == "element") {
                readElement(words);
            } else if (word == "property") {
                readProperty(words);
            } else if (word == "end_header") {
                return readEnd();
            } else if (!word.empty() && word != "comment" && word != "obj_info") {
                throw InputError(file_, "", fmt::format("'{}' in the header is not known", word));
            }
        }
        throw InputError(file_, "end_header", "missing");
    }

  private:
    void readFormat(std::istream& words) {
        words >> format_;
        if (format_ == "ascii" || format_ == "binary_little_endian" ||
            format_ == "binary_big_endian") {
            return;
        }
        throw InputError(file_, "format", fmt::format("'{}' is not known", format_));
    }

    void readElement(std::istream& words) {
        checkProperties();
        words >> element_;
        if (words >> count_ && count_ >= 0. && count_ == std::floor(count_)) return;
        throw InputError(file_, "element " + element_, "not a number of elements");
    }

    /// The least that elements take: in text a digit and a blank each, of lists their length only.
    void readProperty(std::istream& words) {
        std::string type;
        words >> type;
        hasProperties_ = true;
        if (type == "list") words >> type;
        if (binarySize(type) == 0) {
            throw InputError(file_, "element " + element_,
                             fmt::format("property of unknown type '{}'", type));
        }
        least_ += count_ * (format_ == "ascii" ? 2. : static_cast<double>(binarySize(type)));
        if (least_ <= size_ + 2.) return;
        throw InputError(file_, "element " + element_,
                         fmt::format("{:.0f} of them do not fit into {:.0f} bytes", count_, size_));
    }

    /// Elements without properties take no bytes, so that any number of them would fit.
    void checkProperties() {
        if (count_ > 0. && !hasProperties_) {
            throw InputError(file_, "element " + element_, "has no properties");
        }
        hasProperties_ = false;
    }

    void readEnd() {
        checkProperties();
        if (format_.empty()) throw InputError(file_, "format", "missing");
    }

    std::string file_;
    double size_;  // [bytes]
    double least_ = 0., count_ = 0.;
    bool hasProperties_ = false;  // the present element
    std::string format_, element_;
};

void checkObj(const std::string& file) {
    std::ifstream in = openToRead(file);
    std::string line;
    while (std::getline(in, line)) {
        if (!line.starts_with("mtllib ")) continue;
        std::string name = line.substr(7);
        name.erase(0, name.find_first_not_of(" \t"));
        name.erase(name.find_last_not_of(" \t\r") + 1);
        std::replace(name.begin(), name.end(), '\\', '/');
        if (!fs::is_regular_file(fs::path(file).parent_path() / name)) {
            throw InputError(file, "mtllib", fmt::format("no such file '{}'", name));
        }
    }
}

/// The JSON of a .gltf, or of the first chunk of a .glb.
std::string gltfJson(const std::string& file, bool isBinary) {
    const std::vector<std::uint8_t> bytes = readBytes(file);
    if (!isBinary) return {bytes.begin(), bytes.end()};
    constexpr std::size_t kHeader = 20;  // magic, version, length; length and type of the chunk
    if (bytes.size() < kHeader) throw InputError(file, "", "too short for a header");
    std::uint32_t length = 0;
    std::memcpy(&length, &bytes[12], sizeof(length));
    if (length > bytes.size() - kHeader) throw InputError(file, "", "is cut short");
    return {bytes.begin() + kHeader, bytes.begin() + kHeader + length};
}

/// Finds the first key that is twice in an object, as the text goes by.
class RepeatedKey : public nlohmann::json_sax<json> {
  public:
    const std::optional<std::string>& found() const { return found_; }

    bool start_object(std::size_t /*elements*/) override {
        keys_.emplace_back();
        return true;
    }
    bool end_object() override {
        keys_.pop_back();
        return true;
    }
    bool key(string_t& name) override {
        if (keys_.back().insert(name).second) return true;
        found_ = name;
        return false;
    }
    bool null() override { return true; }
    bool boolean(bool /*value*/) override { return true; }
    bool number_integer(number_integer_t /*value*/) override { return true; }
    bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
    bool string(string_t& /*value*/) override { return true; }
    bool binary(binary_t& /*value*/) override { return true; }
    bool start_array(std::size_t /*elements*/) override { return true; }
    bool end_array() override { return true; }
    bool parse_error(std::size_t /*place*/, const std::string& /*token*/,
                     const nlohmann::detail::exception& /*error*/) override {
        return false;
    }

  private:
    std::vector<std::set<std::string>> keys_;  // of the objects around the present value
    std::optional<std::string> found_;
};

/// Nothing may be read here in another way than by assimp's own parser, which takes text that is no
/// UTF-8, and of two equal keys the first one.
json parseStrictly(const std::string& file, const std::string& text) {
    if (nestingDepth(text) > kMostGltfDepth) {
        throw InputError(file, "", fmt::format("JSON nested deeper than {}", kMostGltfDepth));
    }
    RepeatedKey repeated;
    if (!json::sax_parse(text, &repeated)) {
        if (!repeated.found()) throw InputError(file, "", "is not JSON");
        throw InputError(file, *repeated.found(), "is there twice in the same JSON object");
    }
    return json::parse(text);
}

constexpr std::size_t kNoNode = std::numeric_limits<std::size_t>::max();

/// Puts the nodes of a list of indices under a parent. As glTF demands, a node is listed once:
/// assimp would copy a node as often as it is listed.
void listNodes(const std::string& file, const std::string& key, const json& indices,
               std::size_t own, std::vector<std::size_t>& parents) {
    std::set<std::size_t> listed;
    for (const auto& entry : indices) {
        if (!entry.is_number_unsigned() || entry.get<std::size_t>() >= parents.size()) {
            throw InputError(file, key, "no such node");
        }
        const auto child = entry.get<std::size_t>();
        if (!listed.insert(child).second || parents[child] != kNoNode) {
            throw InputError(file, key, fmt::format("node {} is listed twice", child));
        }
        if (own != kNoNode) parents[child] = own;
    }
}

/// Assimp follows nodes by recursion, whatever their depth, and in circles.
void checkNodes(const std::string& file, const json& root) {
    if (!root.contains("nodes")) return;
    const json& nodes = root["nodes"];
    if (!nodes.is_array()) throw InputError(file, "nodes", "expected a list");
    std::vector<std::size_t> parents(nodes.size(), kNoNode);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].is_object() || !nodes[i].contains("children")) continue;
        listNodes(file, fmt::format("nodes[{}].children", i), nodes[i]["children"], i, parents);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        unsigned depth = 1;
        for (std::size_t above = parents[i]; above != kNoNode; above = parents[above]) {
            if (++depth <= kMostNodeDepth) continue;
            throw InputError(file, "nodes",
                             fmt::format("nested deeper than {}, or in a circle", kMostNodeDepth));
        }
    }
    if (!root.contains("scenes") || !root["scenes"].is_array()) return;
    for (const json& scene : root["scenes"]) {
        if (!scene.is_object() || !scene.contains("nodes")) continue;
        listNodes(file, "scenes", scene["nodes"], kNoNode, parents);
    }
}

/// A pipe would never end.
void checkUris(const std::string& file, const json& root) {
    for (const char* list : {"buffers", "images"}) {
        if (!root.contains(list) || !root[list].is_array()) continue;
        for (const json& entry : root[list]) {
            if (!entry.is_object() || !entry.contains("uri") || !entry["uri"].is_string()) continue;
            const auto& uri = entry["uri"].get_ref<const std::string&>();
            if (uri.starts_with("data:")) continue;
            const fs::path named = fs::path(file).parent_path() / uri;
            std::error_code error;
            const fs::file_status status = fs::status(named, error);
            if (fs::exists(status) && !fs::is_regular_file(status)) {
                throw InputError(file, list, fmt::format("'{}' is no file", uri));
            }
        }
    }
}

void checkGltf(const std::string& file, bool isBinary) {
    const json root = parseStrictly(file, gltfJson(file, isBinary));
    const json::json_pointer place("/asset/version");
    const json version = root.contains(place) ? root[place] : json();
    if (!version.is_string() || !version.get_ref<const std::string&>().starts_with("2.")) {
        throw InputError(file, "asset.version", fmt::format("{} is not \"2.0\"", version.dump()));
    }
    checkNodes(file, root);
    checkUris(file, root);
}

}  // namespace

MeshFormat meshFormatOf(const std::string& file) {
    std::string extension = fs::path(file).extension().string();
    for (char& c : extension) {
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    if (extension == ".ply") return MeshFormat::ply;
    if (extension == ".obj") return MeshFormat::obj;
    if (extension == ".gltf") return MeshFormat::gltf;
    if (extension == ".glb") return MeshFormat::glb;
    throw InputError(
        file, "",
        fmt::format("'{}' is no mesh that can be read; known: .gltf, .glb, .obj, .ply", extension));
}

void checkMeshFile(const std::string& file) {
    switch (const MeshFormat format = meshFormatOf(file)) {
        case MeshFormat::ply:
            return PlyHeader(file).check();
        case MeshFormat::obj:
            return checkObj(file);
        case MeshFormat::gltf:
        case MeshFormat::glb:
            return checkGltf(file, format == MeshFormat::glb);
    }
}

}  // namespace photonav
