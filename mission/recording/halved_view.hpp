// SPDX-License-Identifier: BSD-3-Clause
// Reduces views to half their size, for faster tracking and for figures.
#pragma once

#include "photometry/view.hpp"

namespace photonav {

inline constexpr unsigned kShownWidth = 640;  ///< largest width of views in figures [pixels]

/// Halves the size of a view several times. Grey values are reduced by halvedAsRendered(); depth is
/// taken from the upper left of each four pixels.
void halve(View& view, int times);

/// Number of halvings after which a view of this width [pixels] is at most kShownWidth wide.
int halvingsToShow(unsigned width);

}  // namespace photonav
