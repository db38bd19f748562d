// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene_yaml.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "geometry/constants.hpp"
#include "io/yaml_reader.hpp"

namespace photonav {
namespace {

constexpr double kSmallest = 1e-6;  // [m]: what counts as a positive length

/// Reads one scene: textures by name first, then the surfaces that refer to them.
class SceneReader {
  public:
    SceneReader(YamlMap& root, double mostTexels) : root_(root), texelsLeft_(mostTexels) {
        scene_.files = {root.file()};
    }

    Scene read() {
        root_.read("seed", seed_);
        auto textures = root_.list("textures"), planes = root_.list("planes"),
             boxes = root_.list("boxes"), walls = root_.list("walls");
        root_.finish();  // before the surfaces: a misspelt list of textures is its own mistake
        for (YamlMap& map : textures) readTexture(map);
        for (YamlMap& map : planes) readPlane(map);
        for (YamlMap& map : boxes) readBox(map);
        for (YamlMap& map : walls) readWall(map);
        if (scene_.triangles.empty()) root_.fail("", "the scene has no surfaces");
        return std::move(scene_);
    }

  private:
    void readTexture(YamlMap& map);
    Texture readNoise(YamlMap& map);
    Texture readStripes(YamlMap& map);
    Texture readChecker(YamlMap& map);
    Texture readImage(YamlMap& map);
    Texture readPatches(YamlMap& map);
    void readPlane(YamlMap& map);
    void readBox(YamlMap& map);
    void readWall(YamlMap& map);
    std::uint32_t textureNamed(YamlMap& map, const std::string& key);
    double readTexel(YamlMap& map, const Eigen::Vector2d& size);
    void spend(const YamlMap& map, const std::string& key, const Eigen::Vector2d& size,
               double texel);

    /// Turns a complaint of a maker into one about this entry of the file.
    template <typename Make>
    static auto checked(const YamlMap& map, const std::string& key, Make make) {
        try {
            return make();
        } catch (const std::invalid_argument& error) {
            map.fail(key, error.what());
        }
    }

