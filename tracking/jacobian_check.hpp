// SPDX-License-Identifier: BSD-3-Clause
// Which directions of J the image really changes along.
#pragma once

#include <functional>
#include <optional>

#include "normal_equations.hpp"

namespace photonav {

/// J by central differences is not quite the change of the image. Where an edge is askew by 0.03
/// rad it says something along the edge, too: a few millionths of the information across it, but
/// that is centimetres against decimetres of a prior, and adds up over images. So directions that J
/// says little about, but enough to matter beside the prior, are tried out: the camera walks one of
/// its standard deviations along them, to either side, and aside wherever that brings the image
/// back. What hardly changed the image then cannot have been told by it.
/// @param here an image compared with itself, divided by the noise's variance: AtA (of the pose),
///        count and mean inverse depth are used
/// @param prior covariance of the pose, the same frame; none: one mean depth and one radian
/// @param walk what the image says to a camera displaced by exp(xi^), divided likewise; its loss is
///        that of the displacement
/// @return M, so that J M is without what is not true; exactly the identity where all of J is
Matrix6 verifiedDirections(const NormalEquations& here, const std::optional<Matrix6>& prior,
                           const std::function<NormalEquations(const Pose& T_away_here)>& walk);

}  // namespace photonav
