// SPDX-License-Identifier: BSD-3-Clause
// A fixture for tests that run the executable.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "app/executable.hpp"
#include "temporary_folder.hpp"

namespace photonav {

/// A folder for the results of a command, and what is expected of them.
class CommandTest : public testing::Test {
  protected:
    Execution plan(const std::string& arguments, const std::string& name = "two_textures") {
        return photonav("plan " + config(name) + " --out " + folder_.string() + " " + arguments);
    }

    nlohmann::json result() const {
        return nlohmann::json::parse(std::ifstream(folder_ / "result.json"));
    }

    void expectBadInput(const Execution& run, const std::string& reason) const {
        photonav::expectBadInput(run, reason);
        EXPECT_FALSE(std::filesystem::exists(folder_ / "result.json"));
    }

    test::TemporaryFolder temporary_;
    std::filesystem::path folder_ = temporary_.path() / "out";
};

/// Options of a plan that takes a second.
inline constexpr const char* kQuickPlan =
    " --set planner.vertices=300 --set planner.view_pitch=0.4 ";

}  // namespace photonav
