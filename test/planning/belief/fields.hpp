// SPDX-License-Identifier: BSD-3-Clause
// Fields of the information of views, and their entries.
#pragma once

#include "belief/information_field.hpp"

namespace photonav::test {

/// A field of the views of a camera with the given mount.
inline std::shared_ptr<InformationField> fieldOf(const std::shared_ptr<const ViewSource>& views,
                                                 double belowHorizon) {
    const Camera camera = makeCamera(94, 60, 1.2);
    return std::make_shared<InformationField>(views, camera, photometricModel(camera, {}),
                                              cameraMount(belowHorizon),
                                              InformationField::Options{.positionPitch = 1e-3});
}

using Entries = std::vector<const InformationField::Entry*>;

inline Entries entriesAt(const std::vector<Pose>& poses, InformationField& field) {
    Entries entries;
    for (const Pose& pose : poses) entries.push_back(&field.at(pose));
    return entries;
}

}  // namespace photonav::test
