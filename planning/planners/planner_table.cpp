// SPDX-License-Identifier: BSD-3-Clause
#include "planners/planner_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "belief/names_of.hpp"
#include "planners/perception_rrt_star.hpp"
#include "planners/rrbt.hpp"

namespace photonav {
namespace {

namespace ob = ompl::base;
using Model = std::shared_ptr<BeliefModel>;
using Planner = std::shared_ptr<BeliefPlanner>;

struct PlannerEntry {
    PlannerTraits traits;
    Planner (*make)(const ob::SpaceInformationPtr&, const Model&, const SearchOptions&,
                    const GrowthOptions&);
    constexpr std::string_view name() const { return traits.name; }
};

/// RRBT keeps all beliefs: 19 thousand on 300 vertices of the stripes, 138 thousand on 1000.
constexpr unsigned kMostOfRrbt = 400;

/// Names, traits and constructors of all planners. The first planner is the default.
constexpr std::array kPlanners{
    PlannerEntry{{"belief_rrt_star", true, {222, 79, 12}},
                 [](const ob::SpaceInformationPtr& si, const Model& model,
                    const SearchOptions& search, const GrowthOptions& growth) -> Planner {
                     return std::make_shared<BeliefRRTstar>(si, model, search, growth);
                 }},
    PlannerEntry{{"pa_rrt_star", true, {230, 159, 0}},
                 [](const ob::SpaceInformationPtr& si, const Model& model, const SearchOptions&,
                    const GrowthOptions& growth) -> Planner {
                     return std::make_shared<PerceptionRRTstar>(si, model, growth);
                 }},
    PlannerEntry{{"rrbt", true, {0, 158, 115}, kMostOfRrbt},
                 [](const ob::SpaceInformationPtr& si, const Model& model, const SearchOptions&,
                    const GrowthOptions& growth) -> Planner {
                     return std::make_shared<RRBT>(si, model, growth);
                 }},
    PlannerEntry{{"rrt_star", false, {28, 108, 214}},
                 [](const ob::SpaceInformationPtr& si, const Model& model, const SearchOptions&,
                    const GrowthOptions& growth) -> Planner {
                     return std::make_shared<PerceptionRRTstar>(
                         si, model, growth, PerceptionRRTstar::Minimises::length);
                 }}};

const PlannerEntry* find(std::string_view name) {
    const auto* entry = std::ranges::find(kPlanners, name, &PlannerEntry::name);
    return entry == kPlanners.end() ? nullptr : entry;
}

const PlannerEntry& entryOf(const std::string& name) {
    if (const PlannerEntry* entry = find(name)) return *entry;
    throw std::invalid_argument(fmt::format("no planner is named {}; the names are {}", name,
                                            fmt::join(plannerNames(), ", ")));
}

Model withAlpha(const Model& model, double alpha) {
    BeliefOptions options = model->options();
    options.alpha = alpha;
    return std::make_shared<BeliefModel>(model->space(), model->sharedField(), options);
}

}  // namespace

const PlannerTraits* findPlanner(std::string_view name) {
    const PlannerEntry* entry = find(name);
    return entry == nullptr ? nullptr : &entry->traits;
}

const std::vector<std::string>& plannerNames() {
    static const std::vector<std::string> names = namesOf(kPlanners, &PlannerEntry::name);
    return names;
}

bool usesViews(const std::string& planner) { return entryOf(planner).traits.usesViews; }

double alphaOf(const std::string& planner, double alpha) { return usesViews(planner) ? alpha : 1.; }

std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name,
                                           const ob::SpaceInformationPtr& si, const Model& model,
                                           const SearchOptions& search,
                                           const GrowthOptions& growth) {
    const PlannerEntry& entry = entryOf(name);
    return entry.make(si, entry.traits.usesViews ? model : withAlpha(model, 1.), search, growth);
}

}  // namespace photonav
