// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mesh_io.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/importerdesc.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/Logger.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "io/error.hpp"
#include "io/reading.hpp"
#include "scene/mesh_check.hpp"
#include "scene/obj_text.hpp"

/// Debian's assimp is built with assertions, which end the program where a file breaks what an
/// importer takes for granted. Here they end the import: the library calls this definition in place
/// of its own.
namespace Assimp {
ASSIMP_API void aiAssertViolation(const char* expression, const char* /*file*/, int /*line*/);

void aiAssertViolation(const char* expression, const char* /*file*/, int /*line*/) {
    throw std::runtime_error(std::string("the file breaks a rule of its format: ") + expression);
}
}  // namespace Assimp

namespace photonav {
namespace {

using Rgb = std::array<double, 3>;

constexpr double kMostMeshTexels = 5e8;  // of all materials, each of which has its own

bool isGltf(const std::string& file) {
    const MeshFormat format = meshFormatOf(file);
    return format == MeshFormat::gltf || format == MeshFormat::glb;
}

std::string_view importerOf(MeshFormat format) {
    switch (format) {
        case MeshFormat::ply:
            return "Stanford Polygon Library (PLY) Importer";
        case MeshFormat::obj:
            return "Wavefront Object Importer";
        case MeshFormat::gltf:
        case MeshFormat::glb:
            break;
    }
    return "glTF2 Importer";
}

/// Maps file coordinates to the world: the file's up axis becomes z, units become metres.
Eigen::Affine3d fileToWorld(const std::string& file, const MeshOptions& options) {
    const bool yUp = options.up == UpAxis::y || (options.up == UpAxis::automatic && isGltf(file));
    Eigen::Affine3d T_w_file(Eigen::Scaling(options.scale));
    if (yUp) {
        Eigen::Matrix3d turn;  // a quarter turn about x, without rounding
        turn << 1., 0., 0., 0., 0., -1., 0., 1., 0.;
        T_w_file = T_w_file * turn;
    }
    return T_w_file;
}

Eigen::Affine3d toEigen(const aiMatrix4x4& m) {
    Eigen::Affine3d T;
    T.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1,
        m.d2, m.d3, m.d4;
    return T;
}

Rgb baseColour(const aiMaterial& material) {
    aiColor4D colour(1.F, 1.F, 1.F, 1.F);
    if (material.Get(AI_MATKEY_BASE_COLOR, colour) != aiReturn_SUCCESS) {
        material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
    }
    return {colour.r, colour.g, colour.b};
}

std::optional<std::string> baseTextureName(const aiMaterial& material) {
    aiString name;
    for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
        if (material.GetTexture(type, 0, &name) == aiReturn_SUCCESS) return name.C_Str();
    }
    return std::nullopt;
}

/// Remembers which files assimp opened: the mesh, its buffers, its materials.
class RememberingFiles : public Assimp::DefaultIOSystem {
  public:
    RememberingFiles(const std::string& mesh, std::vector<std::string>& files)
        : obj_(meshFormatOf(mesh) == MeshFormat::obj ? mesh : ""), files_(files) {}

    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (!std::filesystem::is_regular_file(file)) return nullptr;  // a pipe may never end
        Assimp::IOStream* stream = DefaultIOSystem::Open(file, mode);
        const bool isNew = std::find(files_.begin(), files_.end(), file) == files_.end();
        if (stream != nullptr && isNew) files_.emplace_back(file);
        if (stream == nullptr || obj_.empty()) return stream;
        return file == obj_ ? withoutLines(stream) : whitened(stream);
    }

  private:
    Assimp::IOStream* withoutLines(Assimp::IOStream* obj) {
        const std::size_t size = obj->FileSize();
        auto bytes = std::make_unique<std::uint8_t[]>(size);  // NOLINT(modernize-avoid-c-arrays)
        const std::size_t read = obj->Read(bytes.get(), 1, size);
        Close(obj);
        commentLines({reinterpret_cast<char*>(bytes.get()), read});
        return streamOf(bytes.release(), read);
    }

