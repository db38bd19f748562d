// SPDX-License-Identifier: BSD-3-Clause
#include "result/text_table.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

const TextTable kTable{{"name", "length [m²]"}, {{"a", "1.5 ± 0.1"}, {"longer", "2"}}};

TEST(TextTableTest, CountsCharactersNotBytes) {
    EXPECT_EQ(characters("1 ± 2"), 5U);
    EXPECT_EQ(padded("±", 3), "  ±");
    EXPECT_EQ(padded("long", 3), "long");
}

TEST(TextTableTest, AlignsColumns) {
    EXPECT_EQ(alignedText(kTable),
              "name    length [m²]\n"
              "a         1.5 ± 0.1\n"
              "longer            2\n");
}

TEST(TextTableTest, ColumnsThatDoNotFitFollowBelow) {
    const TextTable table{{"a", "first", "second", "third"}, {{"1", "2", "3", "4"}}};
    EXPECT_EQ(alignedText(table, 16),
              "a  first  second\n"
              "1      2       3\n"
              "\n"
              "a  third\n"
              "1      4\n");
    EXPECT_EQ(alignedText(table, 15),
              "a  first\n"
              "1      2\n"
              "\n"
              "a  second\n"
              "1       3\n"
              "\n"
              "a  third\n"
              "1      4\n");
    EXPECT_EQ(alignedText({{"only"}, {{"1"}}}), "only\n1   \n");
}

TEST(TextTableTest, MarkdownIsAligned) {
    EXPECT_EQ(alignedMarkdown(kTable),
              "| name   | length [m²] |\n"
              "|--------|------------:|\n"
              "| a      |   1.5 ± 0.1 |\n"
              "| longer |           2 |\n");
}

}  // namespace
}  // namespace photonav
