// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "photometry/view.hpp"

namespace photonav::python {

/// A map or a scene from which Python renders views.
struct Views {
    std::shared_ptr<const ViewSource> source;
    double cellSize = 0.;  ///< of a map [m]; 0: a scene or mesh
};

}  // namespace photonav::python
