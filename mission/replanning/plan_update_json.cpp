// SPDX-License-Identifier: BSD-3-Clause
#include "replanning/plan_update_json.hpp"

#include <stdexcept>

#include "geometry/constants.hpp"
#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;

json untimedJson(const PlanUpdate& u) {
    return {{"time", u.time},
            {"vertices_invalidated", u.counts.verticesInvalidated},
            {"edges_invalidated", u.counts.edgesInvalidated},
            {"vertices_added", u.counts.verticesAdded},
            {"vertices_rewired", u.counts.verticesRewired},
            {"views_marked", u.viewsMarked},
            {"views_rendered", u.viewsRendered},
            {"cost", finiteOrNull(u.cost)},
            {"length", finiteOrNull(u.length)},
            {"trace", finiteOrNull(u.trace)}};
}

json lineOf(const PlanUpdate& update) {
    json line = untimedJson(update);
    line["fuse_s"] = update.fuseSeconds;
    line["clearance_s"] = update.clearanceSeconds;
    line["views_s"] = update.viewSeconds;
    line["plan_s"] = update.planSeconds;
    return line;
}

PlanUpdate planUpdateFrom(const json& line) {
    const auto count = [&](const char* key) { return wholeNumber<std::size_t>(line.at(key)); };
    return {.time = nonNegative(line, "time"),
            .counts = {.verticesInvalidated = count("vertices_invalidated"),
                       .edgesInvalidated = count("edges_invalidated"),
                       .verticesAdded = count("vertices_added"),
                       .verticesRewired = count("vertices_rewired")},
            .viewsMarked = count("views_marked"),
            .viewsRendered = count("views_rendered"),
            .fuseSeconds = nonNegative(line, "fuse_s"),
            .clearanceSeconds = nonNegative(line, "clearance_s"),
            .viewSeconds = nonNegative(line, "views_s"),
            .planSeconds = nonNegative(line, "plan_s"),
            .cost = numberOrNone(line, "cost"),
            .length = numberOrNone(line, "length"),
            .trace = numberOrNone(line, "trace")};
}

}  // namespace photonav
