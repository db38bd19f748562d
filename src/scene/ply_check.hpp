// SPDX-License-Identifier: BSD-3-Clause
// Checks a PLY file before assimp reads it.
#pragma once

#include <string>

namespace photonav {

/// Checks that the header is understood, and that the file holds all elements that it promises.
/// @throws InputError naming the file and the element
void checkPly(const std::string& file);

}  // namespace photonav