    Assimp::IOStream* whitened(Assimp::IOStream* library) {
        std::string text(library->FileSize(), '\0');
        text.resize(library->Read(text.data(), 1, text.size()));
        Close(library);
        text = withWhiteMaterials(text);
        auto bytes =
            std::make_unique<std::uint8_t[]>(text.size());  // NOLINT(modernize-avoid-c-arrays)
        std::ranges::copy(text, bytes.get());
        return streamOf(bytes.release(), text.size());
    }

    static Assimp::IOStream* streamOf(std::uint8_t* bytes, std::size_t size) {
        // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): assimp closes, and so deletes, it
        return new Assimp::MemoryIOStream(bytes, size, true);
    }

    std::string obj_;  ///< the mesh, if it is of this format
    std::vector<std::string>& files_;
};

/// Assimp with one of its importers. All fifty of them would look at the first bytes of a file, and
/// one would take it for its own whatever its name says, and whatever was checked.
class SingleImporter {
  public:
    explicit SingleImporter(std::string_view name) {
        others_.reserve(importer_.GetImporterCount());
        for (std::size_t i = importer_.GetImporterCount(); i-- > 0;) {
            const aiImporterDesc* info = importer_.GetImporterInfo(i);
            if (info != nullptr && name == info->mName) continue;
            others_.emplace_back(importer_.GetImporter(i));
            importer_.UnregisterLoader(others_.back().get());
        }
    }
    Assimp::Importer& operator*() { return importer_; }

  private:
    std::vector<std::unique_ptr<Assimp::BaseImporter>> others_;  // assimp gives them away
    Assimp::Importer importer_;
};

/// Fills a Scene from what assimp read.
class MeshReader {
  public:
    MeshReader(const std::string& file, const MeshOptions& options, const aiScene& input,
               std::vector<std::string> files)
        : T_w_file_(fileToWorld(file, options)), file_(file), input_(input) {
        scene_.files = std::move(files);
    }

    Scene read() {
        addNode(*input_.mRootNode, T_w_file_);
        if (scene_.triangles.empty()) {
            throw InputError(
                file_, "", dropped_ > 0 ? "all triangles are degenerate" : "contains no triangles");
        }
        return std::move(scene_);
    }

  private:
    void addNode(const aiNode& node, const Eigen::Affine3d& T_w_parent) {
        const Eigen::Affine3d T_w_node = T_w_parent * toEigen(node.mTransformation);
        for (unsigned i = 0; i < node.mNumMeshes; ++i) {
            addMesh(*input_.mMeshes[node.mMeshes[i]], T_w_node);
        }
        for (unsigned i = 0; i < node.mNumChildren; ++i) addNode(*node.mChildren[i], T_w_node);
    }

    void addMesh(const aiMesh& mesh, const Eigen::Affine3d& T_w_mesh) {
        if (!(mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) return;
        const Surface surface = surfaceOf(mesh);
        for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
            if (mesh.mFaces[i].mNumIndices == 3) addFace(mesh, mesh.mFaces[i], T_w_mesh, surface);
        }
    }

    struct Surface {
        std::uint32_t texture = 0;
        bool vertexColours = false;
    };

