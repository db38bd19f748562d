// SPDX-License-Identifier: BSD-3-Clause
#include "map/point_cloud.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "io/error.hpp"
#include "io/reading.hpp"
#include "scene/texture.hpp"

namespace photonav {
namespace {

constexpr std::size_t kNoColumn = SIZE_MAX;
constexpr std::size_t kMaxHeaderLines = 1000;

template <class T>
double valueOf(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(value));
    return static_cast<double>(value);
}

double decode(const char* bytes, unsigned size, bool isReal, bool isSigned) {
    if (isReal) return size == 4 ? valueOf<float>(bytes) : valueOf<double>(bytes);
    switch (size) {
        case 1:
            return isSigned ? valueOf<std::int8_t>(bytes) : valueOf<std::uint8_t>(bytes);
        case 2:
            return isSigned ? valueOf<std::int16_t>(bytes) : valueOf<std::uint16_t>(bytes);
        default:
            return isSigned ? valueOf<std::int32_t>(bytes) : valueOf<std::uint32_t>(bytes);
    }
}

bool isEcho(const Eigen::Vector3d& p_w) {
    return p_w.allFinite() && p_w.cwiseAbs().maxCoeff() <= 1e8;
}

}  // namespace

unsigned PointCloudFile::Element::rowBytes() const {
    return properties.empty() ? 0 : properties.back().offset + properties.back().bytes;
}

PointCloudFile::PointCloudFile(std::string file) : file_(std::move(file)) {
    reading(file_, [&] {
        std::ifstream stream = openToRead(file_);
        readHeader(stream);
        locateColumns();
        readScanner(stream);
    });
}

void PointCloudFile::fail(const std::string& reason) const { throw InputError(file_, "", reason); }

void PointCloudFile::failCut(std::uint64_t points) const {
    fail("cut short: " + std::to_string(points) + " of " + std::to_string(vertices_.count) +
         " points");
}

void PointCloudFile::readHeader(std::istream& stream) {
    std::string text;
    if (!std::getline(stream, text) || text.substr(0, 3) != "ply") fail("not a PLY file");
    for (std::size_t n = 0; std::getline(stream, text); ++n) {
        std::istringstream line = wordsOf(text);
        std::string keyword, word;
        line >> keyword;
        if (keyword == "end_header") {
            firstVertex_ = stream.tellg();
            return;
        }
        if (n > kMaxHeaderLines) break;
        if (keyword == "format") {
            line >> word;
            const std::map<std::string, Encoding> encodings{
                {"ascii", Encoding::ascii},
                {"binary_little_endian", Encoding::little},
                {"binary_big_endian", Encoding::big}};
            const auto it = encodings.find(word);
            if (it == encodings.end()) fail("unknown PLY format '" + word + "'");
            encoding_ = it->second;
        } else if (keyword == "element") {
            Element element;
            if (!(line >> element.name >> element.count)) fail("header: no element: " + text);
            elements_.push_back(std::move(element));
        } else if (keyword == "property") {
            if (elements_.empty()) fail("header: a property before any element");
            readProperty(line, elements_.back());
        }
    }
    fail("the header does not end");
}

void PointCloudFile::readProperty(std::istream& line, Element& element) const {
    static const std::map<std::string, Property> types{
        {"char", {"", 1, false, true, 0}},    {"int8", {"", 1, false, true, 0}},
        {"uchar", {"", 1, false, false, 0}},  {"uint8", {"", 1, false, false, 0}},
        {"short", {"", 2, false, true, 0}},   {"int16", {"", 2, false, true, 0}},
        {"ushort", {"", 2, false, false, 0}}, {"uint16", {"", 2, false, false, 0}},
        {"int", {"", 4, false, true, 0}},     {"int32", {"", 4, false, true, 0}},
        {"uint", {"", 4, false, false, 0}},   {"uint32", {"", 4, false, false, 0}},
        {"float", {"", 4, true, true, 0}},    {"float32", {"", 4, true, true, 0}},
        {"double", {"", 8, true, true, 0}},   {"float64", {"", 8, true, true, 0}}};
    std::string type;
    line >> type;
    if (type == "list") {
        element.hasLists = true;
        return;
    }
    const auto it = types.find(type);
    if (it == types.end()) fail("header: unknown type '" + type + "'");
    Property property = it->second;
    line >> property.name;
    property.offset = element.rowBytes();
    element.properties.push_back(property);
}

std::size_t PointCloudFile::columnOf(const Element& element, const std::string& name) const {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        if (element.properties[i].name == name) return i;
    }
    return kNoColumn;
}

