// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace photonav {

/// Of JSON that photonav writes, which has about ten: deeper text is something else.
inline constexpr std::size_t kMostJsonDepth = 100;

/// How deep arrays and objects are nested in JSON text. Programs that read or write JSON by
/// recursion run out of stack where that is 1e5.
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
