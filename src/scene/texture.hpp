// SPDX-License-Identifier: BSD-3-Clause
// Grey textures and the makers of procedural ones.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// Texels of an image file, and of all textures of a procedural scene together: 400 MB.
inline constexpr double kMostTexels = 1e8;

/// A grey texture in [0, 1] (display-referred: what an 8-bit camera would store, divided by 255).
/// Texture coordinates (u, v) in [0, 1) span the image, v downward from its first row; it repeats.
struct Texture {
    ImageF image;
    /// Metres that one repetition covers along u and v on the surfaces of addPlane(), addBox() and
    /// addWall(). Meshes from files bring their own texture coordinates and ignore it.
    Eigen::Vector2d size = Eigen::Vector2d::Ones();

    /// Bilinear interpolation at `position` [m].
    float at(const Eigen::Vector2d& position) const;
};

Texture uniformTexture(double grey);

/// Sum of smooth random fields, one per cell size. It tiles without a seam: cells are stretched a
/// little so that a whole number of them fits `size`.
struct NoiseOptions {
    Eigen::Vector2d size{4., 4.};               ///< extent of one repetition [m]
    std::vector<double> cells{0.6, 0.3, 0.15};  ///< lattice pitches [m]
    std::vector<double> amplitudes{};           ///< per pitch; empty: 0.4 shared equally
    double mean = 0.5;                          ///< grey value
    unsigned seed = 1;
    double texel = 0.01;  ///< [m]
};
Texture valueNoise(const NoiseOptions& options = {});

/// Bars across the u (or v) direction; dark bars start at offset + 2 k width.
struct StripeOptions {
    double width = 0.5;      ///< of one bar [m]; the period is twice that
    double softEdge = 0.05;  ///< width of the linear ramp between bars [m]
    double offset = 0.;      ///< where a dark bar begins [m]
    bool alongV = false;     ///< grey changes along v instead of u
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

/// An image file, `width` metres wide with square texels.
/// @throws InputError when it cannot be read
Texture imageTexture(const std::string& file, double width);

/// A rectangle [min, max] (metres from the corner of the patched texture) of another texture.
struct Patch {
    Eigen::Vector2d min = Eigen::Vector2d::Zero();
    Eigen::Vector2d max = Eigen::Vector2d::Zero();
    const Texture* texture = nullptr;
};

/// `base` with patches painted over it in order, borders anti-aliased to the texel.
/// @param size extent of one repetition [m]
/// @param texel [m]
Texture patchedTexture(const Texture& base, const std::vector<Patch>& patches,
                       const Eigen::Vector2d& size, double texel = 0.01);

/// Grey value of a linear-light colour: luma by Rec. 709 in linear light, sRGB-encoded. This is the
/// one rule by which colour files become grey: decode sRGB, multiply by the linear factor, sum.
double greyOfLinear(const std::array<double, 3>& rgb);

/// Inverse of the sRGB encoding, [0, 1] to [0, 1].
double decodeSrgb(double encoded);

/// Reads an image file (any format of OpenCV) as grey by the rule of greyOfLinear().
/// @param factor linear RGB factor on every texel
/// @throws InputError when it cannot be read
ImageF readGrey(const std::string& file, const std::array<double, 3>& factor = {1., 1., 1.});

/// The same for an encoded image (PNG, JPEG ...) in memory.
/// @param name what messages call it
ImageF decodeGrey(std::span<const std::uint8_t> encoded, const std::string& name,
                  const std::array<double, 3>& factor = {1., 1., 1.});

}  // namespace photonav
