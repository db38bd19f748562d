// SPDX-License-Identifier: BSD-3-Clause
// The executable, as a user runs it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "app/executable.hpp"
#include "io/stopwatch.hpp"
#include "tum_dataset.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class CommandLine : public testing::Test {
  protected:
    Execution plan(const std::string& arguments, const std::string& name = "two_textures") {
        return photonav("plan " + config(name) + " --out " + folder_.string() + " " + arguments);
    }

    json result() const { return json::parse(std::ifstream(folder_ / "result.json")); }

    void expectBadInput(const Execution& run, const std::string& reason) const {
        EXPECT_EQ(run.exitCode, 2) << run.output;
        EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
        EXPECT_TRUE(run.output.starts_with("photonav: ")) << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
        EXPECT_FALSE(fs::exists(folder_ / "result.json"));
    }

    test::TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path() / "out";
};

constexpr const char* kQuickPlan = " --set planner.vertices=300 --set planner.view_pitch=0.4 ";

TEST_F(CommandLine, PlanWritesEverythingItPromises) {
    const Execution run = plan(std::string("--audit") + kQuickPlan);
    ASSERT_EQ(run.exitCode, 0) << run.output;
    for (const char* name : {"result.json", "config.yaml", "path.tum", "top_view.png", "trace.png",
                             "views.png", "information.png", "report.json", "report.html"}) {
        EXPECT_TRUE(fs::exists(folder_ / name)) << name;
    }
    const json r = result();
    for (const char* key : {"schema", "command", "version", "seed", "planner", "alpha", "cost",
                            "length", "mean_trace", "goal_trace", "vertices", "iterations", "views",
                            "cache_hits", "time", "audit", "path"}) {
        EXPECT_TRUE(r.contains(key)) << key;
    }
    const double lengthInJ = r["metric_length"];  // nothing turns here
    EXPECT_NEAR(lengthInJ, r["length"].get<double>(), 1e-9);
    EXPECT_NEAR(r["cost"].get<double>(),
                (0.1 + 0.9 * 2.5 * r["mean_trace"].get<double>()) * lengthInJ, 1e-9);
    for (const char* key : {"total_s", "views_s", "beliefs_s", "tree_s"}) {
        EXPECT_GE(r["time"][key].get<double>(), 0.) << key;
    }
    EXPECT_LT(r["audit"]["max_cost_error"].get<double>(), 1e-9);
    EXPECT_LT(r["audit"]["max_covariance_error"].get<double>(), 1e-9);
    EXPECT_EQ(r["path"].front()["position"], json({0., 0., 2.}));
    EXPECT_EQ(r["path"].back()["position"], json({2., 9., 2.}));
    EXPECT_EQ(r["path"].back()["covariance"].size(), 21U);
    EXPECT_NEAR(r["path"].back()["cost"].get<double>(), r["cost"].get<double>(), 1e-9);
    EXPECT_NEAR(r["path"].back()["trace"].get<double>(), r["goal_trace"].get<double>(), 1e-12);
}

TEST_F(CommandLine, EvolutionIsAFigureAndAnAnimation) {
    const Execution run = plan(std::string("--evolution") + kQuickPlan);
    ASSERT_EQ(run.exitCode, 0) << run.output;
    EXPECT_TRUE(fs::exists(folder_ / "tree_evolution.png"));
    std::ifstream stream(folder_ / "report.json");
    const json report = json::parse(stream);
    ASSERT_EQ(report["frames"].size(), 6U);  // 10, 20, 50, 100, 200 and 300 vertices
    EXPECT_EQ(report["frames"][0]["caption"], "10 vertices");
    EXPECT_EQ(report["frames"][5]["caption"], "300 vertices");
    EXPECT_NE(report["frames"][0]["image"], report["frames"][5]["image"]);
}

TEST_F(CommandLine, TheDetourReducesUncertainty) {
    ASSERT_EQ(plan(kQuickPlan).exitCode, 0);
    const json r = result();
    EXPECT_GT(r["length"].get<double>(), r["baseline"]["length"].get<double>() + 1.);
    EXPECT_LT(r["goal_trace"].get<double>(), 0.2 * r["baseline"]["goal_trace"].get<double>());
    EXPECT_LT(r["cost"].get<double>(), r["baseline"]["cost"].get<double>());
}

