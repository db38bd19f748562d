// SPDX-License-Identifier: BSD-3-Clause
// Exploration: flies any robot to a goal in an unknown scene, using only the robot's measurements.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "exploration/patience.hpp"
#include "exploration/real_time_monitor.hpp"
#include "flight/arrival.hpp"
#include "flight/flight_end.hpp"
#include "flight/flight_loop.hpp"
#include "onlinemap/mapper.hpp"
#include "replanning/background_replanner.hpp"

namespace photonav {

/// Whether the robot waits for its planner.
enum class Timing {
    /// The robot waits until its plan is updated, which takes no time of the flight. Planning is
    /// limited by work: flights are deterministic.
    byWork,
    /// The robot flies on while a second thread updates map and plan, which is limited by the
    /// clock: flights are not reproducible. Robot::fly() takes the time that it flies.
    realTime,
    /// As realTime, with a simulated robot: the loop waits until each step would have been flown.
    simulatedRealTime
};

struct ExplorerOptions {
    /// Start, goal, camera, beliefs, and the section `explore`. Camera and mount must be those of
    /// the robot.
    Config config;
    /// Mount and blur are replaced by the robot's, map errors by those of the robot's map.
    TrackerOptions tracker;
    PilotOptions pilot;      ///< clearance and radii are replaced by those of the robot's map
    double timeStep = 0.02;  ///< time step of control and odometry [s]
    /// Longest time from an exposure to the arrival of the next image, if one image in between is
    /// missing [s].
    double imageAge = 0.55;
    double bodyRadius = 0.1;  ///< radius kept free of obstacles in the last image [m]
    /// What the robot knows of the world at take-off, with cells of config.explore.cell();
    /// null: nothing.
    std::shared_ptr<const TexturedOcTree> known = {};
    Timing timing = Timing::byWork;
};

/// The options that follow from a config, as `photonav explore` uses them, but for a robot whose
/// fly() takes its time: explore.realtime is Timing::realTime. Of the config in the options, the
/// size of the cells is that of a known map.
/// @throws InputError if explore.planners asks for headings and the space is not xyz_yaw, and as
///         loadKnownMap() does
ExplorerOptions explorerOptions(const Config& config);

/// The belief of T_c_w at take-off: the start of a config, with the covariance explore.initial in
/// the camera frame.
UncertainPose beliefAtTakeOff(const Config& config);

/// The course of an exploration, without ground truth.
struct ExplorationRecord {
    std::string planner;
    std::uint32_t seed = 0;
    std::string reason;  ///< why the flight ended without arrival; empty otherwise
    int keyframes = 0;   ///< number of images fused into the map
    int blindSteps = 0;  ///< number of steps into space that could not be observed first
    std::vector<PlanUpdate> updates;
    /// After every update: the waypoints to the goal, from above; empty: no way was known. Not kept
    /// in journals.
    std::vector<std::vector<Eigen::Vector2d>> plans;
    /// The map made by the robot; null: not kept. In real time it is written until the flight ends.
    std::shared_ptr<TexturedOcTree> map;
    std::optional<RealTimeSummary> realTime = {};  ///< of a flight in real time that has ended
};

/// The state right after an update of the plan, for logs and figures.
struct ExplorerMoment {
    const OnlinePlanner& planner;
    const OnlineMap& map;
    const MapChange& change;     ///< change of the map since the last update
    const UncertainPose& T_c_w;  ///< the belief
    const View& image;           ///< the image tracked last
    const View& predicted;       ///< view of the map before this update, from the believed pose
};

/// Callbacks after every update of the plan. They do not change the flight (but for its times, in
/// real time); each may be empty.
struct OnExplorer {
    std::function<void(const ExplorationRecord& soFar)> update = {};
    /// After `update` and before the next one. In real time it is called by the second thread.
    std::function<void(const ExplorerMoment& moment)> moment = {};
};

/// Tracker, pilot, map and planner of an exploring robot. While the robot flies, it extends its map
/// and repairs its plan:
///
///     every step:   take over map and plan, if they were updated            (takeOver)
///     every image:  is the way ahead free? If not, stop before the obstacle (isInTheWay)
///                   does it become part of the map?                         (Mapper)
///                   if so, update map and plan                              (Replanner)
///
/// Timing::byWork updates at once. In real time a second thread does (BackgroundReplanner), and all
/// else stays on the thread of the loop, which never waits for it.
class Explorer {
  public:
    /// @param robot gives camera, mount and blur
    /// @param planner a name for explorePlanner()
    /// @param interrupted rendering and planning end with Interrupted when it becomes true;
    ///        must outlive the explorer
    /// @throws std::invalid_argument for a robot whose camera or mount differs from the config's
    Explorer(const ExplorerOptions& options, const Robot& robot, const std::string& planner,
             std::uint32_t seed, const std::atomic<bool>& interrupted, OnExplorer on = {});
    Explorer(const Explorer&) = delete;
    Explorer& operator=(const Explorer&) = delete;

