// SPDX-License-Identifier: BSD-3-Clause
// A recorded flight in a folder, and the scene it was flown in.
#pragma once

#include <nlohmann/json.hpp>

#include "flight_dataset.hpp"
#include "replay/replay.hpp"
#include "replay/replay_result.hpp"
#include "replay/replay_tables.hpp"

namespace photonav::test {

class ReplayFixture : public testing::Test {
  protected:
    ReplayFixture() {
        flight.write(data);
        writeText(folder.path() / "room.yaml", kScene);
        options.dataset = data.string();
        options.odometry = true;
    }

    void useMap() {
        options.odometry = false;
        options.mapFile = (folder.path() / "room.yaml").string();
    }

    /// Numbers of a replay, which stays in `replayed`.
    nlohmann::json run() {
        const Replay replay(options);
        replayed = replay.run();
        return replayResult(replay.recording().sequence, replayed, evaluate(replayed));
    }
    Trajectory estimate() const { return meansOf(beliefsOf(replayed)); }

    void expectRejected(const std::vector<std::string>& parts) {
        expectInputError([&] { run(); }, parts);
    }
    void blacken(int i) const { flight.blacken(data, i); }

    FlightDataset flight;
    TemporaryFolder folder;
    fs::path data = folder.path() / "flight";
    ReplayOptions options;
    ReplayRun replayed;
};

}  // namespace photonav::test
