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
#include "scene/ply_check.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr std::size_t kMostGltfDepth = 200;
constexpr unsigned kMostNodeDepth = 500;     // of a node in a scene; real scenes have tens
constexpr std::size_t kMostParts = 100'000;  // nodes, materials, primitives: assimp copies each
constexpr double kMostCorners = 3e7;         // of triangles, in all instances of all meshes

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

/// An entry of a list at the top; null where there is none.
const json& entryOf(const json& root, const char* list, const json& index) {
    static const json none;
    if (!root.contains(list) || !root[list].is_array() || !index.is_number_unsigned()) return none;
    const auto i = index.get<std::size_t>();
    return i < root[list].size() ? root[list][i] : none;
}

/// A member of an object; null where there is none.
const json& memberOf(const json& object, const char* name) {
    static const json none;
    return object.is_object() && object.contains(name) ? object[name] : none;
}

/// Limits the size of the scene that a small file can describe: meshes of many parts, many of them
/// from the same numbers, and nodes that show the same mesh again and again.
class GltfAmount {
  public:
    GltfAmount(const std::string& file, const json& root) : file_(file), root_(root) {}

    void check() {
        for (const char* list : {"nodes", "materials"}) {
            if (memberOf(root_, list).size() > kMostParts) refuseParts(list);
        }
        for (const json& accessor : memberOf(root_, "accessors")) checkCorners(numberOf(accessor));
        std::vector<double> corners;
        for (const json& mesh : memberOf(root_, "meshes")) {
            corners.push_back(cornersOf(mesh));
            checkCorners(corners_ += corners.back());
        }
        for (const json& node : memberOf(root_, "nodes")) {
            const json& mesh = memberOf(node, "mesh");
            if (!mesh.is_number_unsigned() || mesh.get<std::size_t>() >= corners.size()) continue;
            checkCorners(corners_ += corners[mesh.get<std::size_t>()]);
        }
    }

  private:
    static double numberOf(const json& accessor) {
        const json& count = memberOf(accessor, "count");
        return count.is_number() ? count.get<double>() : 0.;
    }

    double cornersOf(const json& mesh) {
        double corners = 0.;
        for (const json& primitive : memberOf(mesh, "primitives")) {
            if (++primitives_ > kMostParts) refuseParts("primitives");
            const json& position = memberOf(memberOf(primitive, "attributes"), "POSITION");
            const json& indices = memberOf(primitive, "indices");
            corners +=
                numberOf(entryOf(root_, "accessors", indices.is_null() ? position : indices));
        }
        return corners;
    }

    void checkCorners(double corners) const {
        if (corners <= kMostCorners) return;
        throw InputError(
            file_, "meshes",
            fmt::format("more than {:g} corners of triangles in all instances", kMostCorners));
    }

    [[noreturn]] void refuseParts(const char* list) const {
        throw InputError(file_, list, fmt::format("more than {}", kMostParts));
    }

    const std::string& file_;
    const json& root_;
    std::size_t primitives_ = 0;
    double corners_ = 0.;
};

/// What a reader must know to read the file at all; assimp reads it all the same.
void checkExtensions(const std::string& file, const json& root) {
    for (const json& name : memberOf(root, "extensionsRequired")) {
        const std::string known = name.is_string() ? name.get<std::string>() : "";
        if (known.starts_with("KHR_materials_") || known == "KHR_lights_punctual") continue;
        throw InputError(file, "extensionsRequired", name.dump() + " is not known");
    }
}

/// A rotation of length 0 turns nothing; the mesh would be a point.
void checkRotations(const std::string& file, const json& root) {
    for (const json& node : memberOf(root, "nodes")) {
        const json& rotation = memberOf(node, "rotation");
        if (rotation.is_null()) continue;
        double square = 0.;
        for (const json& number : rotation) {
            if (number.is_number()) square += std::pow(number.get<double>(), 2);
        }
        if (rotation.size() == 4 && std::abs(square - 1.) <= 0.1) continue;
        throw InputError(file, "nodes",
                         fmt::format("rotation {} is no unit quaternion", rotation.dump()));
    }
}

/// Assimp computes with these as they are.
void checkLayout(const std::string& file, const json& root) {
    constexpr double kMostStride = 252.;  // glTF 2.0, 5.11
    constexpr double kMostBytes = 4e9;
    for (const char* list : {"bufferViews", "accessors"}) {
        for (const json& entry : memberOf(root, list)) {
            for (const char* name : {"byteOffset", "byteLength", "byteStride", "count"}) {
                const json& value = memberOf(entry, name);
                const double most = name == std::string("byteStride") ? kMostStride : kMostBytes;
                if (value.is_null()) continue;
                if (value.is_number_unsigned() && value.get<double>() <= most) continue;
                throw InputError(file, list,
                                 fmt::format("{} {} is no whole number from 0 to {:g}", name,
                                             value.dump(), most));
            }
        }
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
    checkExtensions(file, root);
    checkRotations(file, root);
    checkLayout(file, root);
    GltfAmount(file, root).check();
    checkUris(file, root);
}

/// As the name of a file says.
std::optional<MeshFormat> formatIn(const std::string& file) {
    std::string extension = fs::path(file).extension().string();
    for (char& c : extension) {
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    if (extension == ".ply") return MeshFormat::ply;
    if (extension == ".obj") return MeshFormat::obj;
    if (extension == ".gltf") return MeshFormat::gltf;
    if (extension == ".glb") return MeshFormat::glb;
    return {};
}

}  // namespace

bool isMeshFile(const std::string& file) { return formatIn(file).has_value(); }

MeshFormat meshFormatOf(const std::string& file) {
    if (const auto format = formatIn(file)) return *format;
    throw InputError(file, "",
                     fmt::format("'{}' is no mesh that can be read; known: .gltf, .glb, .obj, .ply",
                                 fs::path(file).extension().string()));
}

void checkMeshFile(const std::string& file) {
    switch (const MeshFormat format = meshFormatOf(file)) {
        case MeshFormat::ply:
            return checkPly(file);
        case MeshFormat::obj:
            return checkObj(file);
        case MeshFormat::gltf:
        case MeshFormat::glb:
            return checkGltf(file, format == MeshFormat::glb);
    }
}

}  // namespace photonav
