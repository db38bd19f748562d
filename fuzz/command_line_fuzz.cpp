// SPDX-License-Identifier: BSD-3-Clause
// What is typed: overrides of a config, options that are keys, numbers and lists of numbers.
#include "config/config.hpp"
#include "fuzz_input.hpp"
#include "mapping/map_config.hpp"
#include "recording/recording.hpp"
#include "replay/replay_config.hpp"
#include "sweep/sweep_plan.hpp"

namespace {

using namespace photonav;
using fuzz::require;

/// A config whose keys are overridden, one by each part of the text.
void override(std::string_view text) {
    static const std::string file =
        fuzz::write("config.yaml",
                    "{bounds: [[0, 0, 2], [9, 9, 2]], start: [0, 0, 2], goal: [2, 9, 2], "
                    "scene: {file: a.yaml}}");
    std::vector<std::string> overrides;
    do {
        overrides.emplace_back(fuzz::takePart(text));
    } while (!text.empty());
    loadConfig(file, overrides);
}

/// "name=value" as an option of map or replay.
void setKey(const KeyTable& keys, const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const ConfigKey* key = keys.find(text.substr(0, equals));
    if (key != nullptr) key->set(text.substr(std::min(equals + 1, text.size())));
}

void setKeys(const std::string& text) {
    MapOptions map;
    ScanMapOptions scans;
    ReplayOptions replay;
    setKey(keysOf(map), text);
    setKey(keysOf(scans), text);
    KeyTable keys;
    addKeys(keys, replay);
    setKey(keys, text);
}

void parseShardAndFrames(const std::string& text) {
    if (text.find('/') != std::string::npos) {
        const Shard shard = parseShard(text);
        require(shard.index >= 1 && shard.index <= shard.count, "a shard is one of all");
    } else {
        const auto [first, end] = parseFrames(text, 100);
        require(text.empty() || (first < end && end <= 100), "frames are some of all");
    }
}

void parseNumbers(const std::string& text) {
    const auto up = parseUp(text);
    require(!up || std::abs(up->norm() - 1.) < 1e-9, "a direction is of length 1");
    for (const double alpha : parseAlphas(text)) require(std::isfinite(alpha), "alphas are finite");
}

}  // namespace

void photonav::fuzz::run(std::string_view input) {
    const unsigned choice = takeChoice(input, 4);
    const std::string text(input);
    check([&] {
        if (choice == 0) override(text);
        if (choice == 1) setKeys(text);
        if (choice == 2) parseShardAndFrames(text);
        if (choice == 3) parseNumbers(text);
    });
}