    void addFace(const aiMesh& mesh, const aiFace& face, const Eigen::Affine3d& T_w_mesh,
                 const Surface& surface) {
        Triangle triangle;
        triangle.texture = surface.texture;
        for (unsigned k = 0; k < 3; ++k) {
            const unsigned vertex = face.mIndices[k];
            if (vertex >= mesh.mNumVertices)
                throw InputError(file_, "", "a face has no such vertex");
            const aiVector3D& p = mesh.mVertices[vertex];
            triangle.corners[k] = (T_w_mesh * Eigen::Vector3d(p.x, p.y, p.z)).cast<float>();
            triangle.uv[k] = coordinates(mesh, vertex, surface);
            if (!triangle.corners[k].allFinite() || !triangle.uv[k].allFinite()) {
                throw InputError(file_, "",
                                 "vertex " + std::to_string(vertex) + " of mesh '" +
                                     mesh.mName.C_Str() + "' is not finite");
            }
        }
        const Eigen::Vector3f a = triangle.corners[1] - triangle.corners[0];
        const Eigen::Vector3f b = triangle.corners[2] - triangle.corners[0];
        const float longest = std::max(a.squaredNorm(), b.squaredNorm());
        if (a.cross(b).norm() > 1e-6F * longest) {
            scene_.triangles.push_back(triangle);
        } else {
            ++dropped_;
        }
    }

    Eigen::Vector2f coordinates(const aiMesh& mesh, unsigned vertex, const Surface& surface) const {
        if (surface.vertexColours) {
            // The ramp has texels 0 and 1 at u = 1/4 and 3/4: u is the grey value itself, and
            // interpolating u over the triangle interpolates grey.
            const aiColor4D& c = mesh.mColors[0][vertex];
            Rgb linear{c.r, c.g, c.b};
            if (!isGltf(file_)) {
                for (double& channel : linear) channel = decodeSrgb(channel);
            }
            return {0.25F + 0.5F * static_cast<float>(greyOfLinear(linear)), 0.5F};
        }
        if (!mesh.HasTextureCoords(0)) return Eigen::Vector2f::Zero();
        const aiVector3D& uv = mesh.mTextureCoords[0][vertex];
        return {uv.x, 1.F - uv.y};  // assimp counts v upward for every format
    }

    Surface surfaceOf(const aiMesh& mesh) {
        const aiMaterial& material = *input_.mMaterials[mesh.mMaterialIndex];
        const auto name = baseTextureName(material);
        if (name && mesh.HasTextureCoords(0)) {
            return {textureOfMaterial(mesh.mMaterialIndex, *name, baseColour(material)), false};
        }
        if (mesh.HasVertexColors(0)) return {rampTexture(), true};
        return {textureOfMaterial(mesh.mMaterialIndex, "", baseColour(material)), false};
    }

    std::uint32_t rampTexture() {
        if (!ramp_) {
            Texture texture{ImageF(1, 2, 0.F)};
            texture.image[0][1] = 1.F;
            ramp_ = addTexture(scene_, std::move(texture));
        }
        return *ramp_;
    }

    std::uint32_t textureOfMaterial(unsigned material, const std::string& name, const Rgb& factor) {
        const auto [entry, isNew] = textures_.try_emplace({material, name}, 0);
        if (isNew) {
            Texture texture = name.empty() ? uniformTexture(greyOfLinear(factor))
                                           : Texture{readTexture(name, factor)};
            texels_ += texture.image.getSize();
            if (texels_ > kMostMeshTexels) {
                throw InputError(
                    file_, "texture",
                    fmt::format("more than {:g} texels in all materials", kMostMeshTexels));
            }
            entry->second = addTexture(scene_, std::move(texture));
        }
        return entry->second;
    }

    ImageF readTexture(const std::string& name, const Rgb& factor) {
        if (const aiTexture* embedded = input_.GetEmbeddedTexture(name.c_str())) {
            return embeddedTexture(*embedded, name, factor);
        }
        std::string relative = name;
        std::replace(relative.begin(), relative.end(), '\\', '/');
        const auto path = std::filesystem::path(file_).parent_path() / relative;
        if (!std::filesystem::is_regular_file(path)) {
            throw InputError(file_, "texture", "no such image '" + path.string() + "'");
        }
        auto& files = scene_.files;
        if (std::find(files.begin(), files.end(), path) == files.end()) {
            files.push_back(path.string());
        }
        return readGrey(path.string(), factor);
    }

