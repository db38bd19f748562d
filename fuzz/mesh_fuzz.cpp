// SPDX-License-Identifier: BSD-3-Clause
// Meshes by their extension: PLY, OBJ, glTF as text and binary.
#include "finite_scene.hpp"
#include "scene/mesh_io.hpp"

void photonav::fuzz::run(std::string_view input) {
    const std::array<const char*, 4> names{"mesh.ply", "mesh.obj", "mesh.gltf", "mesh.glb"};
    const char* name = names[takeChoice(input, names.size())];
    check([&] { requireFinite(loadMesh(write(name, input))); });
}
