// SPDX-License-Identifier: BSD-3-Clause
#include "explorations/flight_watch.hpp"

#include <fmt/format.h>

#include "io/atomic_file.hpp"
#include "result/json_values.hpp"
#include "shared/command_io.hpp"

namespace photonav {
namespace fs = std::filesystem;
void FlightWatch::serve(const ServerAddress& address, std::string page) {
    server_ = std::make_unique<LiveServer>(address, std::move(page));
    printMessage(fmt::format("watch the flight at {}", server_->url()));
}

std::size_t FlightWatch::storeIn(std::unique_ptr<FlightStore> store) {
    store_ = std::move(store);
    return store_->earlier();
}

OnExplorationMoment FlightWatch::onMoment() {
    return [this](const ExplorationMoment& moment) {
        logger_.add(moment);
        if (store_ && !interrupted_) store_->add(moment, log());
        if (server_)
            server_->publish("moment", compactJson(momentJson(log(), log().moments.back())));
    };
}

void FlightWatch::finish(const ExplorationResult& flight, const fs::path& folder) {
    logger_.finish(flight);
    writeFlightLog(folder, log());
    if (server_) server_->publish("end", compactJson(endJson(log())));
}

std::optional<FlightLog> readFlightLog(const fs::path& folder, const TrialItem& item) {
    const fs::path file = folder / FlightLog::kFileName;
    if (!fs::exists(file)) return {};
    FlightLog log = readFlightLog(file);
    if (TrialItem{log.planner, log.seed} != item) return {};
    return log;
}

void writeFlightLog(const fs::path& folder, const FlightLog& log) {
    writeFileAtomically(folder / FlightLog::kFileName, compactJson(flightLogJson(log)));
}

}  // namespace photonav
