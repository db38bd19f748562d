// SPDX-License-Identifier: BSD-3-Clause
#include "config/config.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "config/config_keys.hpp"
#include "io/error.hpp"
#include "io/yaml_reader.hpp"
#include "problem/world.hpp"
#include "reason_of.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

const std::string kTwoTextures = std::string(PHOTONAV_SOURCE_DIR) + "/config/two_textures.yaml";

/// The message of the InputError that loading gives, or "" when it gives none.
std::string complaint(const std::vector<std::string>& overrides,
                      const std::string& file = kTwoTextures) {
    try {
        loadConfig(file, overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

void expectComplaint(const std::string& override, const std::string& key,
                     const std::string& reason) {
    const std::string message = complaint({override});
    EXPECT_NE(message.find(key), std::string::npos) << override << " -> '" << message << "'";
    EXPECT_NE(message.find(reason), std::string::npos) << override << " -> '" << message << "'";
    EXPECT_EQ(message.find('\n'), std::string::npos) << "more than one line: " << message;
}

TEST(Config, EveryShippedConfigLoads) {
    for (const auto& entry : fs::directory_iterator(std::string(PHOTONAV_SOURCE_DIR) + "/config")) {
        if (entry.path().extension() != ".yaml") continue;
        EXPECT_NO_THROW(loadConfig(entry.path().string())) << entry.path();
    }
}

TEST(Config, ViewsThatNoFigureCanShowAreRefused) {
    const std::string reason = "camera.height: views of 32 x 8192 pixels: one side is more than 16";
    EXPECT_NE(complaint({"camera.width=32", "camera.height=8192"}).find(reason), std::string::npos);
    EXPECT_NE(complaint({"camera.width=8192", "camera.height=32"}).find("camera.height"),
              std::string::npos);
    EXPECT_EQ(complaint({"camera.width=512", "camera.height=32"}), "");
}

TEST(Config, WrittenConfigReadsBackTheSame) {
    const Config config =
        loadConfig(kTwoTextures, {"planner.alpha=0.35", "camera.mount=front45",
                                  "start=[0, 0, 2, 0.5]", "space=xyz_yaw",
                                  "noise.propagation=second", "planner.information=feature_count",
                                  "features.threshold=0.05", "planner.penalty_kappa=7"});
    const fs::path file = fs::temp_directory_path() / "photonav_config_round_trip.yaml";
    std::ofstream(file) << toYaml(config);
    const Config again = loadConfig(file.string());
    EXPECT_EQ(toYaml(again), toYaml(config));
    EXPECT_EQ(again.belief.alpha, 0.35);
    EXPECT_EQ(again.viewModel.name, "feature_count");
    EXPECT_EQ(again.viewModel.features.threshold, 0.05);
    EXPECT_EQ(again.viewModel.kappa, 7.);
    EXPECT_EQ(again.space, StateKind::positionYaw);
    EXPECT_EQ(again.belief.order, PropagationOrder::second);
    EXPECT_TRUE(again.camera.T_b_c().isApprox(config.camera.T_b_c()));
    fs::remove(file);
}

TEST(Config, PathsAreRelativeToTheFileOrOnTheCommandLineToTheFolderOne) {
    EXPECT_EQ(loadConfig(kTwoTextures).sceneFile,
              std::string(PHOTONAV_SOURCE_DIR) + "/config/scenes/two_textures.yaml");
    EXPECT_EQ(loadConfig(kTwoTextures, {"scene.file=here.yaml"}).sceneFile,
              (fs::current_path() / "here.yaml").string());
    for (const std::string quote : {"", "'", "\""}) {
        const std::string odd = "a #b/c: d.yaml";
        EXPECT_EQ(loadConfig(kTwoTextures, {"scene.file=" + quote + odd + quote}).sceneFile,
                  (fs::current_path() / odd).string());
    }
}

/// Tables of docs/config.md: what is asked for, and the rows.
std::vector<std::pair<std::vector<std::string>, std::string>> documentedTables() {
    std::ifstream file(PHOTONAV_SOURCE_DIR "/docs/config.md");
    std::vector<std::pair<std::vector<std::string>, std::string>> tables;
    bool isInside = false;
    for (std::string line; std::getline(file, line);) {
        constexpr std::string_view kMark = "<!-- keys ";
        if (line.starts_with(kMark) && !line.starts_with("<!-- keys --of ")) {
            std::istringstream names(line.substr(kMark.size(), line.find(" -->") - kMark.size()));
            tables.push_back({{std::istream_iterator<std::string>(names), {}}, ""});
            isInside = true;
        } else if (isInside && line.starts_with('|')) {
            tables.back().second += line + "\n";
        } else {
            isInside = false;
        }
    }
    return tables;
}

TEST(Config, TheReferenceFollowsTheTable) {
    Config config;
    const KeyTable keys = keysOf(config);
    std::string all;
    for (const auto& [names, rows] : documentedTables()) {
        EXPECT_EQ(rows, keys.toMarkdown(names)) << "run scripts/update-docs --run build";
        all += rows;
    }
    for (const ConfigKey& key : keys.keys()) {
        EXPECT_NE(all.find("| `" + key.path() + "` |"), std::string::npos) << key.path();
    }
}

TEST(Config, AKeyIsSetAsTyped) {
    FlyConfig fly;
    KeyTable keys;
    addKeys(keys, fly);
    keys.find("fly.speed")->set("2.5");
    keys.find("fly.map")->set("a #b.ot");
    std::string frames;
    keys.text({"frames", "", ""}, frames);
    keys.keys().back().set("12:");  // a mapping in YAML
    EXPECT_EQ(frames, "12:");
    EXPECT_EQ(fly.speed, 2.5);
    EXPECT_EQ(fly.map, "a #b.ot");
    EXPECT_NE(keys.find("fly.speed")->description().find("[m/s] (default: 2.5)"),
              std::string::npos);
    EXPECT_THROW(keys.find("fly.speed")->set("fast"), InputError);
    EXPECT_THROW(keys.find("fly.speed")->set("-1"), InputError);
    EXPECT_EQ(keys.find("fly.sped"), nullptr);
}

TEST(Config, EveryKeyReadsBackWhatItWrote) {
    const Config config =
        loadConfig(kTwoTextures, {"fly.plan=a", "fly.map=b", "fly.scale=2", "fly.least_sigma=0",
                                  "fly.least_sigma_rotation=0.5", "fly.blackout=[1, 2]",
                                  "map.made_by=make it", "explore.resolution=0.05",
                                  "sweep.paper=[{alpha: 0.5, length: 1, "
                                  "mean_trace: 2, goal_trace: 3}]"});
    Config again;
    const KeyTable keys = keysOf(again);
    YamlMap root("again", YAML::Load(toYaml(config)));
    keys.read(root);
    Config copy = config;
    const KeyTable written = keysOf(copy);
    for (const ConfigKey& key : written.keys()) {
        EXPECT_EQ(YAML::Dump(keys.find(key.path())->value()), YAML::Dump(key.value()))
            << key.path();
        const bool isOfMap = key.path() == "map.file";
        EXPECT_EQ(key.value().IsNull(), isOfMap) << key.path();
    }
}

TEST(Config, MountsAreWordsOrDegrees) {
    const auto axis = [](const std::string& mount) {
        const Config config = loadConfig(kTwoTextures, {"camera.mount=" + mount});
        return Eigen::Vector3d(config.camera.T_b_c().linear().col(2));  // optical axis in the body
    };
    EXPECT_TRUE(axis("down").isApprox(Eigen::Vector3d(0, 0, -1), 1e-12));
    EXPECT_TRUE(axis("forward").isApprox(Eigen::Vector3d(1, 0, 0), 1e-12));
    EXPECT_TRUE(axis("front45").isApprox(axis("45"), 1e-12));
    EXPECT_NEAR(axis("30").z(), -0.5, 1e-12);
}

TEST(Config, ComplaintsNameKeyAndReason) {
    expectComplaint("planner.alhpa=0.5", "planner.alhpa", "did you mean 'planner.alpha'");
    expectComplaint("planer.alpha=0.5", "planer", "did you mean 'planner'");
    expectComplaint("planner.alpha=1.5", "planner.alpha", "outside [0, 1]");
    expectComplaint("planner.alpha=.nan", "planner.alpha", "outside [0, 1]");
    expectComplaint("planner.alpha=much", "planner.alpha", "'much'");
    expectComplaint("planner.name=rrt", "planner.name", "pa_rrt_star, rrbt, rrt_star");
    expectComplaint("planner.information=sift", "planner.information", "feature_count");
    expectComplaint("features.threshold=2", "features.threshold", "outside");
    expectComplaint("features.treshold=0.1", "features.treshold",
                    "did you mean 'features.threshold'");
    expectComplaint("planner.penalty_kappa=-1", "planner.penalty_kappa", "outside");
    expectComplaint("planner.vertices=2.5", "planner.vertices", "whole number");
    expectComplaint("planner.ds=0", "planner.ds", "outside");
    const std::vector<std::string> far{"planner.ds=0.001", "goal=[30, 9, 2]",
                                       "bounds=[[0, 0, 2], [30, 9, 2]]"};
    EXPECT_NE(complaint(far).find("3.13e+04 steps from start"), std::string::npos);
    expectComplaint("planner.view_pitch=1.5", "planner.view_pitch", "outside");
    expectComplaint("planner.view_rotation_pitch=0.6", "planner.view_rotation_pitch", "outside");
    expectComplaint("noise.initial=[-1, 0, 0, 0, 0, 0]", "noise.initial", "negative variance");
    expectComplaint("noise.motion=[0, 0, 0, 0, 0, 11]", "noise.motion", "above 100 m^2");
    expectComplaint("noise.motion=[0, 0, 2e6, 0, 0, 0]", "noise.motion", "10 rad^2 (rotation");
    expectComplaint("sweep.planners=[,,,]", "sweep.planners", "cannot read the value");
    expectComplaint("noise.motion=[1, 0, 0]", "noise.motion", "6 numbers, found 3");
    expectComplaint("noise.motion=[.nan, 0, 0, 0, 0, 0]", "noise.motion", "finite");
    expectComplaint("camera.hfov=0", "camera.hfov", "outside [1, 170]");
    expectComplaint("camera.width=0", "camera.width", "outside");
    expectComplaint("camera.mount=sideways", "camera.mount", "'sideways'");
    expectComplaint("goal=[2, 90, 2]", "goal", "outside the bounds");
    expectComplaint("start=[2, 9]", "start", "3 to 4 numbers, found 2");
    expectComplaint("bounds=[[1, 1, 1], [0, 0, 0]]", "bounds", "lower");
    expectComplaint("bounds=3", "bounds", "3");
    expectComplaint("seed=0", "seed", "outside");
    expectComplaint("seed=1.5", "seed", "whole number");
    expectComplaint("camera.width=188.5", "camera.width", "whole number");
    expectComplaint("goal=[2, 9, 2, 1]", "goal", "xyz_yaw");
    expectComplaint("scene.file=", "scene.file", "give scene.file or map.file");
    expectComplaint("goal=[2, 9, 2][2, 9, 2]", "goal", "cannot read the value");
    expectComplaint("goal=[2, 9, 2]\nseed: 5", "goal", "cannot read the value");
    expectComplaint("noequals", "noequals", "key.path=value");
}

TEST(Config, ComplaintsSayWhereAValueWasGiven) {
    EXPECT_TRUE(complaint({"seed=2", "planner.alpha=1.5"})
                    .starts_with("command line: planner.alpha: 1.5 is outside [0, 1]"));
    EXPECT_TRUE(complaint({"planner.alhpa=1"}).starts_with("command line: planner.alhpa: unknown"));
    const fs::path file = fs::temp_directory_path() / "photonav_config_of_file.yaml";
    std::ofstream(file) << "bounds: [[0, 0, 0], [1, 1, 1]]\nplanner: {alpha: 7}\n";
    EXPECT_TRUE(
        complaint({"planner.alphas=1", "seed=2"}, file.string()).starts_with(file.string() + ": "));
    fs::remove(file);
}

/// Whether a value can be used often shows only when the world is there.
TEST(Config, ComplaintsOfOthersSayWhereAValueWasGiven) {
    const std::string file = PHOTONAV_SOURCE_DIR "/config/two_textures.yaml";
    const Config config = loadConfig(file, {"goal=[2, 9, 2]", "scene.file=nowhere.yaml"});
    const auto complaintAbout = [&](const char* key) {
        return std::string(config.invalid(key, "bad").what());
    };
    EXPECT_EQ(complaintAbout("goal"), file + ", changed on the command line: goal: bad");
    EXPECT_EQ(complaintAbout("scene"), file + ", changed on the command line: scene: bad");
    EXPECT_EQ(complaintAbout("start"), file + ": start: bad");
    const Config section = loadConfig(file, {"explore={resolution: 0.2}"});
    EXPECT_STREQ(section.invalid("explore.resolution", "bad").what(),
                 (file + ", changed on the command line: explore.resolution: bad").c_str());
}

TEST(Config, AMapThatIsNotThereYetIsMadeBySomething) {
    const std::vector<std::string> room{"map.file=no #1: nowhere.ot",
                                        "map.made_by=scripts/make it"};
    const Config config = loadConfig(PHOTONAV_SOURCE_DIR "/config/scan_room_1.yaml", room);
    EXPECT_NE(toYaml(config).find("made_by: scripts/make it"), std::string::npos);
    const fs::path file = fs::temp_directory_path() / "photonav_config_of_map.yaml";
    std::ofstream(file) << toYaml(config);
    EXPECT_EQ(loadConfig(file.string()).mapFile, (fs::current_path() / "no #1: nowhere.ot"));
    fs::remove(file);
    try {
        const World world(config);
        ADD_FAILURE() << "nothing was thrown";
    } catch (const InputError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("scan_room_1.yaml, changed on the command line: map.file: "),
                  std::string::npos)
            << text;
        EXPECT_NE(text.find("nowhere.ot: not there; this config's map is made by scripts/make it"),
                  std::string::npos)
            << text;
    }
}

TEST(Config, ComplaintsAboutTheFileItself) {
    const char* kRest =
        "scene: {file: a.yaml}\nbounds: [[0,0,0],[1,1,1]]\nstart: [0,0,0]\ngoal: [1,1,1]\n";
    EXPECT_NE(complaint({}, "nowhere.yaml").find("nowhere.yaml: no such file"), std::string::npos);
    const fs::path file = fs::temp_directory_path() / "photonav_config_broken.yaml";
    std::ofstream(file) << "planner: [unclosed\n";
    EXPECT_NE(complaint({}, file.string()).find("line"), std::string::npos);
    std::ofstream(file) << "seed: 1\nrobot: {radius: 1, radius: 2}\n" << kRest;
    EXPECT_NE(complaint({}, file.string()).find("robot.radius: is there twice"), std::string::npos);
    std::ofstream(file) << "seed: 1\nseed: 2\n" << kRest;
    EXPECT_NE(complaint({}, file.string()).find("seed: is there twice"), std::string::npos);
    std::ofstream(file) << "planner: {ds: 1}\nplanner: {}\n" << kRest;
    EXPECT_TRUE(complaint({"planner.ds=1"}, file.string()).starts_with(file.string()));
    std::ofstream(file) << "map: {file: \"a.ot\\0.old\"}\n" << kRest;
    EXPECT_NE(complaint({}, file.string()).find("map.file: holds a zero byte"), std::string::npos);
    std::ofstream(file) << "just a word\n";
    EXPECT_NE(complaint({}, file.string()).find("key: value"), std::string::npos);
    EXPECT_TRUE(complaint({"planner.ds=1"}, file.string()).starts_with(file.string()));
    fs::remove(file);
}

TEST(Config, KappaIsANumberOrAutomatic) {
    EXPECT_EQ(loadConfig(kTwoTextures).belief.kappa, 2.5);
    const Config automatic = loadConfig(kTwoTextures, {"planner.kappa=auto"});
    EXPECT_TRUE(isAutomatic(automatic.belief.kappa));
    EXPECT_NE(toYaml(automatic).find("kappa: auto"), std::string::npos);
    EXPECT_TRUE(isAutomatic(Config().belief.kappa));
    expectComplaint("planner.kappa=automatic", "planner.kappa", "cannot read");
    expectComplaint("planner.kappa=-1", "planner.kappa", "outside");
    expectComplaint("planner.kappa=.nan", "planner.kappa", "outside");
}

/// Who types a key without its section, or in a wrong one, learns where it belongs.
TEST(Config, AKeyInTheWrongPlaceIsNamedWithItsPath) {
    expectComplaint("alpha=0.3", "alpha", "did you mean 'planner.alpha'?");
    expectComplaint("planner.hfov=60", "planner.hfov", "did you mean 'camera.hfov'?");
    expectComplaint("planner.seed=3", "planner.seed", "did you mean 'seed'?");
    expectComplaint("alhpa=0.3", "alhpa", "did you mean 'planner.alpha'?");
    expectComplaint("vertces=3", "vertces",
                    "did you mean 'planner.vertices' or 'explore.vertices'?");
    expectComplaint("planner.hfvo=60", "planner.hfvo", "did you mean 'camera.hfov'?");
    expectComplaint("qqqqqqqq=1", "qqqqqqqq", "unknown key; known: ");
}

TEST(Config, TextIsReadAsAFileIs) {
    const std::string text =
        "scene: {file: a.yaml}\nbounds: [[0, 0, 0], [9, 9, 1]]\n"
        "start: [1, 1, 1]\ngoal: [8, 8, 1]\n";
    const Config config = parseConfig(text, "/somewhere/given", {"planner.alpha=0.4"});
    EXPECT_EQ(config.sceneFile, "/somewhere/a.yaml");
    EXPECT_EQ(config.belief.alpha, 0.4);
    EXPECT_EQ(config.goal.position, Eigen::Vector3d(8., 8., 1.));
    EXPECT_EQ(test::reasonOf([&] { parseConfig("start: [1", "given"); }).substr(0, 7), "given: ");
    EXPECT_NE(test::reasonOf([&] {
                  parseConfig(text + "gaol: 1\n", "given");
              }).find("given: gaol: unknown key, did you mean 'goal'?"),
              std::string::npos);
}

}  // namespace
}  // namespace photonav
