// SPDX-License-Identifier: BSD-3-Clause
// Colours of figures.
#pragma once

#include <array>
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

/// Colours of everything that is not a planner, such as errors, predictions and sets of posters.
/// They differ from each other and from the planners' colours, for readers without green or red
/// receptors as well.
inline constexpr Color kIndigo{51, 34, 136}, kWine{136, 34, 85}, kSand{221, 204, 119},
    kPurple{170, 68, 153}, kBrown{110, 65, 40}, kMint{150, 225, 190};
inline constexpr std::array kSeriesColors{kIndigo, kWine, kSand, kPurple, kBrown, kMint};

/// A colour as "#rrggbb".
std::string hexColor(const Color& color);

}  // namespace photonav
