// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mesh_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "io/error.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

std::string lowerCase(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::size_t binarySize(const std::string& type) {
    if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
    if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
    return type == "double" || type == "float64" ? 8 : 4;
}

/// The least that elements take: in text a digit and a blank each, of lists their length only.
void checkPly(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    const double size = static_cast<double>(fs::file_size(file));
    double least = 0.;
    double count = 0.;
    bool isText = false;
    std::string line;
    std::string element;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        std::string word;
        std::string type;
        words >> word >> type;
        if (word == "format") isText = type == "ascii";
        if (word == "element") {
            element = type;
            if (!(words >> count) || count < 0.) {
                throw InputError(file, "element " + element, "not a number of elements");
            }
        }
        if (word == "property") {
            if (type == "list") words >> type;
            least += count * (isText ? 2. : static_cast<double>(binarySize(type)));
            if (least > size + 2.) {
                throw InputError(
                    file, "element " + element,
                    fmt::format("{:.0f} of them do not fit into {:.0f} bytes", count, size));
            }
        }
        if (word == "end_header") return;
    }
}

void checkObj(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
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

}  // namespace

void checkMeshFile(const std::string& file) {
    const std::string extension = lowerCase(fs::path(file).extension().string());
    if (extension == ".ply") checkPly(file);
    if (extension == ".obj") checkObj(file);
}

}  // namespace photonav
