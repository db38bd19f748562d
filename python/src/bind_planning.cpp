// SPDX-License-Identifier: BSD-3-Clause
// Planning problems, paths with beliefs, plans.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bindings.hpp"
#include "conversions.hpp"
#include "flown.hpp"
#include "geometry/se3.hpp"
#include "interruptible.hpp"
#include "planners/planner_table.hpp"
#include "problem/planning_problem.hpp"
#include "views.hpp"

namespace photonav::python {
namespace {

/// A config, its world, and the problem in it, which stay where they are.
struct Problem {
    explicit Problem(const Config& loaded)
        : config(loaded), world(config), problem(config, world) {}

    Config config;
    World world;
    PlanningProblem problem;
};

Config configOf(const py::object& config, const std::vector<std::string>& overrides) {
    if (!py::hasattr(config, "keys")) return loadConfig(pathOf(config), overrides);
    const auto text = py::module_::import("json").attr("dumps")(config).cast<std::string>();
    return parseConfig(text, "config", overrides);
}

std::unique_ptr<Problem> makeProblem(const py::object& config,
                                     const std::vector<std::string>& overrides) {
    const Config loaded = configOf(config, overrides);
    return interruptible(
        [&](const std::atomic<bool>&) { return std::make_unique<Problem>(loaded); });
}

std::vector<Place> placesOf(const Array& path) {
    if (path.ndim() != 2 || (path.shape(1) != 3 && path.shape(1) != 4) || path.shape(0) < 1) {
        throw py::value_error("path: expected an array of shape (N, 3) or (N, 4)");
    }
    std::vector<Place> places;
    for (py::ssize_t i = 0; i < path.shape(0); ++i) {
        Place place{{path.at(i, 0), path.at(i, 1), path.at(i, 2)}, std::nullopt};
        if (path.shape(1) == 4) place.yaw = path.at(i, 3);
        if (!place.position.allFinite() || !std::isfinite(place.yaw.value_or(0.))) {
            throw py::value_error(fmt::format("path: row {} is not finite", i));
        }
        places.push_back(place);
    }
    return places;
}

EvaluatedPath beliefs(Problem& self, const Array& path) {
    const std::vector<Place> places = placesOf(path);
    return interruptible([&](const std::atomic<bool>& interrupted) {
        return self.problem.evaluate("given", places, interrupted);
    });
}

PlanOutcome plan(Problem& self, const std::optional<std::string>& planner,
                 std::optional<std::uint32_t> seed, const std::optional<py::function>& onProgress) {
    const std::string name = planner.value_or(self.config.planner);
    usesViews(name);  // refuses unknown names
    self.problem.checkPlaces();
    return interruptible([&](const std::atomic<bool>& interrupted) {
        self.problem.kappa(interrupted);
        const auto made = self.problem.makePlanner(name, seed);
        return self.problem.solve(made, interrupted, [&](const PlanProgress& progress) {
            if (!onProgress) return;
            const py::gil_scoped_acquire lock;
            (*onProgress)(progress.vertices, progress.cost);
        });
    });
}

/// A member of every point.
template <typename Value>
auto alongPath(const EvaluatedPath& path, const Value& value) {
    std::vector<std::decay_t<decltype(value(path.points.front()))>> values;
    for (const BeliefPoint& point : path.points) values.push_back(value(point));
    return stacked(values);
}

double positionSigma(const BeliefPoint& point) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
        point.covariance.topLeftCorner<3, 3>(), Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0., solver.eigenvalues()[2]));
}

void bindPath(py::module_& module) {
    const auto along = [](auto value) {
        return [value](const EvaluatedPath& path) { return alongPath(path, value); };
    };
    py::class_<EvaluatedPath>(module, "Path",
                              "A path with the beliefs along it; the arrays have a row for every "
                              "point.")
        .def_readonly("planner", &EvaluatedPath::planner)
        .def_readonly("cost", &EvaluatedPath::cost)
        .def_readonly("length", &EvaluatedPath::length)
        .def_readonly("mean_trace", &EvaluatedPath::meanTrace)
        .def_readonly("goal_trace", &EvaluatedPath::goalTrace)
        .def_readonly("length_share", &EvaluatedPath::lengthShare)
        .def_property_readonly("T_w_b", along([](const BeliefPoint& p) { return p.T_w_b; }))
        .def_property_readonly("positions", along([](const BeliefPoint& p) -> Eigen::Vector3d {
                                   return p.T_w_b.translation();
                               }))
        .def_property_readonly("yaw", along([](const BeliefPoint& p) { return yawOf(p.T_w_b); }))
        .def_property_readonly("covariance",
                               along([](const BeliefPoint& p) { return p.covariance; }))
        .def_property_readonly("information",
                               along([](const BeliefPoint& p) { return p.information; }))
        .def_property_readonly("trace", along([](const BeliefPoint& p) { return p.trace; }))
        .def_property_readonly("position_sigma", along(positionSigma))
        .def_property_readonly("distance", along([](const BeliefPoint& p) { return p.length; }))
        .def_property_readonly("is_waypoint", [](const EvaluatedPath& path) {
            py::array_t<bool> flags(static_cast<py::ssize_t>(path.points.size()));
            std::transform(path.points.begin(), path.points.end(), flags.mutable_data(),
                           [](const BeliefPoint& p) { return p.isWaypoint; });
            return flags;
        });
}

