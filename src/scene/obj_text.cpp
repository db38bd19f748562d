// SPDX-License-Identifier: BSD-3-Clause
#include "scene/obj_text.hpp"

#include <algorithm>

namespace photonav {

void commentLines(std::span<char> obj) {
    bool isFirst = true;  // of its line
    for (char& c : obj) {
        if (isFirst && (c == 'l' || c == 'p')) c = '#';
        isFirst = c == '\n' || c == '\r' || c == '\f' || c == '\0' ||
                  (isFirst && (c == ' ' || c == '\t'));
    }
}

std::string withWhiteMaterials(std::string_view library) {
    std::string text;
    while (!library.empty()) {
        const std::size_t end = library.find_first_of("\r\n");
        const std::string_view line = library.substr(0, end);
        library.remove_prefix(std::min(line.size() + 1, library.size()));
        text.append(line).append("\n");
        const std::size_t word = line.find_first_not_of(" \t");
        if (word != std::string_view::npos && line.substr(word).starts_with("newmtl")) {
            text += "Kd 1 1 1\n";
        }
    }
    return text;
}

}  // namespace photonav