/// The share of each term is printed; where the shortest path is no worse, that is said.
TEST_F(CommandLine, PlansSayWhatTheirCostConsistsOf) {
    expectBadInput(plan("--kappa much"), "planner.kappa: cannot read");
    expectBadInput(plan("--alpha 2"), "planner.alpha: 2 is outside [0, 1]");
    const Execution usual = plan("--kappa auto --alpha 0.4" + std::string(kQuickPlan));
    EXPECT_EQ(usual.exitCode, 0) << usual.output;
    const json r = result();
    EXPECT_EQ(r["alpha"], 0.4);
    EXPECT_EQ(r["kappa_is_automatic"], true);
    EXPECT_NEAR(r["baseline"]["length_share"].get<double>(), 0.4, 1e-9);
    EXPECT_NEAR(r["baseline"]["uncertainty_share"].get<double>(), 0.6, 1e-9);
    EXPECT_FALSE(r.contains("verdict"));
    EXPECT_NE(usual.output.find("% uncertainty (alpha 0.4, kappa "), std::string::npos);
    const Execution little = plan("--kappa 1e-6" + std::string(kQuickPlan));
    EXPECT_NE(little.output.find("no advantage over the shortest path: uncertainty is only"),
              std::string::npos)
        << little.output;
}

TEST_F(CommandLine, PlansAreDeterministicAndConfigsRerunnable) {
    ASSERT_EQ(plan(std::string("--seed 7") + kQuickPlan).exitCode, 0);
    const json first = result();
    const fs::path copy = folder_.string() + "_config.yaml";
    fs::copy_file(folder_ / "config.yaml", copy, fs::copy_options::overwrite_existing);
    ASSERT_EQ(photonav("plan " + copy.string() + " --out " + folder_.string()).exitCode, 0);
    const json second = result();
    EXPECT_EQ(first["path"], second["path"]);
    EXPECT_EQ(first["seed"], 7);
    fs::remove(copy);
}

TEST_F(CommandLine, RrtStarRendersNoViewWhilePlanning) {
    ASSERT_EQ(plan(std::string("--set planner.name=rrt_star") + kQuickPlan).exitCode, 0);
    EXPECT_EQ(result()["views"], 0);
    EXPECT_EQ(result()["alpha"], 1.);
    EXPECT_GT(result()["goal_trace"].get<double>(), 0.1);
}

TEST_F(CommandLine, NoPathIsExitCodeOneWithResults) {
    const Execution run = plan("--set planner.vertices=2");  // the goal is not among the first two
    EXPECT_EQ(run.exitCode, 1) << run.output;
    EXPECT_EQ(result()["status"], "no path");
    EXPECT_TRUE(result()["path"].empty());
    EXPECT_TRUE(fs::exists(folder_ / "report.html"));
    EXPECT_FALSE(fs::exists(folder_ / "information.png"));  // nothing to look for
}

/// A map of a small recording, and a config for planning in it.
class RecordedMap : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
        test::FloorDataset().write(folder_ / "data");
        ASSERT_EQ(photonav("map " + path("data") + " --out " + path("map")).exitCode, 0);
        std::ofstream(folder_ / "plan.yaml")
            << "map: {file: map/map.ot, unknown: free}\nbounds: [[0, -0.2, 1.4], [0.5, 0.2, 1.6]]\n"
               "start: [0, 0, 1.52]\ngoal: [0.5, 0.1, 1.52]\nrobot: {radius: 0.1}\n"
               "planner: {vertices: 150, view_pitch: 0.1, ds: 0.1}\n";
    }
    std::string path(const char* name) const { return (folder_ / name).string(); }
    Execution planned(const std::string& arguments) {
        Execution run =
            photonav("plan " + path("plan.yaml") + " --out " + path("result") + arguments);
        result_ = json::parse(std::ifstream(folder_ / "result" / "result.json"));
        return run;
    }
    bool has(const char* name) const { return fs::exists(folder_ / "result" / name); }
    json result_;
};

