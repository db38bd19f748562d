// SPDX-License-Identifier: BSD-3-Clause
// Smaller views: to be tracked fast, or to be looked at.
#pragma once

#include "photometry/view.hpp"

namespace photonav {

inline constexpr unsigned kShownWidth = 640;  ///< of views in figures, at most [pixels]

/// Halves a view: grey values by halvedAsRendered(), depth taken from the first of four pixels.
void halve(View& view, int times);

/// How often a view of this width is halved until it is at most kShownWidth wide.
int halvingsToShow(unsigned width);

}  // namespace photonav
