// SPDX-License-Identifier: BSD-3-Clause
#include "shared/place_option.hpp"

#include <fmt/format.h>

#include <cmath>

#include "geometry/se3.hpp"
#include "io/error.hpp"
#include "io/number.hpp"

namespace photonav {

Place placeOf(const std::optional<std::string>& at, const Place& otherwise, const Config& config) {
    Place place = otherwise;
    if (at) {
        const auto numbers = numbersIn(*at, ',');
        if (!numbers || (numbers->size() != 3 && numbers->size() != 4)) {
            throw InputError("--at", *at, "expected x,y,z or x,y,z,yaw");
        }
        place = {Eigen::Vector3d(numbers->data()), std::nullopt};
        if (numbers->size() == 4) place.yaw = (*numbers)[3];
        if (std::abs(place.yaw.value_or(0.)) > kLargestHeading) {
            throw InputError("--at", *at, fmt::format("heading beyond {} rad", kLargestHeading));
        }
    }
    if (!place.yaw) place.yaw = config.start.yaw;  // the only heading there is in space xyz
    if (at && !config.bounds.contains(place.position)) {
        throw InputError("--at", *at, "outside the bounds of the config");
    }
    return place;
}

Pose bodyAt(const Place& place) { return levelPose(place.position, place.yaw.value_or(0.)); }

}  // namespace photonav
