// SPDX-License-Identifier: BSD-3-Clause
// Colours of figures.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace photonav {

struct Color {
    std::uint8_t red = 0, green = 0, blue = 0;
    bool operator==(const Color&) const = default;
};

inline constexpr Color kInk{34, 38, 43}, kWhite{255, 255, 255};

/// Of a grey value; those outside [0, 1] are clamped.
Color greyColor(double intensity);

/// Colours of perceptually uniform colour maps: dark at 0, bright at 1; clamped.
Color viridis(double share);
Color inferno(double share);

/// The colour of a planner in every figure, page and tutorial (PlannerTraits), or of a policy of
/// explorations. All other names are grey.
Color plannerColor(std::string_view planner);

/// "#rrggbb"
std::string hexColor(const Color& color);

}  // namespace photonav
