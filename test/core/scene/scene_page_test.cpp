// SPDX-License-Identifier: BSD-3-Clause
// docs/scenes.md is complete: its examples load, and hold every key that the reader knows.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "scene/scene_yaml.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

std::string textOf(const std::string& file) {
    return test::contentOf(PHOTONAV_SOURCE_DIR "/" + file);
}

/// The first group of every match.
std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
    const std::regex regex(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator i(text.begin(), text.end(), regex), end; i != end; ++i) {
        found.push_back((*i)[1]);
    }
    return found;
}

/// The scenes of the page: YAML blocks that have surfaces.
std::vector<std::string> examples() {
    std::vector<std::string> scenes;
    std::istringstream page(textOf("docs/scenes.md"));
    std::string block;
    bool isInside = false;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("```")) {
            if (isInside && block.find("textures:") != std::string::npos) scenes.push_back(block);
            isInside = line == "```yaml";
            block.clear();
        } else if (isInside) {
            block += line + '\n';
        }
    }
    return scenes;
}

TEST(ScenePage, ExamplesAreScenes) {
    const test::TemporaryFolder folder;
    cv::imwrite(folder.file("poster.png"), cv::Mat(8, 16, CV_8UC1, cv::Scalar(99)));
    const auto scenes = examples();
    EXPECT_GE(scenes.size(), 3U);
    for (const std::string& scene : scenes) {
        const std::string file = folder.write("scene.yaml", scene);
        EXPECT_NO_THROW(EXPECT_FALSE(loadSceneYaml(file).triangles.empty())) << scene;
    }
}

TEST(ScenePage, ExamplesAndTablesHaveEveryKey) {
    const std::string page = textOf("docs/scenes.md");
    std::string scenes;
    for (const std::string& scene : examples()) scenes += scene;
    const auto keys =
        matches(textOf("src/scene/scene_yaml.cpp"),
                R"re((?:read\w*|list|requireVector|textureNamed)\((?:\w+, )?"(\w+)")re");
    EXPECT_GE(std::set<std::string>(keys.begin(), keys.end()).size(), 30U);
    for (const std::string& key : keys) {
        EXPECT_TRUE(std::regex_search(scenes, std::regex("\\b" + key + ":"))) << key;
        EXPECT_NE(page.find('`' + key + '`'), std::string::npos) << key;
    }
}

}  // namespace
}  // namespace photonav
