// SPDX-License-Identifier: BSD-3-Clause
// Report pages in a real browser: headless Chromium with a software renderer.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "report/report.hpp"
#include "temporary_folder.hpp"

namespace photonav {

inline constexpr const char* kChromium = "/usr/bin/chromium";

struct Outcome {
    std::string dom;  ///< the page after its scripts ran
    std::string log;  ///< what Chromium said, its console included
};

class ReportBrowserTest : public testing::Test {
  protected:
    void SetUp() override {
#ifdef PHOTONAV_SANITIZED
        GTEST_SKIP() << "the page runs in the browser, not under the sanitizers";
#endif
        if (!std::filesystem::exists(kChromium)) GTEST_SKIP() << kChromium << " is not installed";
        std::string name =
            (std::filesystem::temp_directory_path() / "photonav_browser_XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override {
        if (!folder_.empty()) std::filesystem::remove_all(folder_);
    }

    /// Opens the page of `data` and returns it as it stands a few (virtual) seconds later.
    /// @param script appended to the page: what a visitor would do
    Outcome open(const ReportData& data, const std::string& hash = "",
                 const std::string& options = "", const std::string& script = "") const {
        writeReport(folder_ / "report.html", reportJson(data));
        if (!script.empty())
            std::ofstream(folder_ / "report.html", std::ios::app)
                << "<script>" << script << "</script>";
        return openAddress("file://" + (folder_ / "report.html").string() + hash, options);
    }

    Outcome openAddress(const std::string& address, const std::string& options = "") const {
        const std::string command =
            std::string(kChromium) +
            " --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader"
            " --disable-background-networking --disable-component-update --disable-sync"
            " --no-first-run --enable-logging=stderr --virtual-time-budget=8000"
            // A busy machine draws a first frame after the virtual time, unless that waits for it.
            " --run-all-compositor-stages-before-draw"
            " --window-size=1400,2200 --user-data-dir=" +
            (folder_ / "profile").string() + " " + options + " --dump-dom '" + address + "' >" +
            (folder_ / "dom").string() + " 2>" + (folder_ / "log").string();
        EXPECT_EQ(std::system(command.c_str()), 0) << test::contentOf(folder_ / "log");
        return {test::contentOf(folder_ / "dom"), test::contentOf(folder_ / "log")};
    }

    std::filesystem::path folder_;
};

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// The value of a data-... attribute of <html>; empty if it is not there.
inline std::string published(const std::string& dom, const std::string& name) {
    const std::string root = dom.substr(dom.find("<html"), dom.find('>', dom.find("<html")));
    const std::size_t begin = root.find("data-" + name + "=\"");
    if (begin == std::string::npos) return {};
    const std::size_t value = begin + name.size() + 7;
    return root.substr(value, root.find('"', value) - value);
}

inline void expectNoErrors(const Outcome& outcome) {
    EXPECT_EQ(published(outcome.dom, "errors"), "");
    std::istringstream lines(outcome.log);
    for (std::string line; std::getline(lines, line);)
        EXPECT_FALSE(contains(line, ":CONSOLE")) << line;
}

}  // namespace photonav
