// SPDX-License-Identifier: BSD-3-Clause
// Maps: .ot of our own class, of ColorOcTree and OcTree, and .bt; what was read can be written, and
// read again with as many nodes.
#include "fuzz_input.hpp"
#include "map/octree_file.hpp"
#include "shapes/surroundings.hpp"

void photonav::fuzz::run(std::string_view input) {
    check([&] {
        const auto map = loadTexturedOcTree(write("map.ot", input));
        require(drawnVoxels(*map, 1000).grey.size() <= 1000, "voxels are few");
        const std::string copy = (folder() / "copy.ot").string();
        saveTexturedOcTree(*map, copy);
        require(loadTexturedOcTree(copy)->size() == map->size(), "a written map is read again");
    });
}
