// SPDX-License-Identifier: BSD-3-Clause
// `photonav doctor`: checks this installation.
#pragma once

namespace photonav {

/// Prints the versions of the libraries; checks processor, memory, display and the programs that
/// open results; and plans a small sample problem.
/// @return the exit code: kNoAnswer if the processor lacks instructions or the sample plan fails
int runDoctor();

}  // namespace photonav