    Tracker& tracker() { return tracker_; }
    const Tracker& tracker() const { return tracker_; }
    Pilot& pilot() { return pilot_; }

    /// Flies until the end.
    /// @param onStep called after every step, in place of onStep() of this class, which it calls
    /// @return false if the flight was interrupted
    /// @throws whatever the robot, the callbacks or the second thread have thrown
    bool fly(Robot& robot, double timeStep, const OnFlightStep& onStep);

    /// Is to be called after every step. @return whether to fly on
    bool onStep(const Observation& observation, const std::vector<TrackedFrame>& tracked);

    const ExplorationRecord& record() const { return record_; }
    /// The end of the flight; none during the flight. FlightEnd::arrived means that the robot
    /// reported its arrival; the true position is not checked.
    std::optional<FlightEnd> end() const { return end_; }
    /// Position and arrival probability by the belief, for a flight that ended at the believed
    /// goal.
    const std::optional<BelievedArrival>& arrival() const { return arrival_; }

  private:
    void onImage(const TrackedFrame& tracked, const View& image);
    bool isInTheWay(const TrackedFrame& tracked, const View& image);
    std::vector<PlannedView> wayAhead() const;
    FlyablePart fromHere(const FlyablePart& way) const;
    void takeOver(Replanned replanned);
    void showMoment(Replanned replanned);
    void flyOn(std::optional<FlyablePart> way);
    bool isLooking() const;
    bool mayStepBlindly() const;
    void follow(FlyablePart part);
    void hover();
    bool isWaiting() const;
    bool hasEnded();
    bool endAtGoal();
    bool endAs(FlightEnd end, const std::string& reason);
    std::string reasonForNoWay() const;
    void finishRealTime();
    Pose bodyOf(const Pose& T_c_w) const { return (T_b_c_ * T_c_w).inverse(); }
    Pose here() const { return bodyOf(tracker_.belief().mean); }
    /// Renders views of the map that was taken over last.
    std::shared_ptr<const ViewSource> views() const;

    Config config_;
    Camera camera_;
    Pose T_b_c_;
    Timing timing_;
    const std::atomic<bool>& interrupted_;
    OnExplorer on_;
    double toStop_;  // stopping distance, from the exposure of an image on [m]
    double tube_;    // radius around the path that must be free in every depth image [m]
    Replanner replanner_;
    std::shared_ptr<const ViewSource> views_;  // of the map that was taken over last
    CellStates states_;                        // of this map
    Mapper mapper_;
    Tracker tracker_;
    Pilot pilot_;
    ObstaclesInView inView_;  // in the last image
    /// In images before that have stopped the robot, until its map has them: time, obstacles.
    std::vector<std::pair<double, ObstaclesInView>> notInMap_;
    double time_ = 0.;      // [s]
    bool hasPath_ = false;  // the planner has found one at the last update
    bool isWhole_ = false;  // the part of the plan being flown leads to the goal
    Patience patience_;
    struct Look {
        double yaw = 0.;    // [rad]
        double since = 0.;  // [s]
    };
    std::optional<Look> look_;  // that the robot turns to
    int blindSinceGrowth_ = 0;  // blind steps since the map last grew
    double lastUpdate_ = 0.;    // time of the last update [s]
    Corrections corrections_;
    ExplorationRecord record_;
    std::optional<FlightEnd> end_;
    std::optional<BelievedArrival> arrival_;
    RealTimeMonitor monitor_;
    std::optional<BackgroundReplanner> background_;  // in real time; last: ends before the others
};

/// The course and end of an exploration, without ground truth.
struct ExplorationOutcome : ExplorationRecord {
    FlightEnd end = FlightEnd::stopped;      ///< see Explorer::end()
    double duration = 0.;                    ///< [s]
    std::optional<BelievedArrival> arrival;  ///< see Explorer::arrival()
};

/// Explores with any robot.
/// @param planner a name for explorePlanner()
/// @param onStep called after each step before the explorer's own; may end the flight as
///        FlightEnd::stopped
/// @throws std::invalid_argument as Explorer does, and as Explorer::fly() does
ExplorationOutcome explore(Robot& robot, const ExplorerOptions& options, const std::string& planner,
                           std::uint32_t seed, const std::atomic<bool>& interrupted,
                           const OnExplorer& on = {}, const OnFlightStep& onStep = {});

}  // namespace photonav
