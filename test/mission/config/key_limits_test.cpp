// SPDX-License-Identifier: BSD-3-Clause
// Whatever is given for a key is refused in one line that names it, or is a value that the key can
// hold: written, it is read again as the same, and its numbers are finite.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "config/config_keys.hpp"
#include "io/error.hpp"
#include "io/number.hpp"
#include "mapping/map_config.hpp"
#include "replay/replay_config.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using test::TemporaryFolder;

const std::vector<std::string> kValues{"nan",
                                       ".nan",
                                       "inf",
                                       ".inf",
                                       "-.inf",
                                       "1e308",
                                       "-1e308",
                                       "1e-320",
                                       "-1",
                                       "1e9",
                                       "0x7f",
                                       "1,5",
                                       "''",
                                       "~",
                                       "[]",
                                       "[1]",
                                       "{}",
                                       "[[]]",
                                       "[.nan, 1]",
                                       "{a: 1}",
                                       "[1e308, -1e308, 1e308]",
                                       "true",
                                       "99999999999999999999",
                                       "[.inf, 0, 0, 0, 0, 0]",
                                       "[1e308, 1e308, 1e308, 1e308, 1e308, 1e308]",
                                       "[0, 0, 2, 1e308]"};

/// The numbers in a value; words are none.
void expectFinite(const YAML::Node& node, const std::string& what) {
    if (node.IsSequence()) {
        for (const auto& entry : node) expectFinite(entry, what);
    } else if (node.IsScalar()) {
        const auto number = numberIn(node.Scalar());
        EXPECT_TRUE(!number || std::isfinite(*number)) << what << ": " << node.Scalar();
    }
}

/// Tries each value for each key of a table.
/// @param load a file, into a table whose values outlive the call
void tryAll(const std::string& valid, const std::function<KeyTable(const std::string&)>& load) {
    const TemporaryFolder folder;
    const KeyTable keys = load(folder.write("valid.yaml", valid));
    ASSERT_GT(keys.keys().size(), 3U);
    for (const ConfigKey& key : keys.keys()) {
        for (const std::string& value : kValues) {
            const std::string what = key.path() + ": " + value;
            if (key.isText && value == "''") continue;  // no text: as if it were not given
            YAML::Node root = YAML::Load(valid);
            YAML::Node section = key.section.empty() ? root : root[key.section];
            section[key.words.name] = YAML::Load(value);
            const auto file = folder.write("given.yaml", YAML::Dump(root));
            try {
                const KeyTable given = load(file);
                const ConfigKey* again = given.find(key.path());
                if (!again->isText && !again->isFile) expectFinite(again->value(), what);
                const std::string text = given.toYaml();
                EXPECT_EQ(load(folder.write("again.yaml", text)).toYaml(), text) << what;
            } catch (const InputError& error) {
                EXPECT_NE(error.reason().find(key.words.name), std::string::npos)
                    << what << " -> " << error.what();
            }
        }
    }
}

TEST(KeyLimits, PlanningProblems) {
    const std::string file = PHOTONAV_SOURCE_DIR "/config/two_textures.yaml";
    Config config;
    tryAll(toYaml(loadConfig(file, {})), [&](const std::string& given) {
        config = loadConfig(given, {});
        return keysOf(config);
    });
}

template <typename Options>
void tryKeysOf(const std::string& valid, KeyTable (*keysOf)(Options&)) {
    Options options;
    tryAll(valid, [&](const std::string& given) {
        options = Options();
        KeyTable keys = keysOf(options);
        keys.read(given);
        return keys;
    });
}

TEST(KeyLimits, MapsAndReplays) {
    tryKeysOf<MapOptions>("dataset: recording\n", &keysOf);
    tryKeysOf<ScanMapOptions>("scans: room.ply\nresolution: 0.05\n", &keysOf);
    tryKeysOf<ReplayOptions>(
        "dataset: recording\nodometry: true\n", +[](ReplayOptions& options) {
            KeyTable keys;
            addKeys(keys, options);
            return keys;
        });
}

}  // namespace
}  // namespace photonav
