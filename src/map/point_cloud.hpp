// SPDX-License-Identifier: BSD-3-Clause
// Reads coloured point clouds of laser scanners from PLY files, point by point.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// A point of a scan: world frame [m], display-referred grey value in [0, 1].
struct ScanPoint {
    Eigen::Vector3d p_w = Eigen::Vector3d::Zero();
    float grey = 0.F;
};

/// A PLY file of coloured points, taken from one or from several positions of a scanner. Only the
/// header is kept in memory, so that files of any size can be read.
///
/// Colours are `red green blue` (8-bit, or real in [0, 1]), converted to grey like textures;
/// without them, `intensity` is used. Points that are not finite or farther from the origin than
/// 1e8 m along an axis (no echo) are skipped. The position of the scanner is read from the `camera`
/// element that PCL writes (view_px, view_py, view_pz).
class PointCloudFile {
  public:
    /// Reads the header.
    /// @throws InputError naming the file unless it is a PLY file with coloured points that is at
    ///        least as long as its header requires
    explicit PointCloudFile(std::string file);

    /// Number of points by the header, including those that are skipped.
    std::uint64_t size() const { return vertices_.count; }
    /// Position of the scanner, world frame [m]; none if the file does not contain it.
    const std::optional<Eigen::Vector3d>& scanner() const { return scanner_; }

    /// Calls `visit` for every point that is not skipped, in the order of the file.
    /// @throws InputError where a line of an ASCII file is not a point, or a real colour is not in
    ///        [0, 1]
    void read(const std::function<void(const ScanPoint&)>& visit) const;

  private:
    enum class Encoding { ascii, little, big };
    struct Property {
        std::string name;
        unsigned bytes = 0;
        bool isReal = false;
        bool isSigned = false;
        unsigned offset = 0;  // in a row [bytes]
    };
    struct Element {
        std::string name;
        std::uint64_t count = 0;
        std::vector<Property> properties;
        bool hasLists = false;
        unsigned rowBytes() const;
    };

    void readHeader(std::istream& stream);
    void readPoints(const std::function<void(const ScanPoint&)>& visit) const;
    void readProperty(std::istream& line, Element& element) const;
    void locateColumns();
    void readScanner(std::istream& stream);
    std::size_t columnOf(const Element& element, const std::string& name) const;
    /// The values of the next row, one per property. @returns false at the end of the file
    bool readRow(std::istream& stream, const Element& element, std::vector<double>& row) const;
    float greyOf(const std::vector<double>& row) const;
    [[noreturn]] void fail(const std::string& reason) const;
    [[noreturn]] void failCut(std::uint64_t points) const;

    std::string file_;
    Encoding encoding_ = Encoding::ascii;
    std::vector<Element> elements_;  // of the header, in its order
    Element vertices_;
    std::streamoff firstVertex_ = 0;
    std::array<std::size_t, 3> position_{};
    std::vector<std::size_t> colour_;  // three columns, or one
    double white_ = 1.;                // value of white in the colour columns
    std::optional<Eigen::Vector3d> scanner_;
};

}  // namespace photonav