TEST_F(RecordedMap, PlansAreShownBesideTheNearestRecordedFrames) {
    ASSERT_EQ(planned("").exitCode, 0);
    const json frames = result_["recorded_frames"];
    ASSERT_GE(frames.size(), 2U);
    EXPECT_NEAR(frames.front()["stamp"].get<double>(), 100., 1e-6);
    EXPECT_NEAR(frames.front()["distance_m"].get<double>(), 0., 1e-6);
    EXPECT_NEAR(frames.back()["stamp"].get<double>(), 100.5, 1e-6);
    EXPECT_NEAR(frames.back()["distance_m"].get<double>(), 0.1, 1e-6);
    for (const json& frame : frames) {
        EXPECT_NEAR(frame["angle_deg"].get<double>(), 0., 1e-3);
        EXPECT_LT(frame["mean_abs_difference"].get<double>(), 0.03);
    }
    EXPECT_TRUE(has("recorded_frames.png"));
    fs::remove_all(folder_ / "data");
    const Execution without = planned("");
    EXPECT_EQ(without.exitCode, 0);
    EXPECT_NE(without.output.find("warning: recorded frames not compared"), std::string::npos);
    EXPECT_FALSE(result_.contains("recorded_frames"));
    EXPECT_FALSE(has("recorded_frames.png"));
}

TEST_F(RecordedMap, WithoutGreyValuesItPlansWithoutViews) {
    const Execution run = planned(" --set map.file=" + path("map/map.bt"));
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_NE(run.output.find("map.bt: no cell of the map has a grey value"), std::string::npos);
    EXPECT_EQ(result_["views"], 0);
    EXPECT_FALSE(result_["path"].empty());
    EXPECT_FALSE(has("information.png"));
    EXPECT_TRUE(json::parse(std::ifstream(folder_ / "result" / "report.json"))["views"].empty());
}

TEST_F(CommandLine, InfoLooksAlongTheHeadingOfTheConfig) {
    const std::string command = "info " + config("two_textures") + " --cells 2 --out " +
                                folder_.string() + " --set start=[0,0,2,1.2] --at 5.5,4,2";
    ASSERT_EQ(photonav(command + " --set space=xyz").exitCode, 0);
    EXPECT_EQ(result()["view"]["yaw"], 1.2);
    ASSERT_EQ(photonav(command + ",0.3").exitCode, 0);
    EXPECT_EQ(result()["view"]["yaw"], 0.3);
}

TEST_F(CommandLine, InfoDrawsHeatMapsAndContributions) {
    const Execution run = photonav("info " + config("two_textures") +
                                   " --cells 12 --at 5.5,4,2 --out " + folder_.string());
    ASSERT_EQ(run.exitCode, 0) << run.output;
    for (const char* name : {"result.json", "config.yaml", "information.png", "uncertainty.png",
                             "view.png", "contribution.png", "contribution_right.png",
                             "contribution_about_forward.png", "report.html"}) {
        EXPECT_TRUE(fs::exists(folder_ / name)) << name;
    }
    const json r = result();
    EXPECT_GT(r["view"]["min_eigenvalue"].get<double>(), 0.);
    const auto& rows = r["grid"]["rows_from_smallest_y"];
    EXPECT_EQ(rows.front().front().get<double>(), 0.);  // white floor on the left
    EXPECT_GT(rows.front().back().get<double>(), 1e3);  // texture on the right
    EXPECT_EQ(rows.size(), 12U);
}

TEST_F(CommandLine, ReportIsRebuiltFromItsFolder) {
    ASSERT_EQ(plan(kQuickPlan).exitCode, 0);
    fs::remove(folder_ / "report.html");
    EXPECT_EQ(photonav("report " + folder_.string()).exitCode, 0);
    EXPECT_TRUE(fs::exists(folder_ / "report.html"));
    std::ofstream(folder_ / "report.json") << "{";
    EXPECT_EQ(photonav("report " + folder_.string()).exitCode, 2);
}

