// SPDX-License-Identifier: BSD-3-Clause
// Text for a terminal of 80 columns.
#pragma once

#include <string>

namespace photonav {

/// Words in lines of at most 80 columns, all but the first indented.
std::string wrappedText(const std::string& text, std::size_t indent);

}  // namespace photonav
