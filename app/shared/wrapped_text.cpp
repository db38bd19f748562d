// SPDX-License-Identifier: BSD-3-Clause
#include "shared/wrapped_text.hpp"

#include <sstream>

#include "result/text_table.hpp"

namespace photonav {

std::string wrappedText(const std::string& text, std::size_t indent) {
    constexpr std::size_t kMostColumns = 80;
    std::istringstream words(text);
    std::string word, lines;
    std::size_t column = indent;
    while (words >> word) {
        if (column > indent && column + 1 + characters(word) > kMostColumns) {
            lines += "\n" + std::string(indent, ' ');
            column = indent;
        }
        if (column > indent) lines += ' ', ++column;
        lines += word;
        column += characters(word);
    }
    return lines;
}

}  // namespace photonav
