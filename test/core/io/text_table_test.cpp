// SPDX-License-Identifier: BSD-3-Clause
#include "io/text_table.hpp"

#include <gtest/gtest.h>

#include "reason_of.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

const std::string kMark = "\xEF\xBB\xBF";

TEST(TextTable, AByteOrderMarkAtTheBeginningIsSkipped) {
    const test::TemporaryFolder folder;
    for (const std::string text : {"1 2\n3 4\n", "# two\n1 2\n3 4\n", "\n1 2\n3 4\n"}) {
        const auto rows = readTable(folder.write("table.txt", kMark + text), 2);
        ASSERT_EQ(rows.size(), 2U) << text;
        EXPECT_EQ(rows[0].number(0), 1.);
    }
    EXPECT_EQ(readCsv(folder.write("table.csv", kMark + "1,2\n"), 2).at(0).number(0), 1.);
    EXPECT_TRUE(readTable(folder.write("table.txt", kMark), 2).empty());
}

TEST(TextTable, OnlyOneWholeMarkIsSkipped) {
    const test::TemporaryFolder folder;
    for (const std::string& start : {kMark + kMark, kMark.substr(0, 2), "\n" + kMark}) {
        const auto rows = readTable(folder.write("table.txt", start + "1 2\n"), 2);
        EXPECT_NE(test::reasonOf([&] { rows.at(0).number(0); }).find("is not a number"),
                  std::string::npos);
    }
}

}  // namespace
}  // namespace photonav
