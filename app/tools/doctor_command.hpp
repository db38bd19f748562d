// SPDX-License-Identifier: BSD-3-Clause
// `photonav doctor`: whether this installation works here.
#pragma once

namespace photonav {

/// Prints versions of the libraries, what the processor offers, programs that open results, and
/// plans a small sample.
/// @return kNoAnswer unless all of it that is needed works
int runDoctor();

}  // namespace photonav
