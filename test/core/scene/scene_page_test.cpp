// SPDX-License-Identifier: BSD-3-Clause
// docs/scenes.md is complete: its examples load, and hold every key that the reader knows.
#include <gtest/gtest.h>
#include <regex.h>

#include <array>
#include <cctype>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <sstream>

#include "scene/scene_yaml.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

std::string textOf(const std::string& file) {
    return test::contentOf(PHOTONAV_SOURCE_DIR "/" + file);
}

/// The keys that the reader of scenes asks for: the strings that begin, or follow the first word
/// in, the arguments of its functions. (POSIX, as GCC warns of std::regex with sanitizers.)
std::vector<std::string> keysOfTheReader() {
    const std::string source = textOf("src/scene/scene_yaml.cpp");
    regex_t regex;
    const char* const call =
        R"re((read[A-Za-z]*|list|requireVector|textureNamed)\(([A-Za-z_]+, )?"([A-Za-z_]+)")re";
    if (regcomp(&regex, call, REG_EXTENDED) != 0) throw std::logic_error("not an expression");
    std::vector<std::string> keys;
    std::array<regmatch_t, 4> match{};
    for (const char* at = source.c_str(); regexec(&regex, at, 4, match.data(), 0) == 0;
         at += match[0].rm_eo) {
        keys.emplace_back(at + match[3].rm_so, at + match[3].rm_eo);
    }
    regfree(&regex);
    return keys;
}

/// Whether a text has the key, as a word of its own.
bool hasKey(const std::string& yaml, const std::string& key) {
    for (std::size_t at = yaml.find(key + ':'); at != std::string::npos;
         at = yaml.find(key + ':', at + 1)) {
        if (at == 0 || (std::isalnum(yaml[at - 1]) == 0 && yaml[at - 1] != '_')) return true;
    }
    return false;
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
    const std::vector<std::string> keys = keysOfTheReader();
    EXPECT_GE(std::set<std::string>(keys.begin(), keys.end()).size(), 30U);
    for (const std::string& key : keys) {
        EXPECT_TRUE(hasKey(scenes, key)) << key;
        EXPECT_NE(page.find('`' + key + '`'), std::string::npos) << key;
    }
}

}  // namespace
}  // namespace photonav
