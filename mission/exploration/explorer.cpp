// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/explorer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "geometry/gaussian.hpp"
#include "geometry/se3.hpp"
#include "io/interrupted.hpp"
#include "render/interruptible_views.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {
namespace {

/// Number of steps into unobserved space while the map does not grow; then the robot hovers. A
/// single camera sees no depth until it has moved: it may take some such steps in a flight, but
/// more would lead into obstacles that it has not mapped. Stereo takes none: what it does not
/// observe may be a surface without texture.
constexpr int kMostBlindSteps = 1;
constexpr int kMostMonocularSteps = 6;
/// Time without an update, while the plan is only a part of the way, after which the next image
/// becomes a keyframe [s].
constexpr double kWait = 1.;
/// Heading of a robot that faces a place [rad].
constexpr double kLooksThere = 0.1;
/// Longest turn toward a place, beyond the time of half a turn [s].
constexpr double kLongestLook = 2.;
/// Longest improvement of a plan in real time [s].
constexpr double kPlanTime = 0.5;

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

TrackerOptions trackerFor(const ExplorerOptions& options, const Mapper& mapper) {
    TrackerOptions tracker = options.tracker;
    tracker.mapErrors = mapper.errors();
    tracker.depth = {depthSigmaAtOneMetre(options.config), options.config.explore.cell()};
    return tracker;
}

PilotOptions pilotFor(const ExplorerOptions& options, const Replanner& replanner) {
    PilotOptions pilot = options.pilot;
    pilot.photometricGoal = false;
    pilot.radius = options.config.robotRadius;
    pilot.bodyRadius = options.bodyRadius;
    pilot.clearance = [&replanner](const Eigen::Vector3d& p_w) {
        return replanner.clearanceBeside(p_w);
    };
    return pilot;
}

std::vector<PlannedView> stayingAt(const UncertainPose& T_c_w, const Pose& T_b_c) {
    return hovering((T_b_c * T_c_w.mean).inverse(), T_c_w.covariance);
}

const Config& checked(const ExplorerOptions& options, const Robot& robot) {
    const Config& config = options.config;
    const Camera camera = config.camera.camera();
    if (camera.width != robot.camera().width || camera.height != robot.camera().height ||
        camera.intrinsics != robot.camera().intrinsics) {
        throw std::invalid_argument("exploration: the robot's camera is not that of the config");
    }
    if (!config.camera.T_b_c().isApprox(robot.T_b_c(), 1e-6)) {
        throw std::invalid_argument("exploration: the camera's mount is not that of the config");
    }
    if (options.known && options.known->getResolution() != config.explore.cell()) {
        throw std::invalid_argument("exploration: the known map's cells are not explore.cell()");
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
    : config_(checked(options, robot)),
      camera_(robot.camera()),
      T_b_c_(robot.T_b_c()),
      timing_(options.timing),
      interrupted_(interrupted),
      on_(std::move(on)),
      toStop_(stoppingDistance(options)),
      tube_(stoppingRadius(options, toStop_)),
      replanner_(config_, options.known.get(), explorePlanner(planner), seed, tube_),
      views_(replanner_.planner().views()),
      states_(*replanner_.map().cells()),
      mapper_(config_, options.known.get()),
      tracker_(trackerOf(robot, views(), beliefAtTakeOff(config_), trackerFor(options, mapper_))),
      pilot_(pilotOf(robot, stayingAt(beliefAtTakeOff(config_), T_b_c_), views(),
                     pilotFor(options, replanner_))) {
    record_.planner = planner;
    record_.seed = seed;
    record_.map = replanner_.map().cells();
    if (timing_ != Timing::byWork) background_.emplace(replanner_, kPlanTime);
}

bool Explorer::fly(Robot& robot, double timeStep, const OnFlightStep& onStep) {
    RealTimeRobot timed(robot,
                        timing_ == Timing::simulatedRealTime ? RealTimeRobot::Clock::wall
                                                             : RealTimeRobot::Clock::robot,
                        monitor_);
    bool isInterrupted = false;
    try {
        flyLoop(background_ ? timed : robot, tracker_, pilot_, timeStep, onStep);
    } catch (const Interrupted&) {
        isInterrupted = true;
    } catch (const MapTooLarge& error) {
        endAs(FlightEnd::noWay,
              fmt::format("{}; cells of {} m", error.what(), config_.explore.cell()));
    }
    finishRealTime();
    return !isInterrupted;
}

void Explorer::finishRealTime() {
    if (!background_) return;
    background_->stop();
    record_.realTime = monitor_.summary();
    record_.realTime->waited = background_->waited();
    record_.realTime->joined = background_->joined();
}

bool Explorer::onStep(const Observation& observation, const std::vector<TrackedFrame>& tracked) {
    time_ = observation.time;
    if (background_) {
        if (auto replanned = background_->poll()) takeOver(std::move(*replanned));
    }
    for (std::size_t i = 0; i < tracked.size(); ++i) {
        throwIfStopped(interrupted_);  // and between other steps that take long with large images
        corrections_.add(tracked[i]);
        onImage(tracked[i], observation.frames[i].view);
    }
    if (background_) background_->goOn(tracker_.belief());
    return !hasEnded();
}

/// Whether the robot is where its present plan ends, short of the goal, and no other one is made.
bool Explorer::isWaiting() const {
    if (isWhole_ || (background_ && background_->isBusy())) return false;
    return pilot_.route().isAtGoal() || time_ - lastUpdate_ > kWait;
}

void Explorer::onImage(const TrackedFrame& tracked, const View& image) {
    const bool isStopped = isInTheWay(tracked, image);
    View shown;
    views()->render(camera_, tracked.T_c_w.mean, shown);
    // While the second thread is busy, the first image that shows an obstacle is enough.
    const bool isBusy = background_ && background_->isBusy();
    const bool isNews = isStopped && !(isBusy && !notInMap_.empty());
    if (background_ && isStopped) notInMap_.emplace_back(tracked.time, inView_);
    auto input = mapper_.choose(tracked, image, shown, isWaiting() || isNews);
    record_.keyframes = mapper_.keyframes();
    throwIfStopped(interrupted_);
    if (!input && isNews) input = MapInput{image, shown, tracked.T_c_w};  // for the plan alone
    if (!input) return;
    ReplanRequest request{{std::move(*input)}, inView_, tracker_.belief(), tracked.time};
    if (background_) return background_->add(std::move(request));
    takeOver(replanner_.replan(std::move(request), {interrupted_}));
}

/// Whether an image shows that the way to be flown next is not free. In real time the robot then
/// flies only as far as it is, until it has another plan.
bool Explorer::isInTheWay(const TrackedFrame& tracked, const View& image) {
    if (image.depth.getSize() == 0) return false;
    inView_ = {image.depth, camera_, tracked.T_c_w.mean, states_,
               obstacleRange(config_, toStop_ + tube_)};
    const std::vector<PlannedView> ahead = wayAhead();
    std::vector<Eigen::Vector3d> way;
    way.reserve(ahead.size());
    for (const PlannedView& view : ahead) way.push_back(view.T_w_b.translation());
    const bool isOnWay = inView_.isOn(way, tube_);
    if (background_) {
        monitor_.onAnswer(tracked.time);
        if (isOnWay) {
            follow(fromHere({.plan = ahead, .isWhole = isWhole_}));
        }
    }
    return isOnWay || !inView_.newWalls().empty();
}

/// What is left of the present plan.
std::vector<PlannedView> Explorer::wayAhead() const {
    std::vector<PlannedView> way{{.T_w_b = here(), .covariance = tracker_.belief().covariance}};
    for (PlannedView view : pilot_.route().ahead()) {
        const Eigen::Vector3d leg = view.T_w_b.translation() - way.back().T_w_b.translation();
        view.distance = way.back().distance + leg.norm();
        way.push_back(view);
    }
    return way;
}

/// The part of a plan that is free in map and last image, for a robot that has flown on meanwhile.
FlyablePart Explorer::fromHere(const FlyablePart& way) const {
    const auto clearance = [this](const Eigen::Vector3d& p_w) {
        const auto inImage = [&](const ObstaclesInView& inView) {
            return clearanceInView(inView, p_w, config_.robotRadius, tube_);
        };
        double least = std::min(replanner_.clearanceBeside(p_w), inImage(inView_));
        for (const auto& [time, inView] : notInMap_) least = std::min(least, inImage(inView));
        return least;
    };
    // The Replanner has ended the way before unseen space.
    const auto isSeen = [](const Eigen::Vector3d&) { return true; };
    FlyablePart rest =
        flyablePart(continuedFrom(here(), way.plan),
                    {.clearance = clearance, .isSeen = isSeen, .radius = config_.robotRadius});
    rest.isWhole = rest.isWhole && way.isWhole;
    rest.isStopped = rest.isStopped || way.isStopped;
    rest.isBlind = way.isBlind;
    rest.isLook = way.isLook;
    return rest;
}

/// From now on the robot uses the new map and plan.
void Explorer::takeOver(Replanned replanned) {
    for (const MapInput& image : replanned.request.images) mapper_.setFused(image);
    states_.set(replanned.cells);
    std::erase_if(notInMap_,
                  [&](const auto& image) { return image.first <= replanned.request.imageTime; });
    views_ = replanned.views;
    tracker_.setMap(views());
    pilot_.setMap(views());
    if (replanned.hasMapGrown) blindSinceGrowth_ = 0;
    hasPath_ = !replanned.toGoal.empty();
    lastUpdate_ = time_;
    flyOn(std::move(replanned.way));
    PlanUpdate& update = replanned.update;
    update.time = time_;
    if (background_) monitor_.onPlan(replanned.request.imageTime, update.isEndedByClock);
    record_.updates.push_back(update);
    record_.plans.push_back(std::move(replanned.toGoal));
    if (on_.update) on_.update(record_);
    if (on_.moment) showMoment(std::move(replanned));
}

/// By the thread that made map and plan, which do not change until then.
void Explorer::showMoment(Replanned replanned) {
    const auto show = [this, made = std::make_shared<Replanned>(std::move(replanned))] {
        const MapInput& image = made->request.images.back();
        on_.moment({replanner_.planner(), replanner_.map(), made->change, image.T_c_w, image.image,
                    image.shown});
    };
    if (background_) return background_->run(show);
    show();
}

/// Gives the pilot the part of the plan that is safe, or lets it hover.
void Explorer::flyOn(std::optional<FlyablePart> way) {
    if (!way) return hover();
    // Hovering over the goal is not interrupted by a way of a few centimetres to it.
    if (isWhole_ && pilot_.route().isAtGoal()) return;
    if (background_) way = fromHere(*way);
    if (way->isStopped && !hasPath_) return hover();
    if (way->isLook && isLooking()) return;
    if (way->isBlind && !mayStepBlindly()) return hover();
    patience_.onWay(way->isStopped, time_);
    blindSinceGrowth_ += way->isBlind;
    record_.blindSteps += way->isBlind;
    follow(std::move(*way));
}

void Explorer::follow(FlyablePart part) {
    isWhole_ = part.isWhole;
    look_.reset();
    if (part.isLook) look_ = Look{yawOf(part.plan.back().T_w_b), time_};
    pilot_.setPlan(std::move(part.plan));
}

/// A robot between two ways that are as good as each other would turn to and fro: it first looks
/// where it began to look.
bool Explorer::isLooking() const {
    const double longest = kLongestLook + std::numbers::pi / config_.fly.turnRate;
    if (!look_ || time_ - look_->since > longest) return false;
    const double turn = std::remainder(look_->yaw - yawOf(here()), 2. * std::numbers::pi);
    return std::abs(turn) > kLooksThere;
}

bool Explorer::mayStepBlindly() const {
    switch (config_.explore.sensor) {
        case ExploreSensor::stereo:
            return false;
        case ExploreSensor::monocular:
            return record_.blindSteps < kMostMonocularSteps;
        case ExploreSensor::depth:
            break;
    }
    return blindSinceGrowth_ < kMostBlindSteps;
}

void Explorer::hover() {
    patience_.onNoWay(time_);
    follow({.plan = stayingAt(tracker_.belief(), T_b_c_)});
}

std::shared_ptr<const ViewSource> Explorer::views() const {
    return std::make_shared<InterruptibleViews>(views_, [this] { return interrupted_.load(); });
}

bool Explorer::endAs(FlightEnd end, const std::string& reason) {
    end_ = end;
    record_.reason = reason;
    return true;
}

std::string Explorer::reasonForNoWay() const {
    const double clearance = replanner_.clearanceBeside(config_.goal.position);
    if (clearance < config_.robotRadius && config_.explore.unknown == UnknownSpace::pessimistic) {
        return "the goal is not in space that was seen to be free";
    }
    if (clearance < config_.robotRadius) {
        const double sigma = largestSigma(tracker_.belief().covariance.topLeftCorner<3, 3>());
        return fmt::format(
            "the goal is in collision: clearance {:.2f} m in the map, where the "
            "robot knows its position to {:.2f} m",
            clearance, sigma);
    }
    if (hasPath_) return "the sensor cannot observe the space ahead";
    return "the map shows no way to the goal";
}

bool Explorer::hasEnded() {
    throwIfStopped(interrupted_);
    if (tracker_.loss().isLost() && pilot_.hasGivenUp(tracker_, time_)) {
        return endAs(FlightEnd::lost, "tracking was lost and not regained");
    }
    if (patience_.hasNoWay(time_)) {
        return endAs(FlightEnd::noWay, reasonForNoWay());
    }
    if (patience_.isStopped(time_)) {
        return endAs(FlightEnd::noWay, "an obstacle in view that is not in the map");
    }
    if (time_ > config_.explore.timeLimit) {
        return endAs(FlightEnd::outOfTime, "the time limit was reached");
    }
    const double toGoal = (here().translation() - config_.goal.position).norm();
    patience_.onStep(toGoal, isWhole_ && pilot_.route().isAtGoal(), time_);
    if (patience_.isStuckAtGoal(time_) || (isWhole_ && pilot_.hasArrived(tracker_, time_))) {
        return endAtGoal();
    }
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
    explorer.fly(robot, options.timeStep, step);
    static_cast<ExplorationRecord&>(outcome) = explorer.record();
    outcome.end = explorer.end().value_or(FlightEnd::stopped);
    outcome.arrival = explorer.arrival();
    return outcome;
}

}  // namespace photonav
