// SPDX-License-Identifier: BSD-3-Clause
// Whatever is read as JSON, nested so deep that programs which follow it by recursion run out of
// stack. (Meshes: mesh_io_test.cpp.)
#include <gtest/gtest.h>

#include "exploration/trial_journal.hpp"
#include "flightlog/flight_log.hpp"
#include "problem/planned_path.hpp"
#include "reason_of.hpp"
#include "report/report.hpp"
#include "sweep/sweep_journal.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

/// A list in a list in a list ...
std::string nested() {
    constexpr std::size_t kDepth = 200000;
    return std::string(kDepth, '[') + std::string(kDepth, ']');
}

class NestedJson : public testing::Test {
  protected:
    const test::TemporaryFolder folder_;
};

TEST_F(NestedJson, OfAReportIsRefused) {
    const std::string file =
        folder_.write("report.json", R"({"schema": 1, "result": )" + nested() + "}");
    EXPECT_EQ(test::reasonOf([&] { readReportJson(file); }), file + ": nested too deep");
}

TEST_F(NestedJson, OfAFlightLogIsRefused) {
    const std::string file = folder_.write("flight.json", R"({"header": )" + nested() + "}");
    EXPECT_EQ(test::reasonOf([&] { readFlightLog(file); }), file + ": nested too deep");
}

TEST_F(NestedJson, OfAPlanIsRefused) {
    const Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml", {});
    const std::string file =
        folder_.write("result.json", R"({"command": "plan", "path": )" + nested() + "}");
    EXPECT_EQ(test::reasonOf([&] { readPlannedPath(file, config); }), file + ": nested too deep");
}

TEST_F(NestedJson, OfJournalsIsRefused) {
    const JournalHeader header{"name", "", {}, {}};
    const std::string reason = "line 2: not a ";
    SweepJournal::create(folder_.path(), header, {});
    const std::string runs = test::contentOf(folder_.file(SweepJournal::kFileName));
    folder_.write(SweepJournal::kFileName, runs + nested() + "\n");
    EXPECT_NE(test::reasonOf([&] { SweepJournal::read(folder_.path()); }).find(reason),
              std::string::npos);
    TrialJournal::create(folder_.path(), header, {});
    const std::string trials = test::contentOf(folder_.file(TrialJournal::kFileName));
    folder_.write(TrialJournal::kFileName, trials + R"({"planner": )" + nested() + "}\n");
    EXPECT_NE(test::reasonOf([&] { TrialJournal::read(folder_.path()); }).find(reason),
              std::string::npos);
}

}  // namespace
}  // namespace photonav
