// SPDX-License-Identifier: BSD-3-Clause
#include "explorations/flight_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "exploration/trial_journal.hpp"
#include "io/atomic_file.hpp"
#include "map/octree_file.hpp"
#include "problem/tree_evolution.hpp"
#include "replanning/plan_update_json.hpp"
#include "result/json_values.hpp"
#include "shared/command_io.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr double kMapShare = 0.1, kPageShare = 0.05;  // of the time

/// A moment with the planner's tree, also if the log has left it out.
json lineOf(const FlightLog& log, LoggedMoment moment, const BeliefPlanner& planner) {
    if (moment.pictures.tree.empty()) moment.pictures.tree = drawnEdges(planner);
    return momentJson(log, moment);
}

}  // namespace

void LimitedShare::call(const std::function<void()>& work) {
    if (took_ > share_ * since_.seconds()) return;
    const Stopwatch watch;
    work();
    took_ = watch.seconds();
    since_ = {};
}

FlightStore::FlightStore(fs::path folder, JournalHeader header, Page page)
    : folder_(std::move(folder)),
      header_(std::move(header)),
      page_(std::move(page)),
      file_(folder_, kWords),
      map_(kMapShare),
      shown_(kPageShare) {
    if (fs::exists(file_.path())) {
        const auto onLine = [&](const json& line) { earlier_.push_back(line.at("update")); };
        if (file_.read(onLine).name == header_.name) return;
        earlier_.clear();
    }
    file_.create(header_);
}

void FlightStore::add(const ExplorationMoment& moment, const FlightLog& log) {
    const std::size_t number = log.moments.size() - 1;
    if (isStored(log.moments.back(), number)) return;
    if (number < earlier_.size()) {
        printMessage(
            fmt::format("warning: {}: from {:.1f} s on not the flight that was killed, as may "
                        "be on another processor",
                        header_.name, log.moments.back().update.time));
        earlier_.clear();
        std::vector<json> lines;
        for (std::size_t i = 0; i < number; ++i) lines.push_back(momentJson(log, log.moments[i]));
        file_.create(header_, lines);
    }
    file_.append(lineOf(log, log.moments.back(), moment.planner.planner()));
    map_.call([&] { saveTexturedOcTree(*moment.map.cells(), folder_ / TrialKind::kMapFile); });
    shown_.call([&] { writeFileAtomically(folder_ / "report.html", page_(log)); });
}

/// Whether a killed program has stored the same update.
bool FlightStore::isStored(const LoggedMoment& moment, std::size_t number) {
    if (number >= earlier_.size()) return false;
    const json now = untimedJson(moment.update);
    const json& before = earlier_[number];
    return std::all_of(now.items().begin(), now.items().end(), [&](const auto& entry) {
        return before.contains(entry.key()) && before[entry.key()] == entry.value();
    });
}

void FlightStore::remove() { fs::remove(file_.path()); }

StoredFlight storedFlight(const fs::path& folder) {
    JournalFile file(folder, FlightStore::kWords);
    StoredFlight stored;
    if (fs::exists(file.path())) {
        stored.name = file.read([&](const json&) { ++stored.keyframes; }).name;
    }
    return stored;
}

}  // namespace photonav
