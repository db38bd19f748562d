// SPDX-License-Identifier: BSD-3-Clause
#include "map/octree_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "io/number.hpp"
#include "io/reading.hpp"

namespace photonav {
namespace {

using Node = TexturedOcTreeNode;

const std::string kOtLine = "# Octomap OcTree file";
const std::string kBtLine = "# Octomap OcTree binary file";

// Version 2 has the surfaces inside cells. A comment, since OctoMap knows no such key.
constexpr int kVersion = 2;
const std::string kVersionLine = "# photonav map, version ";

// ---- Reading -------------------------------------------------------------------------------

struct Header {
    bool binary = false;
    std::string id;
    std::size_t nodes = 0;
    double resolution = 0.;
    int version = 1;
};

/// The number that makes up the rest of a header's line.
template <typename Number>
Number headerNumber(std::istream& rest, const std::string& file, const std::string& key) {
    std::string text;
    std::getline(rest >> std::ws, text);
    if (const auto number = numberIn<Number>(text)) return *number;
    throw InputError(file, key, "'" + text + "' is not a " + (key == "size" ? "count" : "number"));
}

Header readHeader(std::istream& stream, const std::string& file) {
    Header header;
    std::string line;
    std::getline(stream, line);
    header.binary = line.starts_with(kBtLine);
    if (!header.binary && !line.starts_with(kOtLine)) {
        throw InputError(file, "", "not an OctoMap file (.ot or .bt)");
    }
    while (std::getline(stream, line) && line != "data") {
        if (line.starts_with(kVersionLine)) {
            header.version = numberIn<int>(line.substr(kVersionLine.size())).value_or(0);
            continue;
        }
        std::istringstream words = wordsOf(line);
        std::string key;
        words >> key;
        if (key == "id") words >> header.id;
        if (key == "size") header.nodes = headerNumber<std::size_t>(words, file, key);
        if (key == "res") header.resolution = headerNumber<double>(words, file, key);
    }
    if (!stream) throw InputError(file, "", "cut short inside its header");
    if (header.resolution == 0.) throw InputError(file, "res", "missing, or zero");
    if (!(header.resolution >= kFinestCell && header.resolution <= kCoarsestCell)) {
        throw InputError(file, "res",
                         fmt::format("{} m is not the size of a cell: {} to {} m",
                                     header.resolution, kFinestCell, kCoarsestCell));
    }
    if (header.version < 1 || header.version > kVersion) {
        throw InputError(file, "version",
                         "unknown; this program reads versions 1 to " + std::to_string(kVersion));
    }
    return header;
}

/// Reads nodes into an empty map. OctoMap's own reader continues with undefined values when the
/// data ends early; here every read is checked.
class NodeReader {
  public:
    /// @param promised number of nodes
    NodeReader(std::istream& stream, const std::string& file, std::size_t promised,
               TexturedOcTree& map)
        : stream_(stream), file_(file), promised_(promised), map_(map) {}

    /// Nodes of an .ot: a payload that depends on the class, then a bit for every child.
    template <class ReadPayload>
    void readNodes(Node& node, unsigned depth, const ReadPayload& readPayload) {
        readPayload(*this, node);
        if (!std::isfinite(node.getLogOdds())) fail("an occupancy is not finite");
        const auto children = read<std::uint8_t>();
        for (unsigned i = 0; i < 8; ++i) {
            if ((children >> i & 1U) == 0) continue;
            checkNext(depth);
            readNodes(*map_.createNodeChild(&node, i), depth + 1, readPayload);
        }
    }

    /// Nodes of a .bt: two bits for every child (01 free, 10 occupied, 11 has children itself).
    void readBinaryNodes(Node& node, unsigned depth) {
        const auto children = read<std::uint16_t>();
        for (unsigned i = 0; i < 8; ++i) {
            const unsigned kind = children >> 2 * i & 3U;
            if (kind == 0) continue;
            checkNext(depth);
            Node& child = *map_.createNodeChild(&node, i);
            child.setLogOdds(kind == 1 ? map_.getClampingThresMinLog()
                                       : map_.getClampingThresMaxLog());
        }
        for (unsigned i = 0; i < 8; ++i) {
            if ((children >> 2 * i & 3U) == 3) {
                readBinaryNodes(*map_.getNodeChild(&node, i), depth + 1);
            }
        }
        if (children != 0) node.updateOccupancyChildren();
    }