FloatArray treeOf(const PlanOutcome& outcome) {
    FloatArray tree(
        {static_cast<py::ssize_t>(outcome.tree.size()), py::ssize_t{2}, py::ssize_t{3}});
    float* out = tree.mutable_data();
    for (const TreeSegment& segment : outcome.tree) {
        for (const Eigen::Vector3f& end : segment) out = std::copy(end.data(), end.data() + 3, out);
    }
    return tree;
}

void bindPlan(py::module_& module) {
    py::class_<PlanOutcome>(module, "Plan", "What a planner found.")
        .def_property_readonly("status", &PlanOutcome::status)
        .def_readonly("path", &PlanOutcome::path)
        .def_readonly("alpha", &PlanOutcome::alpha)
        .def_readonly("vertices", &PlanOutcome::vertices)
        .def_readonly("views", &PlanOutcome::views)
        .def_readonly("seconds", &PlanOutcome::planSeconds)
        .def_property_readonly("tree", &treeOf);
}

py::dict flyPath(const Problem& self, const EvaluatedPath& path, unsigned flights, unsigned jobs,
                 const std::optional<py::function>& onFlight) {
    if (path.points.size() < 2) throw py::value_error("path: one place is no path");
    if (flights == 0 || jobs == 0) throw py::value_error("flights, jobs: must be positive");
    const FlightSet set = interruptible([&](const std::atomic<bool>& interrupted) {
        std::size_t done = 0;
        return flyAlong(self.problem, path, flights, jobs, interrupted, [&] {
            ++done;
            if (!onFlight) return;
            const py::gil_scoped_acquire lock;
            (*onFlight)(done);
        });
    });
    return resultOf(set);
}

py::dict flyPlan(const Problem& self, const PlanOutcome& plan, unsigned flights, unsigned jobs,
                 const std::optional<py::function>& onFlight) {
    if (!plan.path) throw py::value_error("the plan has no path");
    return flyPath(self, *plan.path, flights, jobs, onFlight);
}

}  // namespace

void bindPlanning(py::module_& module) {
    using namespace py::literals;
    bindPath(module);
    bindPlan(module);
    py::class_<Problem>(module, "Problem",
                        "A planning problem: a config, its world, and what can be asked about it.")
        .def(py::init(&makeProblem), "config"_a, "overrides"_a = std::vector<std::string>{},
             "config: a YAML file, or a dictionary of the same keys, whose paths are relative to "
             "the working directory. overrides: \"key.path=value\".")
        .def_property_readonly("config", [](const Problem& self) { return toYaml(self.config); })
        .def_property_readonly("camera",
                               [](const Problem& self) { return self.config.camera.camera(); })
        .def_property_readonly(
            "views",
            [](const Problem& self) {
                const TexturedOcTree* map = self.world.map();
                return Views{self.world.sharedViews(), map == nullptr ? 0. : map->getResolution()};
            })
        .def_property_readonly(
            "T_b_c", [](const Problem& self) { return arrayOf(self.config.camera.T_b_c()); })
        .def_property_readonly(
            "initial_covariance",
            [](const Problem& self) -> Matrix6 { return self.problem.initialCovariance(); })
        .def(
            "kappa",
            [](Problem& self) {
                return interruptible([&](const std::atomic<bool>& interrupted) {
                    return self.problem.kappa(interrupted);
                });
            },
            "Of the cost [1/m^2]; chosen when it is needed first where the config says auto.")
        .def(
            "clearance",
            [](const Problem& self, const Array& position) {
                return self.world.clearance(vectorOf(position, 3, "position"));
            },
            "position"_a, "Distance to the nearest obstacle [m].")
        .def(
            "information_at",
            [](Problem& self, const Array& position, double yaw) -> Matrix6 {
                return self.problem.informationAt(
                    levelPose(vectorOf(position, 3, "position"), yaw));
            },
            "position"_a, "yaw"_a = 0.,
            "Of the view from a place, as planners count it (cached by cells), camera frame.")
        .def("beliefs", &beliefs, "path"_a,
             "Along straight motions between places (N, 3) or, with headings, (N, 4).")
        .def("plan", &plan, "planner"_a = py::none(), "seed"_a = py::none(),
             "on_progress"_a = py::none(),
             "on_progress(vertices, best cost) is called now and then.")
        .def("fly", &flyPath, "path"_a, "flights"_a = 1, "jobs"_a = 1, "on_flight"_a = py::none(),
             "Flies a path in closed loop with the camera, noise and tracker of the config.")
        .def("fly", &flyPlan, "path"_a, "flights"_a = 1, "jobs"_a = 1, "on_flight"_a = py::none());
}

}  // namespace photonav::python