TEST_F(CommandLine, BadInputIsOneLineAndExitCodeTwo) {
    expectBadInput(plan("--set planner.alpha=1.5"), "planner.alpha: 1.5 is outside [0, 1]");
    expectBadInput(plan("--set planner.alhpa=1"), "did you mean 'alpha'");
    expectBadInput(plan("--set scene.file=nowhere.yaml"), "nowhere.yaml");
    expectBadInput(plan("--set goal=[50,0,2]"), "goal: outside the bounds");
    expectBadInput(plan("--set noise.initial=[-1,0,0,0,0,0]"), "negative variance");
    expectBadInput(plan("--set camera.hfov=0"), "camera.hfov");
    expectBadInput(plan("", "no_such_config"), "no such file");
    expectBadInput(plan("--no-such-flag"), "no-such-flag");
    expectBadInput(photonav("plan " + config("two_textures") + " --out \"\""), "--out");
    expectBadInput(photonav("map nowhere --out \"\""), "--out");
    expectBadInput(photonav("map " + config("room") + " --every 2"), "--every: not together");
    expectBadInput(photonav("plan"), "config");
    expectBadInput(photonav("fly-away"), "fly-away: no such command");
    expectBadInput(photonav("pln x.yaml"), "pln: no such command, did you mean 'plan'?");
    expectBadInput(photonav("--plan"), "--plan: no such option");
    expectBadInput(photonav(""), "subcommand");
    for (const char* command : {"plan", "sweep", "benchmark", "fly"}) {
        const Execution run = photonav(std::string(command) + " x.yaml --seed abc");
        expectBadInput(run, "photonav: --seed: ");
        expectBadInput(photonav(std::string(command) + " x.yaml --seed 0"), "photonav: --seed: ");
    }
    expectBadInput(photonav("plan --bar"), "--bar: no such option");
    expectBadInput(plan("--audits"), "--audits: no such option, did you mean '--audit'?");
    expectBadInput(photonav("keys planner.kap"), "did you mean 'planner.kappa'?");
    expectBadInput(photonav("report " + folder_.string()), "not a result folder of photonav");
    expectBadInput(
        photonav("info " + config("two_textures") + " --at 1,2 --out " + folder_.string()), "--at");
}

TEST_F(CommandLine, AStartInsideAnObstacleIsRefused) {
    expectBadInput(plan("--set bounds=[[-1,-0.5,0.1],[9,9.5,2]] --set start=[0,0,0.1]"),
                   "start: in collision: clearance");
}

TEST_F(CommandLine, AFolderThatCannotBeWrittenIsRefusedBeforeWork) {
    expectBadInput(photonav("plan " + config("two_textures") + " --out /proc/photonav"), "/proc");
}

TEST_F(CommandLine, OutputThatCannotBeWrittenIsNoSuccess) {
    const Execution run =
        execute(std::string("{ ") + PHOTONAV_BINARY + " --version > /dev/full; }");
    EXPECT_EQ(run.exitCode, 1);
    EXPECT_EQ(run.output, "photonav: standard output cannot be written\n");
}

TEST_F(CommandLine, CtrlCKeepsTheBestPathSoFar) {
    const std::string command = "timeout -s INT 3 " + std::string(PHOTONAV_BINARY) + " plan " +
                                config("two_textures") + " --set planner.vertices=1000000" +
                                " --set planner.view_pitch=0.5 --out " + folder_.string() +
                                " >/dev/null 2>&1";
    const int status = std::system((command + "; exit $?").c_str());  // NOLINT(cert-env33-c)
    EXPECT_EQ(WEXITSTATUS(status), 124);  // timeout's own: it sent the signal
    EXPECT_EQ(result()["status"], "interrupted");
    EXPECT_FALSE(result()["path"].empty());
}