    ImageF embeddedTexture(const aiTexture& texture, const std::string& name,
                           const Rgb& factor) const {
        if (texture.mHeight == 0) {  // an image file; mWidth is its length in bytes
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(texture.pcData);
            return decodeGrey({bytes, texture.mWidth}, file_ + ": texture " + name, factor);
        }
        ImageF image(texture.mHeight, texture.mWidth);
        for (unsigned i = 0; i < image.getSize(); ++i) {
            const aiTexel& t = texture.pcData[i];
            image.bitmap[i] = static_cast<float>(greyOfLinear(
                {factor[0] * decodeSrgb(t.r / 255.), factor[1] * decodeSrgb(t.g / 255.),
                 factor[2] * decodeSrgb(t.b / 255.)}));
        }
        return image;
    }

    Eigen::Affine3d T_w_file_;
    const std::string& file_;
    const aiScene& input_;
    Scene scene_;
    std::map<std::pair<unsigned, std::string>, std::uint32_t> textures_;
    std::size_t dropped_ = 0;
    double texels_ = 0.;
    std::optional<std::uint32_t> ramp_;
};

/// Hears of triangles that assimp's reader of glTF drops, which it says in its log only. A log of
/// the program's own stays, and is told instead.
class DroppedFaces {
  public:
    DroppedFaces() : isOurs_(Assimp::DefaultLogger::isNullLogger()) {
        // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): kill() deletes it
        if (isOurs_) Assimp::DefaultLogger::set(new Log(any_));
    }
    ~DroppedFaces() {
        if (isOurs_) Assimp::DefaultLogger::kill();
    }
    DroppedFaces(const DroppedFaces&) = delete;
    DroppedFaces& operator=(const DroppedFaces&) = delete;

    bool any() const { return any_; }

  private:
    class Log : public Assimp::Logger {
      public:
        explicit Log(bool& any) : any_(any) {}
        bool attachStream(Assimp::LogStream*, unsigned) override { return false; }
        bool detachStream(Assimp::LogStream*, unsigned) override { return false; }

      protected:
        void OnDebug(const char*) override {}
        void OnVerboseDebug(const char*) override {}
        void OnInfo(const char*) override {}
        void OnError(const char*) override {}
        void OnWarn(const char* message) override {
            constexpr const char* kDropped = "out-of-range indices";
            any_ = any_ || std::string_view(message).find(kDropped) != std::string_view::npos;
        }

      private:
        bool& any_;
    };

    static inline std::mutex mutex_;  // of the logger, of which a process has one
    std::scoped_lock<std::mutex> lock_{mutex_};
    bool any_ = false;
    bool isOurs_;
};

Scene readMesh(const std::string& file, const MeshOptions& options) {
    openToRead(file);
    if (std::filesystem::file_size(file) == 0) throw InputError(file, "", "the file is empty");
    checkMeshFile(file);
    std::vector<std::string> files;  // outlives the importer, which owns the RememberingFiles
    SingleImporter single(importerOf(meshFormatOf(file)));
    Assimp::Importer& importer = *single;
    // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): the importer owns it
    importer.SetIOHandler(new RememberingFiles(file, files));
    const DroppedFaces dropped;
    const aiScene* input = importer.ReadFile(
        file, aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_SortByPType);
    if (input == nullptr || input->mRootNode == nullptr) {
        std::string reason = importer.GetErrorString();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        if (reason == std::bad_alloc().what()) throw std::bad_alloc();
        throw InputError(file, "", reason.empty() ? "cannot read the mesh" : reason);
    }
    if (dropped.any()) throw InputError(file, "", "a triangle has a vertex that is not there");
    return MeshReader(file, options, *input, files).read();
}

}  // namespace

Scene loadMesh(const std::string& file, const MeshOptions& options) {
    return reading(file, [&] { return readMesh(file, options); });
}

}  // namespace photonav
