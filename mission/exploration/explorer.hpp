// SPDX-License-Identifier: BSD-3-Clause
// A robot that flies to a goal in a scene that it does not know. It is any robot: what it measures
// is all that is used.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "exploration/flyable_part.hpp"
#include "exploration/mapper.hpp"
#include "exploration/obstacles_in_view.hpp"
#include "exploration/online_planner.hpp"
#include "flight/arrival.hpp"
#include "flight/flight_end.hpp"
#include "flight/flight_loop.hpp"

namespace photonav {

struct ExplorerOptions {
    /// Start, goal, camera, beliefs, and the section `explore`. Its camera must be the robot's.
    Config config;
    /// Mount and sharpness are the robot's, its map errors those of the map.
    TrackerOptions tracker;
    PilotOptions pilot;      ///< its isFree asks the map
    double timeStep = 0.02;  ///< of control and odometry [s]
    /// Longest time from an exposure to the arrival of the next image, if that in between is
    /// missing [s].
    double imageAge = 0.55;
    double bodyRadius = 0.1;  ///< kept free of what the last image shows [m]
};

/// Options that follow from a config, as for the simulated robot of `photonav explore`.
/// @throws InputError for headings of explore.planners where the heading is not free
ExplorerOptions explorerOptions(const Config& config);

/// Of T_c_w: the start of a config, with the covariance explore.initial.
UncertainPose beliefAtTakeOff(const Config& config);

/// An exploration as the robot itself knows it.
struct ExplorationRecord {
    std::string planner;
    std::uint32_t seed = 0;
    std::string reason;  ///< of an end that is not arrived
    int keyframes = 0;
    int blindSteps = 0;  ///< into space that could not be looked at first
    std::vector<PlanUpdate> updates;
    std::shared_ptr<TexturedOcTree> map;  ///< that the robot made; empty: not kept
};

/// The moment right after an update of the plan, for logs and figures.
struct ExplorerMoment {
    const OnlinePlanner& planner;
    const OwnMap& map;
    const MapChange& change;     ///< of the map, since the last moment
    const UncertainPose& T_c_w;  ///< believed
    const View& image;           ///< that was tracked last
    const View& predicted;       ///< view of the map before this update, from the believed pose
};

/// Callbacks after every update of the plan. They do not change the flight; each may be empty.
struct OnExplorer {
    std::function<void(const ExplorationRecord& soFar)> update = {};
    std::function<void(const ExplorerMoment& moment)> moment = {};  ///< after `update`
};

/// Tracker, pilot, own map and planner, for flyLoop(): the map is made, and the plan repaired, as
/// the scene comes into view. Deterministic for a seed and what the robot measures: planning ends
/// by work, not by time.
class Explorer {
  public:
    /// @param robot its camera, mount and sharpness are used; @param planner as explorePlanner()
    /// takes it
    /// @param interrupted views and plans end with RenderingStopped when it becomes true; must
    ///        outlive the explorer
    /// @throws std::invalid_argument for a robot with another camera or mount than the config's
    Explorer(const ExplorerOptions& options, const Robot& robot, const std::string& planner,
             std::uint32_t seed, const std::atomic<bool>& interrupted, OnExplorer on = {});
    Explorer(const Explorer&) = delete;
    Explorer& operator=(const Explorer&) = delete;

    Tracker& tracker() { return tracker_; }
    const Tracker& tracker() const { return tracker_; }
    Pilot& pilot() { return pilot_; }

    /// After every step of flyLoop(). @return whether to fly on
    bool onStep(const Observation& observation, const std::vector<TrackedFrame>& tracked);

    const ExplorationRecord& record() const { return record_; }
    /// None while it is flown. Arrived: reported at the goal, which is not checked.
    std::optional<FlightEnd> end() const { return end_; }
    /// Of a flight that ended at its believed goal.
    const std::optional<BelievedArrival>& arrival() const { return arrival_; }

  private:
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
    bool endAs(FlightEnd end, const std::string& reason);
    std::string reasonForNoWay() const;
    Pose bodyOf(const Pose& T_c_w) const { return (T_b_c_ * T_c_w).inverse(); }
    bool isInTheWay(const TrackedFrame& tracked, const View& image);
    double clearance(const Eigen::Vector3d& p_w) const;
    /// Views of the present map.
    std::shared_ptr<const ViewSource> views() const;

    Config config_;
    Camera camera_;
    Pose T_b_c_;
    const std::atomic<bool>& interrupted_;
    OnExplorer on_;
    OwnMap map_;
    OnlinePlanner planner_;
    Tracker tracker_;
    Pilot pilot_;
    SpaceAhead space_;
    Mapper mapper_;
    double toStop_;           // flown until the robot stands, from an image on [m]
    double tube_;             // radius of the way that must be free in every depth image [m]
    ObstaclesInView inView_;  // of the last image
    double time_ = 0.;        // [s]
    bool isWhole_ = false;    // the plan flown leads to the goal
    int withoutWay_ = 0;      // updates in a row
    std::optional<double> stoppedSince_;  // by an obstacle in view [s]
    int blindInVain_ = 0;                 // steps since the map last grew
    double lastUpdate_ = 0.;              // [s]
    std::optional<double> atGoalSince_;   // reached, and not left by far [s]
    Corrections corrections_;
    ExplorationRecord record_;
    std::optional<FlightEnd> end_;
    std::optional<BelievedArrival> arrival_;
};

/// The end of an exploration, as the robot itself knows it.
struct ExplorationOutcome : ExplorationRecord {
    FlightEnd end = FlightEnd::stopped;  ///< arrived: reported at the goal, which is not checked
    double duration = 0.;                ///< [s]
    std::optional<BelievedArrival> arrival;  ///< of a flight that ended at its believed goal
};

/// Explores with any robot.
/// @param onStep may look at each step, and end the flight as stopped
/// @throws std::invalid_argument as Explorer does
ExplorationOutcome explore(Robot& robot, const ExplorerOptions& options, const std::string& planner,
                           std::uint32_t seed, const std::atomic<bool>& interrupted,
                           const OnExplorer& on = {}, const OnFlightStep& onStep = {});

}  // namespace photonav
