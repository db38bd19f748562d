// SPDX-License-Identifier: BSD-3-Clause
// Explorations in which a box, 1.2 m wide and 3 m high, appears ahead of the robot in space that
// was seen free: a flight per seed, planner and distance flown until then. The face of the box
// is 1.4 m from the robot, across its motion. "collided": the body, half of robot.radius, has
// touched something; "in view": images that have the middle of the face in view, as far as it is
// below the camera.
#include <fmt/format.h>
#include <ompl/util/Console.h>

#include <optional>
#include <sstream>

#include "bench_arguments.hpp"
#include "exploration/exploration.hpp"
#include "flight/flight_statistics.hpp"
#include "mission/exploration/room_to_explore.hpp"
#include "thread_time.hpp"

using namespace photonav;

namespace {

/// The room of the tests, under the conditions of `photonav explore`.
Config roomConfig() {
    Config config = test::flightThroughRoom();
    config.photometric.scale = Config().photometric.scale;
    config.explore.range = Config().explore.range;
    return config;
}

/// A world in which a box appears at some time.
class BoxedWorld : public ViewSource {
  public:
    BoxedWorld(const Scene& scene, const Config& config)
        : scene_(scene), config_(config), before_(scene, config) {}

    void render(const Camera& camera, const Pose& T_c_w, View& view) const override {
        now().views().render(camera, T_c_w, view);
    }
    double clearance(const Eigen::Vector3d& p_w) const { return now().clearance(p_w); }
    const World& before() const { return before_; }
    bool hasBox() const { return after_.has_value(); }

    void addBoxAhead(const Eigen::Vector2d& p, const Eigen::Vector2d& ahead, double away) {
        constexpr double kThickness = 0.4, kWidth = 1.2, kHeight = 3.;
        const Eigen::Vector2d side(-ahead.y(), ahead.x());
        const Eigen::Vector2d middle = p + (away + 0.5 * kThickness) * ahead;
        face_ = p + away * ahead;
        Scene boxed = scene_;
        addWall(boxed,
                {.footprint = {middle - 0.5 * kWidth * side, middle + 0.5 * kWidth * side},
                 .height = kHeight,
                 .thickness = kThickness},
                addTexture(boxed, valueNoise({.seed = 5})));
        after_.emplace(std::move(boxed), config_);
    }

    /// Whether the middle of the box's face is in an image, at some height below the camera.
    bool isInView(const Camera& camera, const Pose& T_c_w) const {
        const double top = T_c_w.inverse().translation().z();
        for (double z = 0.; z < top; z += 0.05) {
            const Eigen::Vector3d p_c = T_c_w * Eigen::Vector3d(face_.x(), face_.y(), z);
            if (p_c.z() <= 0.) continue;
            const Eigen::Vector2d pixel = camera.project(p_c);
            if (pixel.minCoeff() >= 0. && pixel.x() < camera.width && pixel.y() < camera.height) {
                return hasBox();
            }
        }
        return false;
    }

  private:
    const World& now() const { return after_ ? *after_ : before_; }

    Scene scene_;
    Config config_;
    World before_;
    Eigen::Vector2d face_ = Eigen::Vector2d::Zero();  // its middle
    std::optional<World> after_;
};

void fly(const Scene& scene, Config config, const std::string& planner, std::uint32_t seed,
         double flownBefore, double away) {
    config.planner = planner;
    auto world = std::make_shared<BoxedWorld>(scene, config);
    const PlanningProblem problem(config, world->before());
    ExplorationSetup setup = setUpExploration(problem);
    setup.truth.truth = world;
    setup.truth.clearance = [&](const Eigen::Vector3d& p_w) { return world->clearance(p_w); };
    std::optional<Eigen::Vector3d> last;
    double flown = 0., appeared = 0.;
    int inView = 0;
    const auto onExposure = [&](const Exposed& exposed) {
        const Eigen::Vector3d p_w = (setup.truth.T_b_c * exposed.T_c_w).inverse().translation();
        const Eigen::Vector3d moved = p_w - last.value_or(p_w);
        last = p_w;
        flown += moved.norm();
        inView += world->isInView(setup.truth.camera, exposed.T_c_w);
        constexpr double kFlying = 0.1;  // between exposures [m]
        if (world->hasBox() || flown < flownBefore || moved.head<2>().norm() < kFlying) return;
        world->addBoxAhead(p_w.head<2>(), moved.head<2>().normalized(), away);
        appeared = exposed.time;
    };
    const double begin = threadTime();
    const ExplorationResult flight =
        explore(setup, planner, seed, kNotInterrupted, {.exposure = onExposure});
    fmt::print(
        "{:16} {:4} {:5.1f} {:>18} {:8.3f} {:7.1f} {:7.1f} {:5.1f} {:4} {:8} {:7} {:6.2f} {:6.2f} "
        "{:7.1f} {}\n",
        planner, seed, flownBefore, world->hasBox() ? nameOf(flight.end) : "no box",
        flight.leastClearance, flight.flown, flight.duration, appeared, flight.timesLost,
        flight.rejectedImages, inView, flight.goalError, neesPerDof(flight),
        1e-3 * (threadTime() - begin), flight.reason);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv,
                                   "appearing_box_bench [room|CONFIG] [SEEDS=3] [AWAY=1.4] "
                                   "[PLANNERS=rrt_star,belief_rrt_star]");
    ompl::msg::setLogLevel(ompl::msg::LOG_WARN);
    const std::string name = arguments.text(1, "room");
    const auto seeds = arguments.number(2, std::uint32_t(3));
    const double away = arguments.number(3, 1.4);
    const bool isRoom = name == "room";
    const Config config = isRoom ? roomConfig() : loadConfig(name);
    const Scene scene = isRoom ? test::roomToExplore() : loadScene(config.sceneFile);
    fmt::print(
        "planner          seed after                end clearance  flown  seconds  box lost "
        "rejected in view  error   NEES CPU [s]\n");
    std::istringstream planners(arguments.text(4, "rrt_star,belief_rrt_star"));
    for (std::string planner; std::getline(planners, planner, ',');) {
        for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
            for (const double flown : {0.8, 2.}) fly(scene, config, planner, seed, flown, away);
        }
    }
}