/// The texture of this scene takes seconds.
TEST_F(CommandLine, CtrlCBeforeThereIsAResultEndsAtOnce) {
    fs::create_directories(folder_);
    const fs::path scene = folder_ / "scene.yaml";
    std::ofstream(scene)
        << "textures: [{name: a, type: noise, size: [99, 99], cells: [9, 8, 7, 6]}]\n"
           "planes: [{corner: [0, 0, 0], u: [9, 0, 0], v: [0, 9, 0], texture: a}]\n";
    const Stopwatch watch;
    const std::string command = std::string(PHOTONAV_BINARY) + " plan " + config("two_textures") +
                                " --set scene.file=" + scene.string() + " --out " +
                                (folder_ / "out").string() + " 2> " + (folder_ / "said").string();
    // SIGINT is bit 1 of the signals caught: a busy machine may take a second to come so far. On
    // a very busy one the signal was lost once: it is sent again, which a program that has ended
    // does not notice.
    const std::string interrupt =
        " & until [ $((0x$(sed -n 's/^SigCgt:[[:space:]]*//p' /proc/$!/status) & 2)) -ne 0 ]; "
        "do sleep 0.05; done; for i in 1 2 3; do sleep 0.3; kill -INT $! 2>/dev/null; done; wait "
        "$!";
    const int status = std::system((command + interrupt).c_str());  // NOLINT(cert-env33-c)
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_LT(watch.seconds(), 20.);
    EXPECT_EQ(test::contentOf(folder_ / "said"),
              "photonav: interrupted before there was any result\n");
    EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(CommandLine, HelpHasExamplesAndPages) {
    const Execution run = photonav("--help");
    EXPECT_EQ(run.exitCode, 0);
    for (const char* word : {"plan", "info", "map", "report", "Exit codes", "two_textures.yaml"}) {
        EXPECT_NE(run.output.find(word), std::string::npos) << word;
    }
}

TEST_F(CommandLine, HelpOfACommandIsAboutThatCommand) {
    for (const char* command : {"plan", "keys", "report", "fly"}) {
        const Execution run = photonav(std::string(command) + " --help");
        EXPECT_EQ(run.exitCode, 0);
        EXPECT_EQ(run.output.find("Exit codes"), std::string::npos) << run.output;
    }
}

TEST(KeysCommand, ListsThoseOfMapsAndReplaysAsDocumented) {
    const std::string page = test::contentOf(PHOTONAV_SOURCE_DIR "/docs/config.md");
    for (const auto& [of, key] : {std::pair("map", "min_range"), std::pair("scans", "scanner"),
                                  std::pair("replay", "max_width")}) {
        const Execution run = photonav(fmt::format("keys --of {}", of));
        EXPECT_EQ(run.exitCode, 0) << of;
        EXPECT_NE(run.output.find(fmt::format("| `{}` |", key)), std::string::npos) << run.output;
        EXPECT_NE(page.find(fmt::format("<!-- keys --of {} -->\n{}", of, run.output)),
                  std::string::npos)
            << "run scripts/update-docs --run build";
    }
    EXPECT_EQ(photonav("keys --of nothing").exitCode, 2);
}

/// What a shell offers for the words typed so far, the last one unfinished.
std::string completed(const std::string& words, const std::string& script) {
    return execute(fmt::format("bash -c 'source {0}; COMP_WORDS=({1}); "
                               "COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); compopt() {{ :; }}; "
                               "_photonav; echo \"${{COMPREPLY[*]}}\"'",
                               script, words))
        .output;
}

TEST(Completion, OffersCommandsOptionsAndKeys) {
    const test::TemporaryFolder folder;
    const Execution bash = photonav("completion bash");
    EXPECT_EQ(bash.exitCode, 0);
    const std::string script = folder.write("photonav.bash", bash.output);
    EXPECT_EQ(completed("photonav re", script), "replay reference report\n");
    EXPECT_EQ(completed("photonav plan --al", script), "--alpha\n");
    EXPECT_EQ(completed("photonav plan a.yaml --set planner.al", script), "planner.alpha=\n");
    EXPECT_EQ(completed("photonav plan " + folder.file("photonav.b"), script), script + "\n");
    const std::string zsh = photonav("completion zsh").output;
    EXPECT_TRUE(zsh.starts_with("#compdef photonav\n"));
    EXPECT_NE(zsh.find("*--alpha[1 the shortest path"), std::string::npos);
    EXPECT_EQ(photonav("completion fish").exitCode, 2);
}

TEST(Doctor, FindsNothingWrongHere) {
    const Execution run = photonav("doctor");
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_NE(run.output.find("ok        sample plan"), std::string::npos) << run.output;
}

TEST_F(CommandLine, HelpFitsIntoEightyColumns) {
    std::istringstream all(photonav("--help").output);
    std::vector<std::string> commands{""};
    for (std::string line; std::getline(all, line) && line != "Commands:";) {
    }
    for (std::string line; std::getline(all, line) && !line.empty();) {
        if (line.starts_with("  ") && line[2] != ' ') {
            commands.push_back(line.substr(2, line.find(' ', 2) - 2));
        }
    }
    EXPECT_GT(commands.size(), 10U);
    for (const std::string& command : commands) {
        const Execution help = photonav(command + " --help");
        EXPECT_EQ(help.exitCode, 0) << command;
        std::istringstream lines(help.output);
        for (std::string line; std::getline(lines, line);) {
            EXPECT_LE(line.size(), 80U) << command << ": " << line;
            EXPECT_FALSE(line.ends_with(' ')) << command << ": " << line;
        }
    }
}

}  // namespace
}  // namespace photonav
