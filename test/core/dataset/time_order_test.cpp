// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/time_order.hpp"

#include <gtest/gtest.h>

#include "dataset/image_file.hpp"

namespace photonav {
namespace {

using Times = std::vector<double>;

Times kept(const Times& times, Repeats repeats = Repeats::skipped) {
    const auto which = inOrderOfTime(times, repeats);
    Times result;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (which[i]) result.push_back(times[i]);
    }
    return result;
}

TEST(TimeOrder, KeepsWhatIsInOrder) {
    EXPECT_EQ(kept({}), Times());
    EXPECT_EQ(kept({3.}), Times({3.}));
    EXPECT_EQ(kept({1., 2., 5.}), Times({1., 2., 5.}));
}

TEST(TimeOrder, OneWildTimestampCostsOneRow) {
    EXPECT_EQ(kept({1., 2., 900., 3., 4.}), Times({1., 2., 3., 4.}));
    EXPECT_EQ(kept({1., 2., -900., 3., 4.}), Times({1., 2., 3., 4.}));
    EXPECT_EQ(kept({900., 1., 2., 3.}), Times({1., 2., 3.}));
}

TEST(TimeOrder, OfTwoThatExcludeEachOtherTheFirstIsKept) {
    const auto which = inOrderOfTime({1., 3., 2., 4.}, Repeats::skipped);
    EXPECT_EQ(which, std::vector<bool>({true, true, false, true}));
}

TEST(TimeOrder, RepeatsAreKeptOrSkipped) {
    EXPECT_EQ(kept({1., 2., 2., 3.}, Repeats::kept).size(), 4U);
    EXPECT_EQ(kept({1., 2., 2., 3.}, Repeats::skipped), Times({1., 2., 3.}));
}

struct Parsed {
    std::vector<std::string> files;
    std::vector<std::string> reasons;
};

Parsed parsed(const std::vector<std::vector<std::string>>& lines) {
    std::vector<TextRow> rows;
    for (const auto& fields : lines) rows.emplace_back("list", int(rows.size()) + 1, fields);
    std::vector<InputError> badRows;
    const auto items = parseInOrderOfTime<StampedFile>(
        rows,
        [](const TextRow& row) {
            return StampedFile{row.number(0), row.text(1)};
        },
        Repeats::skipped, &badRows);
    Parsed result;
    for (const StampedFile& item : items) result.files.push_back(item.file);
    for (const InputError& row : badRows) result.reasons.push_back(row.reason());
    return result;
}

TEST(TimeOrder, SaysWhichLinesItPassesOverAndWhy) {
    const Parsed p = parsed({{"1", "a"},
                             {"garbage", "b"},
                             {"2", "c"},
                             {"9", "d"},
                             {"2", "e"},
                             {"1.5", "f"},
                             {"3", "g"},
                             {"4", "h"}});
    EXPECT_EQ(p.files, std::vector<std::string>({"a", "c", "g", "h"}));
    ASSERT_EQ(p.reasons.size(), 4U);
    EXPECT_NE(p.reasons[0].find("line 2"), std::string::npos) << p.reasons[0];
    EXPECT_EQ(p.reasons[1], "line 4: timestamp is larger than the one after");
    EXPECT_EQ(p.reasons[2], "line 5: timestamp repeats the one before");
    EXPECT_EQ(p.reasons[3], "line 6: timestamp is smaller than the one before");
}

TEST(TimeOrder, MoreBadRowsThanGoodAreAnError) {
    EXPECT_THROW(parsed({{"1", "a"}, {"garbage", "b"}, {"x", "c"}}), InputError);
}

}  // namespace
}  // namespace photonav
