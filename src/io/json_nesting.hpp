// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace photonav {

/// Deepest nesting of JSON that is accepted. photonav writes about ten levels: deeper text is not
/// from photonav.
inline constexpr std::size_t kMostJsonDepth = 100;

/// How deep arrays and objects are nested in JSON text. Recursive JSON parsers run out of stack at
/// a depth of about 1e5.
inline std::size_t nestingDepth(std::string_view text) {
    std::size_t depth = 0, most = 0;
    bool inString = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (inString) {
            if (c == '\\') ++i;
            inString = c != '"';
            continue;
        }
        inString = c == '"';
        if (c == '[' || c == '{') most = std::max(most, ++depth);
        if ((c == ']' || c == '}') && depth > 0) --depth;
    }
    return most;
}

}  // namespace photonav