void PointCloudFile::locateColumns() {
    if (elements_.empty() || elements_.front().name != "vertex" || elements_.front().hasLists) {
        fail("header: the first element must be 'vertex', without lists");
    }
    vertices_ = elements_.front();
    if (vertices_.count == 0) fail("contains no points");
    const std::array<std::string, 3> axes{"x", "y", "z"};
    for (std::size_t i = 0; i < 3; ++i) {
        position_[i] = columnOf(vertices_, axes[i]);
        if (position_[i] == kNoColumn) fail("header: no property '" + axes[i] + "'");
    }
    const std::vector<std::vector<std::string>> choices{{"red", "green", "blue"}, {"intensity"}};
    for (const auto& names : choices) {
        colour_.clear();
        for (const auto& name : names) colour_.push_back(columnOf(vertices_, name));
        if (std::find(colour_.begin(), colour_.end(), kNoColumn) == colour_.end()) break;
        colour_.clear();
    }
    if (colour_.empty()) fail("the points have no colour (neither red, green, blue nor intensity)");
    const Property& first = vertices_.properties[colour_.front()];
    white_ = first.isReal ? 1. : std::exp2(8. * first.bytes) - 1.;

    if (encoding_ == Encoding::ascii) return;
    const std::uint64_t bytes =
        std::filesystem::file_size(file_) - static_cast<std::uint64_t>(firstVertex_);
    if (vertices_.count > bytes / vertices_.rowBytes()) {
        failCut(bytes / vertices_.rowBytes());
    }
}

/// PCL writes the sensor's place as a second element.
void PointCloudFile::readScanner(std::istream& stream) {
    if (elements_.size() < 2 || elements_[1].name != "camera" || elements_[1].count != 1) return;
    const Element& camera = elements_[1];
    if (camera.hasLists) return;
    std::vector<double> row;
    if (encoding_ == Encoding::ascii) {
        for (std::uint64_t i = 0; i < vertices_.count; ++i) {
            if (!readRow(stream, vertices_, row)) failCut(i);
        }
    } else {
        stream.seekg(firstVertex_ +
                     static_cast<std::streamoff>(vertices_.count * vertices_.rowBytes()));
    }
    if (!readRow(stream, camera, row)) fail("cut short: no camera element");
    Eigen::Vector3d eye;
    const std::array<std::string, 3> axes{"view_px", "view_py", "view_pz"};
    for (int i = 0; i < 3; ++i) {
        const std::size_t column = columnOf(camera, axes[i]);
        if (column == kNoColumn) return;
        eye[i] = row[column];
    }
    if (!isEcho(eye)) fail("camera: the scanner's place is not within 1e8 m");
    scanner_ = eye;
}

bool PointCloudFile::readRow(std::istream& stream, const Element& element,
                             std::vector<double>& row) const {
    row.resize(element.properties.size());
    if (encoding_ == Encoding::ascii) {
        std::string line;
        if (!std::getline(stream, line)) return false;
        const char* at = line.data();
        const char* const end = at + line.size();
        for (double& value : row) {
            at = std::find_if_not(at, end, [](unsigned char c) { return std::isspace(c) != 0; });
            if (at != end && *at == '+') ++at;
            const auto [next, error] = std::from_chars(at, end, value);  // reads "nan" as well
            if (error != std::errc{}) fail("not a point: '" + line.substr(0, 60) + "'");
            at = next;
        }
        return true;
    }
    std::vector<char> bytes(element.rowBytes());
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return false;
    const bool asHere =
        (encoding_ == Encoding::little) == (std::endian::native == std::endian::little);
    for (std::size_t i = 0; i < row.size(); ++i) {
        const Property& p = element.properties[i];
        char* value = &bytes[p.offset];
        if (!asHere) std::reverse(value, value + p.bytes);
        row[i] = decode(value, p.bytes, p.isReal, p.isSigned);
    }
    return true;
}

float PointCloudFile::greyOf(const std::vector<double>& row) const {
    std::array<double, 3> rgb{};
    for (std::size_t i = 0; i < 3; ++i) {
        rgb[i] = row[colour_[colour_.size() == 3 ? i : 0]] / white_;
        if (!(rgb[i] >= 0. && rgb[i] <= 1.)) fail("a colour is not in [0, 1]");
    }
    if (colour_.size() == 1) return static_cast<float>(rgb[0]);
    for (double& channel : rgb) channel = decodeSrgb(channel);
    return static_cast<float>(greyOfLinear(rgb));
}

void PointCloudFile::read(const std::function<void(const ScanPoint&)>& visit) const {
    reading(file_, [&] { readPoints(visit); });
}

void PointCloudFile::readPoints(const std::function<void(const ScanPoint&)>& visit) const {
    std::ifstream stream = openToRead(file_);
    stream.seekg(firstVertex_);
    std::vector<double> row;
    for (std::uint64_t i = 0; i < vertices_.count; ++i) {
        if (!readRow(stream, vertices_, row)) {
            failCut(i);
        }
        const ScanPoint point{{row[position_[0]], row[position_[1]], row[position_[2]]}, 0.F};
        if (isEcho(point.p_w)) visit({point.p_w, greyOf(row)});
    }
}

}  // namespace photonav
