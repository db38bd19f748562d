// SPDX-License-Identifier: BSD-3-Clause
// Calibration files, and the configs of maps and replays.
#include "fuzz_input.hpp"
#include "mapping/map_config.hpp"
#include "replay/calibration_file.hpp"
#include "replay/replay_config.hpp"

namespace {

using namespace photonav;

template <typename Options>
void readKeys(Options& options, const std::string& file) {
    KeyTable keys;
    if constexpr (std::is_same_v<Options, ReplayOptions>)
        addKeys(keys, options);
    else
        keys = keysOf(options);
    keys.read(file);
    fuzz::write("again.yaml", keys.toYaml());
}

}  // namespace

void photonav::fuzz::run(std::string_view input) {
    const unsigned choice = takeChoice(input, 5);
    const std::string file = write("options.yaml", input);
    check([&] {
        MapOptions map;
        ScanMapOptions scans;
        ReplayOptions replay;
        if (choice < 2)
            readCalibration(file, choice == 0 ? std::nullopt : std::optional(MapKind::cells));
        if (choice == 2) readKeys(map, file);
        if (choice == 3) readKeys(scans, file);
        if (choice == 4) readKeys(replay, file);
    });
}
