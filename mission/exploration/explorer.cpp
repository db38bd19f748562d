// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/explorer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "geometry/se3.hpp"
#include "io/stopwatch.hpp"
#include "render/interruptible_views.hpp"

namespace photonav {
namespace {

/// Radius around the robot that a camera that looks ahead does not observe [m].
constexpr double kHidden = 0.3;
/// Number of updates in a row without a flyable plan after which the flight ends; for one camera
/// also the limit of steps, see kBlindInVain.
constexpr int kMostInVain = 6;
/// Least time without a flyable plan after which the flight ends, at whatever rate images come [s].
constexpr double kLeastInVain = 2.;
/// Number of steps in a row into unobserved space that may leave the map unchanged; then the robot
/// hovers.
constexpr int kBlindInVain = 1;
/// Longest stop before an obstacle in view that does not enter the map; then the flight ends [s].
constexpr double kMostStopped = 10.;
/// Longest time around the goal without an arrival; then the flight ends with its belief [s].
constexpr double kMostAtGoal = 30.;
/// Distance to the goal that counts as around it [m].
constexpr double kAroundGoal = 2.;
/// Time without an update, while the plan is only a part of the way, after which the next image
/// becomes a keyframe [s].
constexpr double kWait = 1.;

/// Distance flown at full speed from the exposure of an image that shows an obstacle until the
/// robot stands, if the next image is missing.
double stoppingDistance(const ExplorerOptions& options) {
    const MotionLimits& limits = options.pilot.route.limits;
    const double seconds = options.imageAge + options.pilot.route.responseTime;
    return limits.maxSpeed * (seconds + 0.5 * limits.maxSpeed / limits.maxAcceleration);
}

/// Half the width of the way that must be free until the robot stands: its body, and three
/// standard deviations of odometry and depth over this distance; not more than plans keep free.
double stoppingRadius(const ExplorerOptions& options, double distance) {
    const Config& config = options.config;
    const Eigen::Matrix3d odometry = config.belief.motionNoise.topLeftCorner<3, 3>();
    const double depth = depthSigmaAtOneMetre(config) * distance * distance;
    const double variance = distance * odometry.diagonal().maxCoeff() + depth * depth;
    return std::min(config.robotRadius, options.bodyRadius + 3. * std::sqrt(variance));
}

TrackerOptions trackerFor(const ExplorerOptions& options, const OnlineMap& map) {
    TrackerOptions tracker = options.tracker;
    tracker.mapErrors = map.errors();
    return tracker;
}

PilotOptions pilotFor(const ExplorerOptions& options, const OnlinePlanner& planner) {
    PilotOptions pilot = options.pilot;
    pilot.photometricGoal = false;
    pilot.radius = options.config.robotRadius;
    pilot.bodyRadius = options.bodyRadius;
    pilot.clearance = [&planner](const Eigen::Vector3d& p_w) { return planner.clearance(p_w); };
    return pilot;
}

std::vector<PlannedView> stayingAt(const UncertainPose& T_c_w, const Pose& T_b_c) {
    return hovering((T_b_c * T_c_w.mean).inverse(), T_c_w.covariance);
}

const Config& checked(const Config& config, const Robot& robot) {
    const Camera camera = config.camera.camera();
    if (camera.width != robot.camera().width || camera.height != robot.camera().height ||
        camera.intrinsics != robot.camera().intrinsics) {
        throw std::invalid_argument("exploration: the robot's camera is not that of the config");
    }
    if (!config.camera.T_b_c().isApprox(robot.T_b_c(), 1e-6)) {
        throw std::invalid_argument("exploration: the camera's mount is not that of the config");
    }
    return config;
}

}  // namespace

UncertainPose beliefAtTakeOff(const Config& config) {
    const Place& start = config.start;
    const Pose T_b_c = config.camera.T_b_c();
    const Pose T_w_b = levelPose(start.position, start.yaw.value_or(0.));
    return {(T_w_b * T_b_c).inverse(),
            inOtherFrame(config.explore.initialCovariance, T_b_c.inverse())};
}

Explorer::Explorer(const ExplorerOptions& options, const Robot& robot, const std::string& planner,
                   std::uint32_t seed, const std::atomic<bool>& interrupted, OnExplorer on)
    : config_(checked(options.config, robot)),
      camera_(robot.camera()),
      T_b_c_(robot.T_b_c()),
      interrupted_(interrupted),
      on_(std::move(on)),
      map_(config_, options.known.get()),
      planner_(config_, map_, explorePlanner(planner), seed),
      tracker_(trackerOf(robot, views(), beliefAtTakeOff(config_), trackerFor(options, map_))),
      pilot_(pilotOf(robot, stayingAt(beliefAtTakeOff(config_), T_b_c_), views(),
                     pilotFor(options, planner_))),
      mapper_(config_, map_),
      toStop_(stoppingDistance(options)),
      tube_(stoppingRadius(options, toStop_)) {
    const bool isAhead = looksAhead(T_b_c_);
    space_ = {.clearance = [this](const Eigen::Vector3d& p_w) { return clearance(p_w); },
              .isSeen = [this](const Eigen::Vector3d& p_w) { return map_.isSeen(p_w); },
              .radius = config_.robotRadius,
              .hidden = isAhead ? kHidden : 0.,
              .canLook = isAhead && config_.space != StateKind::position &&
                         explorePlanner(planner).headings != Headings::fixed};
    record_.planner = planner;
    record_.seed = seed;
    record_.map = map_.cells();
}

bool Explorer::onStep(const Observation& observation, const std::vector<TrackedFrame>& tracked) {
    time_ = observation.time;
    for (std::size_t i = 0; i < tracked.size(); ++i) {
        stopIfInterrupted();
        corrections_.add(tracked[i]);
        onImage(tracked[i], observation.frames[i].view);
    }
    return !hasEnded();
}

/// Between the steps that take long where images are large.
void Explorer::stopIfInterrupted() const {
    if (interrupted_) throw RenderingStopped();
}

/// Whether the robot is where its present plan ends, short of the goal.
bool Explorer::isWaiting() const {
    return !isWhole_ && (pilot_.route().isAtGoal() || time_ - lastUpdate_ > kWait);
}

/// Above the robot's radius the same as in the map. The last image shows obstacles before the map
/// does; from them the body keeps away as far as it must to stop.
double Explorer::clearance(const Eigen::Vector3d& p_w) const {
    const double inView = inView_.clearance(p_w) + config_.robotRadius - tube_;
    return std::min(planner_.clearance(p_w), inView);
}

/// Whether an image shows that the way to be flown next is not free.
bool Explorer::isInTheWay(const TrackedFrame& tracked, const View& image) {
    if (image.depth.getSize() == 0) return false;
    inView_ = map_.obstaclesIn(image.depth, camera_, tracked.T_c_w.mean, toStop_ + tube_);
    std::vector<Eigen::Vector3d> way{bodyOf(tracker_.belief().mean).translation()};
    for (const PlannedView& view : pilot_.route().ahead()) way.push_back(view.T_w_b.translation());
    return !inView_.newWalls().empty() || inView_.isOn(way, tube_);
}

void Explorer::onImage(const TrackedFrame& tracked, const View& image) {
    View shown;
    views()->render(camera_, tracked.T_c_w.mean, shown);
    Stopwatch watch;
    const bool isStopped = isInTheWay(tracked, image);
    auto change = mapper_.add(tracked, image, shown, isWaiting() || isStopped);
    stopIfInterrupted();
    if (!change && isStopped) change.emplace();  // plan without a new map
    if (!change) return;
    updatePlan(*change, watch.seconds());
    if (on_.moment) on_.moment({planner_, map_, *change, tracked.T_c_w, image, shown});
}

/// Plans from where the robot is by now, in a map that has changed.
/// @param change the space of the body is added
void Explorer::updatePlan(MapChange& change, double fuseSeconds) {
    const UncertainPose& T_c_w = tracker_.belief();
    PlanUpdate update;
    update.time = time_;
    Stopwatch watch;
    if (!change.occupancy.empty()) blindInVain_ = 0;
    change.join(map_.addBody(bodyOf(T_c_w.mean).translation()));
    if (record_.updates.empty()) change.join(map_.whole());  // for those who saw no earlier change
    update.fuseSeconds = fuseSeconds + watch.seconds();
    record_.keyframes = mapper_.keyframes();
    planner_.update(change, T_c_w, update, interrupted_);
    tracker_.setMap(views());
    pilot_.setMap(views());
    lastUpdate_ = time_;
    flyOn(T_c_w);
    record_.updates.push_back(update);
    if (on_.update) on_.update(record_);
}

/// Gives the pilot the part of the plan that is safe, or lets it hover.
void Explorer::flyOn(const UncertainPose& T_c_w) {
    const std::vector<BeliefPoint>& path = planner_.path();
    if (path.empty()) return hover(T_c_w);
    // Hovering over the goal is not interrupted by a way of a few centimetres to it.
    if (isWhole_ && pilot_.route().isAtGoal()) return;
    FlyablePart way = flyablePart(path, space_);
    if (way.isBlind && !mayStepBlindly()) return hover(T_c_w);
    withoutWay_ = 0;
    withoutWaySince_.reset();
    if (!way.isStopped) stoppedSince_.reset();
    if (way.isStopped && !stoppedSince_) stoppedSince_ = time_;
    blindInVain_ += way.isBlind;
    isWhole_ = way.isWhole;
    record_.blindSteps += way.isBlind;
    pilot_.setPlan(std::move(way.plan));
}

/// A camera without a depth sensor has to move before it sees anything.
bool Explorer::mayStepBlindly() const {
    const bool isMonocular = config_.explore.sensor == ExploreSensor::monocular;
    return blindInVain_ < (isMonocular ? kMostInVain : kBlindInVain);
}

void Explorer::hover(const UncertainPose& T_c_w) {
    ++withoutWay_;
    if (!withoutWaySince_) withoutWaySince_ = time_;
    isWhole_ = false;
    pilot_.setPlan(stayingAt(T_c_w, T_b_c_));
}

std::shared_ptr<const ViewSource> Explorer::views() const {
    return std::make_shared<InterruptibleViews>(planner_.views(),
                                                [this] { return interrupted_.load(); });
}

bool Explorer::endAs(FlightEnd end, const std::string& reason) {
    end_ = end;
    record_.reason = reason;
    return true;
}

std::string Explorer::reasonForNoWay() const {
    const double clearance = planner_.clearance(config_.goal.position);
    if (clearance < config_.robotRadius) {
        return fmt::format("the goal is in collision: clearance {:.2f} m in the map", clearance);
    }
    if (!planner_.path().empty()) return "the sensor cannot observe the space ahead";
    return "the map shows no way to the goal";
}

/// Whether the robot was at its goal and is still around it, but too often lost to arrive.
bool Explorer::isStuckAtGoal() {
    const Eigen::Vector3d p_w = bodyOf(tracker_.belief().mean).translation();
    if ((p_w - config_.goal.position).norm() > kAroundGoal) atGoalSince_.reset();
    if (!atGoalSince_ && isWhole_ && pilot_.route().isAtGoal()) atGoalSince_ = time_;
    return atGoalSince_ && time_ - *atGoalSince_ > kMostAtGoal;
}

bool Explorer::hasEnded() {
    stopIfInterrupted();
    if (tracker_.loss().isLost() && pilot_.hasGivenUp(tracker_, time_)) {
        return endAs(FlightEnd::lost, "tracking was lost and not regained");
    }
    if (withoutWay_ >= kMostInVain && time_ - *withoutWaySince_ >= kLeastInVain) {
        return endAs(FlightEnd::noWay, reasonForNoWay());
    }
    if (stoppedSince_ && time_ - *stoppedSince_ > kMostStopped) {
        return endAs(FlightEnd::noWay, "an obstacle in view that is not in the map");
    }
    if (time_ > config_.explore.timeLimit) {
        return endAs(FlightEnd::outOfTime, "the time limit was reached");
    }
    if (isStuckAtGoal() || (isWhole_ && pilot_.hasArrived(tracker_, time_))) return endAtGoal();
    return false;
}

/// As certain of it as the belief is.
bool Explorer::endAtGoal() {
    arrival_ = believedArrival(tracker_.belief(), T_b_c_, corrections_, config_.goal.position,
                               config_.explore.goalTolerance);
    if (arrival_->probability >= config_.explore.goalConfidence) {
        return endAs(FlightEnd::arrived, "");
    }
    return endAs(FlightEnd::uncertain, fmt::format("at the goal with a probability of {:.3f} only",
                                                   arrival_->probability));
}

ExplorationOutcome explore(Robot& robot, const ExplorerOptions& options, const std::string& planner,
                           std::uint32_t seed, const std::atomic<bool>& interrupted,
                           const OnExplorer& on, const OnFlightStep& onStep) {
    Explorer explorer(options, robot, planner, seed, interrupted, on);
    ExplorationOutcome outcome;
    const auto step = [&](const Observation& observation,
                          const std::vector<TrackedFrame>& tracked) {
        outcome.duration = observation.time;
        if (onStep && !onStep(observation, tracked)) return false;
        return explorer.onStep(observation, tracked);
    };
    try {
        flyLoop(robot, explorer.tracker(), explorer.pilot(), options.timeStep, step);
    } catch (const RenderingStopped&) {  // interrupted
    }
    static_cast<ExplorationRecord&>(outcome) = explorer.record();
    outcome.end = explorer.end().value_or(FlightEnd::stopped);
    outcome.arrival = explorer.arrival();
    return outcome;
}

}  // namespace photonav
