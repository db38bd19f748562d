// SPDX-License-Identifier: BSD-3-Clause
// Grey textures: procedural ones, and images from files.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// Largest number of texels of an image file, and of all textures of a procedural scene together:
/// 400 MB.
inline constexpr double kMostTexels = 1e8;

/// A texture of grey values in [0, 1] (display-referred: as stored by an 8-bit camera, divided by
/// 255). Texture coordinates (u, v) in [0, 1) span the image, v downward from its first row; the
/// image repeats.
struct Texture {
    ImageF image;
    /// Size of one repetition along u and v on the surfaces of addPlane(), addBox() and addWall()
    /// [m]. Not used by meshes from files, which have their own texture coordinates.
    Eigen::Vector2d size = Eigen::Vector2d::Ones();

    /// Bilinear interpolation at `position` [m].
    float at(const Eigen::Vector2d& position) const;
};

/// A texture of one grey value in [0, 1].
Texture uniformTexture(double grey);

/// Options of valueNoise(): a sum of smooth random fields, one per cell size. It repeats without a
/// seam: cells are stretched a little so that a whole number of them fits `size`.
struct NoiseOptions {
    Eigen::Vector2d size{4., 4.};               ///< extent of one repetition [m]
    std::vector<double> cells{0.6, 0.3, 0.15};  ///< lattice pitches [m]
    std::vector<double> amplitudes{};           ///< grey value, per pitch; empty: equal, sum 0.4
    double mean = 0.5;                          ///< grey value
    unsigned seed = 1;
    double texel = 0.01;  ///< size of a texel [m]
};
Texture valueNoise(const NoiseOptions& options = {});

/// Options of stripes(): bars across the u (or v) direction; dark bars start at offset + 2 k width.
struct StripeOptions {
    double width = 0.5;      ///< width of one bar [m]; the period is 2 width
    double softEdge = 0.05;  ///< width of the linear ramp between bars [m]
    double offset = 0.;      ///< coordinate at which a dark bar begins [m]
    bool alongV = false;     ///< the grey value changes along v instead of u
    double dark = 0.1;       ///< grey value
    double light = 0.9;      ///< grey value
    double texel = 0.01;     ///< [m]
};
Texture stripes(const StripeOptions& options = {});

struct CheckerOptions {
    double cell = 0.5;       ///< side of a square [m]
    double softEdge = 0.02;  ///< width of the linear ramp between squares [m]
    double dark = 0.1;       ///< grey value
    double light = 0.9;      ///< grey value
    double texel = 0.01;     ///< [m]
};
Texture checker(const CheckerOptions& options = {});

/// A texture from an image file, with square texels.
/// @param width width of the image on surfaces [m]
/// @throws InputError when it cannot be read
Texture imageTexture(const std::string& file, double width);

/// A rectangle [min, max] (metres from the corner of the patched texture) of another texture.
struct Patch {
    Eigen::Vector2d min = Eigen::Vector2d::Zero();
    Eigen::Vector2d max = Eigen::Vector2d::Zero();
    const Texture* texture = nullptr;
};

/// The texture `base`, covered by patches in their order; borders of patches are anti-aliased.
/// @param size extent of one repetition [m]
/// @param texel size of a texel [m]
Texture patchedTexture(const Texture& base, const std::vector<Patch>& patches,
                       const Eigen::Vector2d& size, double texel = 0.01);

/// Grey value of a linear-light colour: luma by Rec. 709 in linear light, sRGB-encoded. All colour
/// files are converted to grey by this rule: decode sRGB, multiply by the linear factor, sum,
/// encode.
double greyOfLinear(const std::array<double, 3>& rgb);

/// Inverse of the sRGB encoding, [0, 1] to [0, 1].
double decodeSrgb(double encoded);

/// Reads an image file (any format of OpenCV) as grey by the rule of greyOfLinear().
/// @param factor linear RGB factor on every texel
/// @throws InputError when it cannot be read
ImageF readGrey(const std::string& file, const std::array<double, 3>& factor = {1., 1., 1.});

/// As readGrey(), for an encoded image (PNG, JPEG ...) in memory.
/// @param name name of the image in error messages
ImageF decodeGrey(std::span<const std::uint8_t> encoded, const std::string& name,
                  const std::array<double, 3>& factor = {1., 1., 1.});

}  // namespace photonav
