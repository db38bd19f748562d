// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/exploration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exploration/flyable_part.hpp"
#include "exploration/mapper.hpp"
#include "geometry/gaussian.hpp"
#include "geometry/se3.hpp"
#include "io/stopwatch.hpp"
#include "render/interruptible_views.hpp"

namespace photonav {
namespace {

constexpr double kHidden = 0.3;  // around the robot, that such a camera does not see [m]
constexpr int kMostInVain = 6;   // updates in a row without a way, before there is none
constexpr int kBlindInVain = 1;  // steps into what was not seen that showed nothing either, before
                                 // there is no way
constexpr double kMostStopped = 10.;  // before an obstacle in view that the map does not get,
                                      // before there is no way [s]
constexpr double kMostAtGoal = 30.;   // around the goal without an arrival, before the flight ends
                                      // as certain as it is [s]
constexpr double kAroundGoal = 2.;    // [m]
constexpr double kWait = 1.;  // before an update without a keyframe, while nothing moves [s]

Matrix6 inCameraFrame(const Matrix6& covariance, const Pose& T_b_c) {
    const Matrix6 toCamera = adjoint(T_b_c.inverse());
    return toCamera * covariance * toCamera.transpose();
}

/// Robot, tracker, pilot and map in closed loop, and the comparison with the truth.
class Exploration {
  public:
    Exploration(const ExplorationSetup& setup, const std::string& planner, std::uint32_t seed,
                const std::atomic<bool>& interrupted, const OnExploration& on);
    ExplorationResult run();

  private:
    void flyToTheEnd();
    void stopIfInterrupted() const;
    void onImage(const TrackedFrame& tracked, const View& image);
    void updatePlan(const UncertainPose& T_c_w, MapChange& change, double fuseSeconds);
    void flyOn(const UncertainPose& T_c_w);
    bool mayStepBlindly() const;
    void hover(const UncertainPose& T_c_w);
    bool isWaiting() const;
    bool isStuckAtGoal();
    bool hasEnded();
    bool endAtGoal();
    const ExplorationResult& resultSoFar();
    bool endAs(FlightEnd end, const std::string& reason);
    std::string reasonForNoWay() const;
    Pose bodyOf(const Pose& T_c_w) const { return (setup_.truth.T_b_c * T_c_w).inverse(); }
    bool isInTheWay(const TrackedFrame& tracked, const View& image);
    double clearance(const Eigen::Vector3d& p_w) const;
    std::shared_ptr<const ViewSource> interruptible(std::shared_ptr<const ViewSource> views) const {
        return std::make_shared<InterruptibleViews>(std::move(views),
                                                    [this] { return interrupted_.load(); });
    }
    /// Views of the present map.
    std::shared_ptr<const ViewSource> views() const { return interruptible(planner_.views()); }

