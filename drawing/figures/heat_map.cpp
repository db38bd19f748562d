// SPDX-License-Identifier: BSD-3-Clause
#include "figures/heat_map.hpp"

#include <cmath>
#include <stdexcept>

namespace photonav {
namespace {

constexpr Color kOffScale{58, 58, 62};  // zero has no place on a logarithmic scale

/// Cells as pixels, the largest y first.
Picture cellColors(const HeatMap& map, const Axis& scale) {
    Picture picture{{}, static_cast<int>(map.values.rows())};
    for (Eigen::Index j = map.values.cols() - 1; j >= 0; --j)
        for (Eigen::Index i = 0; i < map.values.rows(); ++i) {
            const double value = map.values(i, j);
            const bool isOffScale = map.logScale && value <= 0.;
            picture.pixels.push_back(!std::isfinite(value) ? kWhite
                                     : isOffScale          ? kOffScale
                                                           : viridis(scale.fraction(value)));
        }
    return picture;
}

/// One box per stretch of cells without a value.
std::vector<Eigen::AlignedBox2d> unflyable(const HeatMap& map) {
    const Eigen::Vector2d cell =
        map.area.sizes().array() / Eigen::Array2d(static_cast<double>(map.values.rows()),
                                                  static_cast<double>(map.values.cols()));
    std::vector<Eigen::AlignedBox2d> boxes;
    for (Eigen::Index i = 0; i < map.values.rows(); ++i)
        for (Eigen::Index j = 0; j < map.values.cols(); ++j) {
            if (std::isfinite(map.values(i, j))) continue;
            const Eigen::Vector2d low = map.area.min() + cell.cwiseProduct(Eigen::Vector2d(i, j));
            if (j > 0 && !std::isfinite(map.values(i, j - 1)))
                boxes.back().extend(low + cell);
            else
                boxes.emplace_back(low, low + cell);
        }
    return boxes;
}

}  // namespace

Figure heatMapFigure(const HeatMap& map) {
    if (map.values.size() == 0) throw std::invalid_argument("heat map: no values");
    Plot plot = Plot::map(map.area, 760.);
    const auto values = map.values.reshaped();
    const Axis scale =
        Axis{.log = map.logScale, .label = map.label}.fittedTo({values.begin(), values.end()});
    plot.picture(cellColors(map, scale), map.area, false);
    if (map.logScale && (map.values <= 0.).any())
        plot.fill({{}}, {.color = kOffScale, .name = "zero"});
    plot.hatched(unflyable(map), "not flyable");
    plot.colorBar(scale);
    return {map.title, {{plot}}};
}

}  // namespace photonav