    YamlMap& root_;
    unsigned seed_ = 1;
    std::vector<std::string> names_;
    double texelsLeft_;
    Scene scene_;
};

void readGrey(YamlMap& map, const std::string& key, double& value) {
    map.readNumber(key, value, 0., 1.);
}

template <int N>
void requireVector(YamlMap& map, const std::string& key, Eigen::Matrix<double, N, 1>& value) {
    if (!map.has(key)) map.fail(key, "missing");
    map.readVector(key, value);
}

/// @param size of the texture that has such texels [m]
double SceneReader::readTexel(YamlMap& map, const Eigen::Vector2d& size) {
    double texel = 0.01;
    map.readNumber("texel", texel, 1e-4, kInfinity);
    spend(map, "texel", size, texel);
    return texel;
}

void SceneReader::spend(const YamlMap& map, const std::string& key, const Eigen::Vector2d& size,
                        double texel) {
    texelsLeft_ -= (size / texel).cwiseMax(1.).prod();
    if (texelsLeft_ >= 0.) return;
    map.fail(key,
             "with this the scene's textures have too many texels: make them coarser or let "
             "them repeat");
}

void SceneReader::readTexture(YamlMap& map) {
    std::string name;
    std::string type = "uniform";
    map.read("name", name);
    if (name.empty()) map.fail("name", "missing");
    if (std::find(names_.begin(), names_.end(), name) != names_.end()) {
        map.fail("name", fmt::format("'{}' is there twice", name));
    }
    map.readChoice("type", type, {"uniform", "noise", "stripes", "checker", "image", "patches"});
    Texture texture = checked(map, "type", [&] {
        if (type == "noise") return readNoise(map);
        if (type == "stripes") return readStripes(map);
        if (type == "checker") return readChecker(map);
        if (type == "image") return readImage(map);
        if (type == "patches") return readPatches(map);
        double grey = 0.5;
        readGrey(map, "grey", grey);
        return uniformTexture(grey);
    });
    map.finish();
    addTexture(scene_, std::move(texture));
    names_.push_back(name);
}

Texture SceneReader::readNoise(YamlMap& map) {
    constexpr std::size_t kMostCells = 16;
    NoiseOptions options;
    options.seed = seed_ + static_cast<unsigned>(names_.size());
    map.readVector("size", options.size);
    map.readNumbers("cells", options.cells, 1, kMostCells);
    map.readNumbers("amplitudes", options.amplitudes, 0, kMostCells);
    readGrey(map, "mean", options.mean);
    map.read("seed", options.seed);
    options.texel = readTexel(map, options.size);
    for (const double cell : options.cells) {
        if (cell > 0.) spend(map, "cells", options.size, cell);
    }
    return valueNoise(options);
}

Texture SceneReader::readStripes(YamlMap& map) {
    StripeOptions options;
    std::string direction = "u";
    map.readNumber("width", options.width, kSmallest, kInfinity);
    map.readNumber("soft_edge", options.softEdge, 0., options.width);
    map.readNumber("offset", options.offset, -kInfinity, kInfinity);
    map.readChoice("direction", direction, {"u", "v"});
    readGrey(map, "dark", options.dark);
    readGrey(map, "light", options.light);
    options.alongV = direction == "v";
    options.texel = readTexel(map, {2. * options.width, 0.});
    return stripes(options);
}

Texture SceneReader::readChecker(YamlMap& map) {
    CheckerOptions options;
    map.readNumber("cell", options.cell, kSmallest, kInfinity);
    map.readNumber("soft_edge", options.softEdge, 0., options.cell);
    readGrey(map, "dark", options.dark);
    readGrey(map, "light", options.light);
    options.texel = readTexel(map, {2. * options.cell, 2. * options.cell});
    return checker(options);
}

Texture SceneReader::readImage(YamlMap& map) {
    std::string image;
    double width = 1.;
    map.read("file", image);
    map.readNumber("width", width, kSmallest, kInfinity);
    const auto path = std::filesystem::path(root_.file()).parent_path() / image;
    if (!std::filesystem::is_regular_file(path)) {
        map.fail("file", fmt::format("no such image '{}'",
                                     std::filesystem::absolute(path).lexically_normal().string()));
    }
    scene_.files.push_back(path.string());
    Texture texture = imageTexture(path.string(), width);
    spend(map, "file", {texture.image.getWidth(), texture.image.getHeight()}, 1.);
    return texture;
}

Texture SceneReader::readPatches(YamlMap& map) {
    Eigen::Vector2d size(1., 1.);
    requireVector(map, "size", size);
    const std::uint32_t base = textureNamed(map, "base");
    std::vector<Patch> patches;
    for (YamlMap& entry : map.list("patches")) {
        Patch patch;
        patch.texture = &scene_.textures[textureNamed(entry, "texture")];
        requireVector(entry, "min", patch.min);
        requireVector(entry, "max", patch.max);
        entry.finish();
        patches.push_back(patch);
    }
    return patchedTexture(scene_.textures[base], patches, size, readTexel(map, size));
}

std::uint32_t SceneReader::textureNamed(YamlMap& map, const std::string& key) {
    std::string name;
    map.read(key, name);
    if (name.empty()) map.fail(key, "missing");
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) {
        const std::string nearest = nearestWord(name, names_);
        map.fail(key, fmt::format("no texture '{}' above{}", name,
                                  nearest.empty() ? "" : ", did you mean '" + nearest + "'?"));
    }
    return static_cast<std::uint32_t>(found - names_.begin());
}

void SceneReader::readPlane(YamlMap& map) {
    Eigen::Vector3d corner = Eigen::Vector3d::Zero();
    Eigen::Vector3d u = Eigen::Vector3d::UnitX();
    Eigen::Vector3d v = Eigen::Vector3d::UnitY();
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();
    requireVector(map, "corner", corner);
    requireVector(map, "u", u);
    requireVector(map, "v", v);
    map.readVector("offset", offset);
    const std::uint32_t texture = textureNamed(map, "texture");
    map.finish();
    checked(map, "u", [&] { addPlane(scene_, corner, u, v, texture, offset); });
}

void SceneReader::readBox(YamlMap& map) {
    Eigen::Vector3d min = Eigen::Vector3d::Zero();
    Eigen::Vector3d max = Eigen::Vector3d::Ones();
    requireVector(map, "min", min);
    requireVector(map, "max", max);
    bool hollow = false;
    map.read("hollow", hollow);
    const std::uint32_t texture = textureNamed(map, "texture");
    map.finish();
    checked(map, "max", [&] {
        addBox(scene_, min, max, texture, hollow ? BoxInside::hollow : BoxInside::solid);
    });
}

void SceneReader::readWall(YamlMap& map) {
    Wall wall;
    std::vector<std::vector<double>> footprint;
    map.read("footprint", footprint);
    for (const auto& point : footprint) {
        if (point.size() != 2 || !std::isfinite(point[0]) || !std::isfinite(point[1])) {
            map.fail("footprint", "expected a list of [x, y]");
        }
        wall.footprint.emplace_back(point[0], point[1]);
    }
    map.readNumber("height", wall.height, kSmallest, kInfinity);
    map.readNumber("thickness", wall.thickness, kSmallest, kInfinity);
    map.readNumber("bottom", wall.bottom, -kInfinity, kInfinity);
    map.read("closed", wall.closed);
    const std::uint32_t texture = textureNamed(map, "texture");
    map.finish();
    checked(map, "footprint", [&] { addWall(scene_, wall, texture); });
}

}  // namespace

Scene loadSceneYaml(const std::string& file, double mostTexels) {
    YamlMap root(file, loadYaml(file));
    return readScene(root, mostTexels);
}

Scene readScene(YamlMap& map, double mostTexels) { return SceneReader(map, mostTexels).read(); }

}  // namespace photonav
