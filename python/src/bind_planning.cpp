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

std::string pathText(const EvaluatedPath& path) {
    return fmt::format("<Path of {}: {} points, {:.2f} m, cost {:.4g}, mean trace {:.3g} m^2>",
                       path.planner, path.points.size(), path.length, path.cost, path.meanTrace);
}

std::string planText(const PlanOutcome& plan) {
    return fmt::format("<Plan: {}, {} vertices, {:.1f} s, path {}>", plan.status(), plan.vertices,
                       plan.planSeconds, plan.path ? pathText(*plan.path) : "None");
}

void bindPath(py::module_& module) {
    const auto along = [](auto value) {
        return [value](const EvaluatedPath& path) { return alongPath(path, value); };
    };
    py::class_<EvaluatedPath>(module, "Path",
                              "A path with the beliefs along it; the arrays have a row for every "
                              "point.")
        .def_readonly("planner", &EvaluatedPath::planner,
                      "Name of the planner; given: of beliefs().")
        .def_readonly("cost", &EvaluatedPath::cost, "Cost J, which planners minimise.")
        .def_readonly("length", &EvaluatedPath::length, "Length [m].")
        .def_readonly("mean_trace", &EvaluatedPath::meanTrace,
                      "Weighted trace of the covariance, averaged over the distance flown [m^2].")
        .def_readonly("goal_trace", &EvaluatedPath::goalTrace,
                      "Weighted trace of the covariance at the goal [m^2].")
        .def_readonly("length_share", &EvaluatedPath::lengthShare,
                      "Share of the length in the cost, in [0, 1].")
        .def_property_readonly("T_w_b", along([](const BeliefPoint& p) { return p.T_w_b; }),
                               "Poses of the body in the world (N, 4, 4).")
        .def_property_readonly("positions", along([](const BeliefPoint& p) -> Eigen::Vector3d {
                                   return p.T_w_b.translation();
                               }),
                               "Positions of the body (N, 3) [m].")
        .def_property_readonly("yaw", along([](const BeliefPoint& p) { return yawOf(p.T_w_b); }),
                               "Headings (N,) [rad].")
        .def_property_readonly(
            "covariance", along([](const BeliefPoint& p) { return p.covariance; }),
            "Of T_c_w after the view (N, 6, 6), camera frame: translation, then rotation.")
        .def_property_readonly("information",
                               along([](const BeliefPoint& p) { return p.information; }),
                               "Fisher information of the view (N, 6, 6), camera frame.")
        .def_property_readonly("trace", along([](const BeliefPoint& p) { return p.trace; }),
                               "Weighted trace of the covariance (N,) [m^2].")
        .def_property_readonly(
            "position_sigma", along(positionSigma),
            "Standard deviation of the position along its weakest direction (N,) [m].")
        .def_property_readonly("distance", along([](const BeliefPoint& p) { return p.length; }),
                               "Length of the path so far (N,) [m].")
        .def_property_readonly(
            "is_waypoint",
            [](const EvaluatedPath& path) {
                py::array_t<bool> flags(static_cast<py::ssize_t>(path.points.size()));
                std::transform(path.points.begin(), path.points.end(), flags.mutable_data(),
                               [](const BeliefPoint& p) { return p.isWaypoint; });
                return flags;
            },
            "Whether a point is a waypoint of the planner (N,).")
        .def("__repr__", &pathText);
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
        .def_property_readonly("status", &PlanOutcome::status,
                               "done, no path, or failed (its cost is not finite).")
        .def_readonly("path", &PlanOutcome::path, "The best path; None if there is none.")
        .def_readonly("alpha", &PlanOutcome::alpha, "Weight of the length in the cost.")
        .def_readonly("vertices", &PlanOutcome::vertices, "Number of vertices of the tree.")
        .def_readonly("views", &PlanOutcome::views, "Number of views rendered.")
        .def_readonly("seconds", &PlanOutcome::planSeconds, "Duration of the planning [s].")
        .def_property_readonly("tree", &treeOf,
                               "Edges of the tree: both ends of each (N, 2, 3) [m].")
        .def("__repr__", &planText);
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
        .def_property_readonly(
            "config", [](const Problem& self) { return toYaml(self.config); },
            "The complete config as YAML.")
        .def_property_readonly(
            "camera", [](const Problem& self) { return self.config.camera.camera(); },
            "The camera of the config.")
        .def_property_readonly(
            "views",
            [](const Problem& self) {
                const TexturedOcTree* map = self.world.map();
                return Views{self.world.sharedViews(), map == nullptr ? 0. : map->getResolution()};
            },
            "The scene or map of the config, to render views from.")
        .def_property_readonly(
            "T_b_c", [](const Problem& self) { return arrayOf(self.config.camera.T_b_c()); },
            "Pose of the camera on the body (4, 4).")
        .def_property_readonly(
            "initial_covariance",
            [](const Problem& self) -> Matrix6 { return self.problem.initialCovariance(); },
            "Of T_c_w at the start before any view (6, 6), camera frame.")
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