    const ExplorationSetup& setup_;
    const std::atomic<bool>& interrupted_;
    const OnExploration& on_;
    OwnMap map_;
    OnlinePlanner planner_;
    SimulatedRobot robot_;
    Tracker tracker_;
    Pilot pilot_;
    SpaceAhead space_;
    Mapper mapper_;
    double toStop_;           // flown until the robot stands, from an image on [m]
    double tube_;             // radius of the way that must be free in every depth image [m]
    ObstaclesInView inView_;  // of the last image
    bool isWhole_ = false;    // the plan flown leads to the goal
    int withoutWay_ = 0;      // updates in a row
    std::optional<double> stoppedSince_;  // by an obstacle in view [s]
    int blindInVain_ = 0;                 // steps since the map last grew
    double lastUpdate_ = 0.;              // [s]
    std::optional<double> atGoalSince_;   // reached, and not left by far [s]
    FlightEvaluator evaluator_;
    ExplorationResult result_;
};

/// Flown from the exposure of an image that shows an obstacle until the robot stands, at full speed
/// and if the image after it is missing.
double stoppingDistance(const FlightOptions& flight) {
    const MotionLimits& limits = flight.pilot.route.limits;
    const SimulatedCameraOptions& camera = flight.robot.camera;
    const double seconds = 2. * camera.period + camera.latency + flight.pilot.route.responseTime;
    return limits.maxSpeed * (seconds + 0.5 * limits.maxSpeed / limits.maxAcceleration);
}

/// Half the width of the way that must be free until the robot stands: its body, and three
/// standard deviations of odometry and depth over this distance; not more than plans keep free.
double stoppingRadius(const ExplorationSetup& setup, double distance) {
    const Config& config = setup.config;
    const Eigen::Matrix3d odometry = config.belief.motionNoise.topLeftCorner<3, 3>();
    const double depth = depthSigmaAtOneMetre(config) * distance * distance;
    const double variance = distance * odometry.diagonal().maxCoeff() + depth * depth;
    return std::min(config.robotRadius, setup.flight.bodyRadius + 3. * std::sqrt(variance));
}

/// The belief at take-off.
UncertainPose startOf(const ExplorationSetup& setup) {
    const Place& start = setup.config.start;
    Pose T_w_b = Pose::Identity();
    T_w_b.translation() = start.position;
    T_w_b.rotate(Eigen::AngleAxisd(start.yaw.value_or(0.), Eigen::Vector3d::UnitZ()));
    const Pose& T_b_c = setup.truth.T_b_c;
    return {(T_w_b * T_b_c).inverse(),
            inCameraFrame(setup.config.explore.initialCovariance, T_b_c)};
}

TrackerOptions trackerFor(const ExplorationSetup& setup, const OwnMap& map) {
    TrackerOptions tracker = setup.flight.tracker;
    tracker.T_b_c = setup.truth.T_b_c;
    tracker.mapErrors = map.errors();
    return tracker;
}

PilotOptions pilotFor(const ExplorationSetup& setup, const OnlinePlanner& planner) {
    PilotOptions pilot = setup.flight.pilot;
    pilot.photometricGoal = false;
    pilot.isFree = [&planner, radius = setup.config.robotRadius](const Eigen::Vector3d& p_w) {
        return planner.clearance(p_w) >= radius;
    };
    return pilot;
}

std::vector<PlannedView> stayingAt(const UncertainPose& T_c_w, const Pose& T_b_c) {
    return hovering((T_b_c * T_c_w.mean).inverse(), T_c_w.covariance);
}

Exploration::Exploration(const ExplorationSetup& setup, const std::string& planner,
                         std::uint32_t seed, const std::atomic<bool>& interrupted,
                         const OnExploration& on)
    : setup_(setup),
      interrupted_(interrupted),
      on_(on),
      map_(setup.config),
      planner_(setup.config, map_, explorePlanner(planner), seed),
      robot_(interruptible(setup.truth.truth), setup.truth.camera, setup.truth.T_b_c,
             drawStart(startOf(setup), setup.truth.T_b_c, seed), setup.truth.noise,
             setup.flight.robot, seed),
      tracker_(views(), robot_.camera(), startOf(setup), trackerFor(setup, map_)),
      pilot_(stayingAt(startOf(setup), setup.truth.T_b_c), views(), robot_.camera(),
             setup.truth.T_b_c, pilotFor(setup, planner_)),
      mapper_(setup.config, map_),
      toStop_(stoppingDistance(setup.flight)),
      tube_(stoppingRadius(setup, toStop_)),
      evaluator_(setup.truth, robot_, setup.config.goal.position) {
    const Config& config = setup.config;
    const bool isAhead = looksAhead(setup.truth.T_b_c);
    space_ = {.clearance = [this](const Eigen::Vector3d& p_w) { return clearance(p_w); },
              .isSeen = [this](const Eigen::Vector3d& p_w) { return map_.isSeen(p_w); },
              .radius = config.robotRadius,
              .hidden = isAhead ? kHidden : 0.,
              .canLook = isAhead && config.space != StateKind::position &&
                         explorePlanner(planner).headings != Headings::fixed};
    result_.planner = planner;
    result_.seed = seed;
    result_.map = map_.cells();
}

ExplorationResult Exploration::run() {
    try {
        flyToTheEnd();
    } catch (const RenderingStopped&) {
        endAs(FlightEnd::stopped, "interrupted");
    }
    evaluator_.finish(tracker_);
    return resultSoFar();
}

void Exploration::flyToTheEnd() {
    BodyVelocity command;
    const double dt = setup_.flight.timeStep;
    for (double seconds = 0.;; seconds = dt) {
        const Observation observation = robot_.fly(command, seconds);
        stopIfInterrupted();
        if (on_.exposure && robot_.exposed()) on_.exposure(*robot_.exposed());
        const std::vector<TrackedFrame> tracked = tracker_.update(observation);
        evaluator_.onStep(tracked, tracker_, evaluator_.result().flown);
        for (std::size_t i = 0; i < tracked.size(); ++i) {
            stopIfInterrupted();
            pilot_.observe(tracker_, tracked[i], observation.frames[i].view.intensity);
            onImage(tracked[i], observation.frames[i].view);
        }
        if (hasEnded()) return;
        command = pilot_.command(tracker_, observation.time, dt);
    }
}

/// Between the steps that take long where images are large.
void Exploration::stopIfInterrupted() const {
    if (interrupted_) throw RenderingStopped();
}

/// Whether the robot is where its plan ends for now.
bool Exploration::isWaiting() const {
    return !isWhole_ && (pilot_.route().isAtGoal() || robot_.time() - lastUpdate_ > kWait);
}

/// Above the robot's radius the same as in the map. The last image shows obstacles before the map
/// does; from them the body keeps away as far as it must to stop.
double Exploration::clearance(const Eigen::Vector3d& p_w) const {
    const double inView = inView_.clearance(p_w) + setup_.config.robotRadius - tube_;
    return std::min(planner_.clearance(p_w), inView);
}

/// Whether an image shows that the way to be flown next is not free.
bool Exploration::isInTheWay(const TrackedFrame& tracked, const View& image) {
    if (image.depth.getSize() == 0) return false;
    inView_ = map_.obstaclesIn(image.depth, robot_.camera(), tracked.T_c_w.mean, toStop_ + tube_);
    std::vector<Eigen::Vector3d> way{bodyOf(tracker_.belief().mean).translation()};
    for (const PlannedView& view : pilot_.route().ahead()) way.push_back(view.T_w_b.translation());
    return !inView_.newWalls().empty() || inView_.isOn(way, tube_);
}

void Exploration::onImage(const TrackedFrame& tracked, const View& image) {
    View shown;
    views()->render(robot_.camera(), tracked.T_c_w.mean, shown);
    Stopwatch watch;
    const bool isStopped = isInTheWay(tracked, image);
    auto change = mapper_.add(tracked, image, shown, isWaiting() || isStopped);
    stopIfInterrupted();
    if (!change && isStopped) change.emplace();  // plan without a new map
    if (!change) return;
    updatePlan(tracked.T_c_w, *change, watch.seconds());
    if (!on_.moment) return;
    on_.moment({resultSoFar(), planner_, map_, *change, tracked.T_c_w, image, shown});
}

/// Plans from here on in a map that has changed.
/// @param change the space of the body is added
void Exploration::updatePlan(const UncertainPose& T_c_w, MapChange& change, double fuseSeconds) {
    PlanUpdate update;
    update.time = robot_.time();
    Stopwatch watch;
    if (!change.occupancy.empty()) blindInVain_ = 0;
    change.join(map_.addBody(bodyOf(T_c_w.mean).translation()));
    update.fuseSeconds = fuseSeconds + watch.seconds();
    result_.keyframes = mapper_.keyframes();
    planner_.update(change, T_c_w, update, interrupted_);
    tracker_.setMap(views());
    pilot_.setMap(views());
    lastUpdate_ = robot_.time();
    flyOn(T_c_w);
    result_.updates.push_back(update);
    if (on_.update) on_.update(resultSoFar());
}

/// Gives the pilot the part of the plan that is safe, or lets it hover.
void Exploration::flyOn(const UncertainPose& T_c_w) {
    const std::vector<BeliefPoint>& path = planner_.path();
    if (path.empty()) return hover(T_c_w);
    // Hovering over the goal is not interrupted by a way of a few centimetres to it.
    if (isWhole_ && pilot_.route().isAtGoal()) return;
    FlyablePart way = flyablePart(path, space_);
    if (way.isBlind && !mayStepBlindly()) return hover(T_c_w);
    withoutWay_ = 0;
    if (!way.isStopped) stoppedSince_.reset();
    if (way.isStopped && !stoppedSince_) stoppedSince_ = robot_.time();
    blindInVain_ += way.isBlind;
    isWhole_ = way.isWhole;
    result_.blindSteps += way.isBlind;
    pilot_.setPlan(std::move(way.plan));
}

/// A camera without a depth sensor has to move before it sees anything.
bool Exploration::mayStepBlindly() const {
    const bool isMonocular = setup_.config.explore.sensor == ExploreSensor::monocular;
    return blindInVain_ < (isMonocular ? kMostInVain : kBlindInVain);
}

void Exploration::hover(const UncertainPose& T_c_w) {
    ++withoutWay_;
    isWhole_ = false;
    pilot_.setPlan(stayingAt(T_c_w, setup_.truth.T_b_c));
}

const ExplorationResult& Exploration::resultSoFar() {
    static_cast<FlightResult&>(result_) = evaluator_.result();
    return result_;
}

bool Exploration::endAs(FlightEnd end, const std::string& reason) {
    evaluator_.result().end = end;
    result_.reason = reason;
    return true;
}

std::string Exploration::reasonForNoWay() const {
    const double clearance = planner_.clearance(setup_.config.goal.position);
    if (clearance < setup_.config.robotRadius) {
        return fmt::format("the goal is in collision: clearance {:.2f} m in the map", clearance);
    }
    if (!planner_.path().empty()) return "the sensor does not show the way ahead";
    return "the map shows no way to the goal";
}

/// Whether the robot was at its goal and is still around it, but too often lost to arrive.
bool Exploration::isStuckAtGoal() {
    const Eigen::Vector3d p_w = bodyOf(tracker_.belief().mean).translation();
    if ((p_w - setup_.config.goal.position).norm() > kAroundGoal) atGoalSince_.reset();
    if (!atGoalSince_ && isWhole_ && pilot_.route().isAtGoal()) atGoalSince_ = robot_.time();
    return atGoalSince_ && robot_.time() - *atGoalSince_ > kMostAtGoal;
}

bool Exploration::hasEnded() {
    const double time = robot_.time();
    stopIfInterrupted();
    const double clearance = evaluator_.result().leastClearance;
    if (clearance < setup_.flight.bodyRadius) {
        return endAs(FlightEnd::collided, fmt::format("an obstacle {:.2f} m away", clearance));
    }
    if (tracker_.loss().isLost() && pilot_.hasGivenUp(tracker_, time)) {
        return endAs(FlightEnd::lost, "tracking was lost for good");
    }
    if (withoutWay_ >= kMostInVain) return endAs(FlightEnd::noWay, reasonForNoWay());
    if (stoppedSince_ && time - *stoppedSince_ > kMostStopped) {
        return endAs(FlightEnd::noWay, "an obstacle in view that the map does not show");
    }
    if (time > setup_.config.explore.timeLimit) {
        return endAs(FlightEnd::outOfTime, "the time limit was reached");
    }
    if (isStuckAtGoal() || (isWhole_ && pilot_.hasArrived(tracker_, time))) return endAtGoal();
    return false;
}

/// As certain of it as the belief is.
bool Exploration::endAtGoal() {
    const FlightEnd end = evaluator_.endAtGoal(tracker_, setup_.flight.arrivalTolerance,
                                               setup_.config.explore.goalConfidence);
    if (end == FlightEnd::arrived) return endAs(end, "");
    if (end == FlightEnd::uncertain) {
        return endAs(end, fmt::format("at the goal with a probability of {:.3f} only",
                                      evaluator_.result().arrivalProbability));
    }
    return endAs(end,
                 fmt::format("the pose was {:.2f} m wrong at the goal", evaluator_.goalError()));
}

}  // namespace

ExplorationResult explore(const ExplorationSetup& setup, const std::string& planner,
                          std::uint32_t seed, const std::atomic<bool>& interrupted,
                          const OnExploration& on) {
    const Stopwatch watch;
    ExplorationResult flight = Exploration(setup, planner, seed, interrupted, on).run();
    flight.wallSeconds = watch.seconds();
    return flight;
}

}  // namespace photonav
