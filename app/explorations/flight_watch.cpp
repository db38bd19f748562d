// SPDX-License-Identifier: BSD-3-Clause
#include "explorations/flight_watch.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "io/atomic_file.hpp"

namespace photonav {
namespace fs = std::filesystem;
void FlightWatch::serve(const ServerAddress& address, std::string page) {
    server_ = std::make_unique<LiveServer>(address, std::move(page));
    fmt::print(stderr, "photonav: watch the flight at {}\n", server_->url());
}

std::size_t FlightWatch::storeIn(std::unique_ptr<FlightStore> store) {
    store_ = std::move(store);
    return store_->earlier();
}

OnExplorationMoment FlightWatch::onMoment() {
    return [this](const ExplorationMoment& moment) {
        logger_.add(moment);
        if (store_ && !interrupted_) store_->add(moment, log());
        if (server_) server_->publish("moment", momentJson(log(), log().moments.back()).dump());
    };
}

void FlightWatch::finish(const ExplorationResult& flight, const fs::path& folder) {
    logger_.finish(flight);
    writeFlightLog(folder, log());
    if (server_) server_->publish("end", endJson(log()).dump());
}

std::optional<FlightLog> readFlightLog(const fs::path& folder, const TrialItem& item) {
    const fs::path file = folder / FlightLog::kFileName;
    if (!fs::exists(file)) return {};
    FlightLog log = readFlightLog(file);
    if (TrialItem{log.planner, log.seed} != item) return {};
    return log;
}

void writeFlightLog(const fs::path& folder, const FlightLog& log) {
    writeFileAtomically(folder / FlightLog::kFileName, flightLogJson(log).dump());
}

}  // namespace photonav