    template <class T>
    T read() {
        T value{};
        stream_.read(reinterpret_cast<char*>(&value), sizeof(value));
        if (!stream_) fail("cut short");
        return value;
    }

    void checkEnd() const {
        if (map_.size() != promised_) {
            failCount(fmt::format("damaged: its number of nodes is {}", map_.size()));
        }
        if (stream_.peek() != std::istream::traits_type::eof()) {
            fail("damaged: goes on after its last node");
        }
    }

    [[noreturn]] void fail(const std::string& reason) const {
        throw InputError(file_, "", reason + " (after " + std::to_string(map_.size()) + " nodes)");
    }

  private:
    /// Before a child is made of a node at this depth.
    void checkNext(unsigned depth) const {
        if (depth >= map_.getTreeDepth()) fail("damaged: nodes below the cells");
        if (map_.size() >= promised_)
            failCount(fmt::format("damaged: it has more than {} nodes", map_.size()));
    }

    [[noreturn]] void failCount(const std::string& found) const {
        throw InputError(file_, "", fmt::format("{}, in its header {}", found, promised_));
    }

    std::istream& stream_;
    const std::string& file_;
    std::size_t promised_;
    TexturedOcTree& map_;
};

void readSurfaces(NodeReader& reader, Node& node) {
    const auto inside = reader.read<std::uint8_t>();
    for (unsigned f = 0; f < 6; ++f) {
        if ((inside >> f & 1U) == 0) continue;
        const auto surface = node.surfaces.obtain(f) = reader.read<FaceSurface>();
        if (!(surface.weight > 0.F) || !std::isfinite(surface.weight)) {
            reader.fail("damaged: the weight of a surface is not positive");
        }
    }
    node.surfaces.refreshShown();
}

void readTextured(NodeReader& reader, Node& node, int version) {
    node.setLogOdds(reader.read<float>());
    const auto observed = reader.read<std::uint8_t>();
    for (unsigned f = 0; f < 6; ++f) {
        if ((observed >> f & 1U) == 0) continue;
        node.faces[f] = {reader.read<float>(), reader.read<float>()};
        const FaceTexture& face = node.faces[f];
        if (!(face.mean >= 0.F && face.mean <= 1.F)) {
            reader.fail("damaged: the grey value of a face is not in [0, 1]");
        }
        if (!(face.weight > 0.F && std::isfinite(face.weight))) {
            reader.fail("damaged: the weight of a face is not a positive number");
        }
    }
    if ((observed >> 6U) == 0) return;
    if (observed >> 7U != 0 || version < 2) reader.fail("damaged: a node has unknown contents");
    readSurfaces(reader, node);
}

void readOccupancy(NodeReader& reader, Node& node) { node.setLogOdds(reader.read<float>()); }

void readColored(NodeReader& reader, Node& node) {
    node.setLogOdds(reader.read<float>());
    const auto rgb = reader.read<std::array<std::uint8_t, 3>>();
    const bool set = rgb[0] != 255 || rgb[1] != 255 || rgb[2] != 255;  // white: OctoMap's "unset"
    const double luma = (0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2]) / 255.;
    if (set && node.getLogOdds() > 0.F) node.faces.fill({static_cast<float>(luma), 1.F});
}

/// Inner nodes carry occupancy only, even if the file has more.
void clearInnerFaces(TexturedOcTree& map, Node& node) {
    if (!map.nodeHasChildren(&node)) return;
    node.faces = {};
    node.surfaces.clear();
    for (unsigned i = 0; i < 8; ++i) {
        if (map.nodeChildExists(&node, i)) clearInnerFaces(map, *map.getNodeChild(&node, i));
    }
}

std::unique_ptr<TexturedOcTree> readOcTree(const std::string& file) {
    std::ifstream stream = openToRead(file);
    const Header header = readHeader(stream, file);
    auto map = std::make_unique<TexturedOcTree>(header.resolution);
    NodeReader reader(stream, file, header.nodes, *map);
    const bool ofOctomap = header.id == "OcTree" || header.id == "ColorOcTree";
    const bool known = ofOctomap || (!header.binary && header.id == map->getTreeType());
    if (!known) {
        throw InputError(file, "id",
                         "a map of class \"" + header.id + "\"" + (header.binary ? " (.bt)" : "") +
                             "; TexturedOcTree, ColorOcTree and OcTree can be read");
    }
    if (header.nodes == 0) {
        reader.checkEnd();
        return map;
    }
    if (header.binary) {
        reader.readBinaryNodes(map->obtainRoot(), 0);
    } else if (header.id == "OcTree") {
        reader.readNodes(map->obtainRoot(), 0, readOccupancy);
    } else if (header.id == "ColorOcTree") {
        reader.readNodes(map->obtainRoot(), 0, readColored);
    } else {
        const auto readPayload = [&](NodeReader& from, Node& node) {
            readTextured(from, node, header.version);
        };
        reader.readNodes(map->obtainRoot(), 0, readPayload);
    }
    reader.checkEnd();
    clearInnerFaces(*map, map->obtainRoot());
    return map;
}

// ---- Writing -------------------------------------------------------------------------------

void writeHeader(std::ostream& stream, const std::string& firstLine, const std::string& id,
                 const TexturedOcTree& map) {
    stream.precision(std::numeric_limits<double>::max_digits10);
    stream << firstLine
           << "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
           << (id == map.getTreeType() ? kVersionLine + std::to_string(kVersion) + "\n" : "")
           << "id " << id << "\nsize " << map.size() << "\nres " << map.getResolution()
           << "\ndata\n";
}

void writeColored(std::ostream& stream, const TexturedOcTree& map, const Node& node) {
    const float value = node.getLogOdds();
    stream.write(reinterpret_cast<const char*>(&value), sizeof(value));
    const std::optional<float> grey = node.meanGrey();
    const int level = grey ? std::min<int>(254, greyLevel(*grey)) : 255;
    for (int channel = 0; channel < 3; ++channel) stream.put(static_cast<char>(level));
    unsigned children = 0;
    for (unsigned i = 0; i < 8; ++i) {
        children |= static_cast<unsigned>(map.nodeChildExists(&node, i)) << i;
    }
    stream.put(static_cast<char>(children));
    for (unsigned i = 0; i < 8; ++i) {
        if ((children >> i & 1U) != 0) writeColored(stream, map, *map.getNodeChild(&node, i));
    }
}

}  // namespace

std::unique_ptr<TexturedOcTree> loadTexturedOcTree(const std::string& file) {
    return reading(file, [&] { return readOcTree(file); });
}

bool isOcTreeFile(const std::string& file) {
    const std::string extension = std::filesystem::path(file).extension().string();
    return extension == ".ot" || extension == ".bt";
}

void saveTexturedOcTree(const TexturedOcTree& map, const std::string& file) {
    writeFileAtomically(file, [&](std::ostream& stream) {
        writeHeader(stream, kOtLine, map.getTreeType(), map);
        map.writeData(stream);
    });
}

void saveColorOcTree(const TexturedOcTree& map, const std::string& file) {
    writeFileAtomically(file, [&](std::ostream& stream) {
        writeHeader(stream, kOtLine, "ColorOcTree", map);
        if (map.size() > 0) writeColored(stream, map, *map.getRoot());
    });
}

void saveBinaryOcTree(const TexturedOcTree& map, const std::string& file) {
    writeFileAtomically(file, [&](std::ostream& stream) {
        writeHeader(stream, kBtLine, "OcTree", map);
        map.writeBinaryData(stream);
    });
}

}  // namespace photonav
