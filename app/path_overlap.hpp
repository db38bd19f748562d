// SPDX-License-Identifier: BSD-3-Clause
// Paths that hide each other from above.
#pragma once

#include "figures.hpp"

namespace photonav {

/// Whether most points of a path are nearer than `tolerance` [m] to another one, in x and y.
bool runsAlong(const DrawnPath& path, const DrawnPath& other, double tolerance);

}  // namespace photonav
