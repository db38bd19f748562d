// SPDX-License-Identifier: BSD-3-Clause
#include "plot/color.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "planners/planner_traits.hpp"

namespace photonav {
namespace {

std::array<Color, 256> tableOf(cv::ColormapTypes map) {
    cv::Mat1b levels(1, 256);
    for (int i = 0; i < 256; ++i) levels(0, i) = static_cast<unsigned char>(i);
    cv::Mat3b colors;
    cv::applyColorMap(levels, colors, map);
    std::array<Color, 256> table;
    std::transform(colors.begin(), colors.end(), table.begin(), [](const cv::Vec3b& bgr) {
        return Color{bgr[2], bgr[1], bgr[0]};
    });
    return table;
}

Color at(const std::array<Color, 256>& table, double share) {
    return table[static_cast<std::size_t>(255. * std::clamp(share, 0., 1.))];
}

}  // namespace

Color greyColor(double intensity) {
    const auto level = static_cast<std::uint8_t>(std::lround(255. * std::clamp(intensity, 0., 1.)));
    return {level, level, level};
}

Color viridis(double share) {
    static const auto table = tableOf(cv::COLORMAP_VIRIDIS);
    return at(table, share);
}

Color inferno(double share) {
    static const auto table = tableOf(cv::COLORMAP_INFERNO);
    return at(table, share);
}

Color plannerColor(std::string_view planner) {
    if (const PlannerTraits* known = findPlanner(planner)) {
        return {known->color[0], known->color[1], known->color[2]};
    }
    if (planner == "rrt_star/fixed") return {86, 180, 233};
    if (planner == "rrt_star/forward") return {204, 121, 167};
    return {98, 104, 112};
}

std::string hexColor(const Color& color) {
    return fmt::format("#{:02x}{:02x}{:02x}", color.red, color.green, color.blue);
}

}  // namespace photonav
