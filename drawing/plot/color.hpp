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

/// The colour of a grey value, clamped to [0, 1].
Color greyColor(double intensity);

/// Colours of the perceptually uniform colour maps viridis and inferno: dark at 0, bright at 1.
/// `share` is clamped to [0, 1].
Color viridis(double share);
Color inferno(double share);

/// The colour of a planner (PlannerTraits), or of a planner with a policy of explorations
/// ("rrt_star/fixed"), in all figures and pages. Grey for all other names.
Color plannerColor(std::string_view planner);

/// A colour as "#rrggbb".
std::string hexColor(const Color& color);

}  // namespace photonav
