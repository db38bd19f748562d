// SPDX-License-Identifier: BSD-3-Clause
#include "planners/planner_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "planners/perception_rrt_star.hpp"
#include "planners/rrbt.hpp"

namespace photonav {
namespace {

namespace ob = ompl::base;
using Model = std::shared_ptr<BeliefModel>;
using Planner = std::shared_ptr<BeliefPlanner>;

struct PlannerEntry {
    const char* name;
    bool usesViews;
    Planner (*make)(const ob::SpaceInformationPtr&, const Model&, const SearchOptions&,
                    const GrowthOptions&);
};

constexpr std::array kPlanners{
    PlannerEntry{"belief_rrt_star", true,
                 [](const ob::SpaceInformationPtr& si, const Model& model,
                    const SearchOptions& search, const GrowthOptions& growth) -> Planner {
                     return std::make_shared<BeliefRRTstar>(si, model, search, growth);
                 }},
    PlannerEntry{"pa_rrt_star", true,
                 [](const ob::SpaceInformationPtr& si, const Model& model, const SearchOptions&,
                    const GrowthOptions& growth) -> Planner {
                     return std::make_shared<PerceptionRRTstar>(si, model, growth);
                 }},
    PlannerEntry{"rrbt", true,
                 [](const ob::SpaceInformationPtr& si, const Model& model, const SearchOptions&,
                    const GrowthOptions& growth) -> Planner {
                     return std::make_shared<RRBT>(si, model, growth);
                 }},
    PlannerEntry{"rrt_star", false,
                 [](const ob::SpaceInformationPtr& si, const Model& model, const SearchOptions&,
                    const GrowthOptions& growth) -> Planner {
                     return std::make_shared<PerceptionRRTstar>(
                         si, model, growth, PerceptionRRTstar::Minimises::length);
                 }}};

const PlannerEntry& entryOf(const std::string& name) {
    const auto* entry = std::ranges::find(kPlanners, name, &PlannerEntry::name);
    if (entry != kPlanners.end()) return *entry;
    throw std::invalid_argument(fmt::format("no planner is named {}; the names are {}", name,
                                            fmt::join(plannerNames(), ", ")));
}

Model withAlpha(const Model& model, double alpha) {
    BeliefOptions options = model->options();
    options.alpha = alpha;
    return std::make_shared<BeliefModel>(model->space(), model->sharedField(), options);
}

}  // namespace

const std::vector<std::string>& plannerNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        all.reserve(kPlanners.size());
        for (const PlannerEntry& entry : kPlanners) all.emplace_back(entry.name);
        return all;
    }();
    return names;
}

bool usesViews(const std::string& planner) { return entryOf(planner).usesViews; }

double alphaOf(const std::string& planner, double alpha) { return usesViews(planner) ? alpha : 1.; }

std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name,
                                           const ob::SpaceInformationPtr& si, const Model& model,
                                           const SearchOptions& search,
                                           const GrowthOptions& growth) {
    const PlannerEntry& entry = entryOf(name);
    return entry.make(si, entry.usesViews ? model : withAlpha(model, 1.), search, growth);
}

}  // namespace photonav
