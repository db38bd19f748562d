// SPDX-License-Identifier: BSD-3-Clause
// Beliefs along motions: propagation and update by views at fixed steps, and what that costs.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "belief/information_field.hpp"
#include "geometry/constants.hpp"
#include "geometry/uncertain_pose.hpp"
#include "space/flight_space.hpp"

namespace photonav {

/// How uncertainty is charged along a motion.
enum class CostRule {
    integral,  ///< (1 - alpha) kappa times the integral of the trace over the distance flown
    perVertex  ///< the paper's eq. (22): (1 - alpha) kappa tr(Sigma) at each vertex, one view there
};

struct BeliefOptions {
    double alpha = 0.1;  ///< trade-off in [0, 1]: 1 is the shortest path, 0 the most certain one
    double kappa =
        2.5;           ///< metres of detour that 1 m of flight at tr(Sigma) = 1 m^2 is worth [1/m]
    double ds = 0.25;  ///< distance flown between views [m]
    bool viewAtStart = true;            ///< a flight takes its first image where it begins
    double characteristicLength = 1.0;  ///< weighs rad^2 against m^2 in the trace [m]
    PropagationOrder order = PropagationOrder::fourth;
    CostRule cost = CostRule::integral;
    Matrix6 initialCovariance = Matrix6::Zero();  ///< at the start, body frame
    Matrix6 motionNoise = Matrix6::Zero();        ///< per metre of motion, body frame

    /// @throws std::invalid_argument for alpha outside [0, 1], kappa < 0, ds <= 0, a covariance
    ///         that is not symmetric positive semi-definite
    void check() const;
};

/// The belief at a vertex: covariance of T_c_w and cost-to-come.
///
/// The covariance is about the camera centre in world-oriented axes: of xi' = diag(R_w_c, R_w_c) xi
/// with T_c_w = exp(xi^) mean, order (rho, phi). Its trace is that of the covariance in the camera
/// frame; the adjoint of a motion is [1 t^; 0 1], whatever the camera's rotation does.
struct Belief {
    Matrix6 covariance = Matrix6::Zero();
    double cost = 0.;
};

/// A straight motion between two states, cut in equal steps no longer than ds. Keeps the views
/// along it, so that other beliefs can be propagated along it, in both directions.
struct Motion {
    const ompl::base::State* from = nullptr;
    const ompl::base::State* to = nullptr;
    double length = 0.;  ///< metric of the flight space [m]
    int steps = 0;
    /// steps + 1 of them, null where none was asked for yet; or none at all
    std::vector<const InformationField::Entry*> views;
    std::uint32_t epoch = 0;  ///< of the field, when the views that are there were current
};

/// One point of an evaluated path.
struct BeliefPoint {
    Pose T_w_b = Pose::Identity();
    double length = 0.;                     ///< length of the path of the position so far [m]
    double distance = 0.;                   ///< distance so far, metric of the flight space [m]
    Matrix6 covariance = Matrix6::Zero();   ///< after the update, camera frame
    double traceBefore = 0.;                ///< weighted trace before the update
    double trace = 0.;                      ///< weighted trace after the update
    double cost = 0.;                       ///< cost so far
    Matrix6 information = Matrix6::Zero();  ///< of the view from here, camera frame
    bool isWaypoint = false;                ///< a state of the path, not a step in between
};

/// Beliefs along motions and what they cost. Where the field has penalties instead of information,
/// penalties are charged in place of the trace, and beliefs keep the covariance of the start: no
/// cost depends on it.
class BeliefModel {
  public:
    /// @throws std::invalid_argument as BeliefOptions::check()
    /// @param field information or penalty of views; may be shared, so that no view is rendered
    ///        twice
    BeliefModel(const FlightSpace& space, std::shared_ptr<InformationField> field,
                const BeliefOptions& options);

    /// The belief at the start of a flight, at cost 0: the initial covariance, updated by the view
    /// from there if the options say so.
    Belief root(const ompl::base::State* start);

    Motion motion(const ompl::base::State* from, const ompl::base::State* to) const;

    /// The belief at the end of a motion (at its beginning, if flown backward).
    /// For each step: propagate, charge, update by the view at the end of the step. A step shorter
    /// than ds counts as its share of a view, so the same path gives the same information wherever
    /// its vertices are.
    Belief propagate(const Belief& belief, Motion& motion, bool backward = false) {
        return *propagateWithin(kInfinity, belief, motion, backward);
    }

    /// The same, but nothing if the cost at the end exceeds a limit: as soon as this is certain, no
    /// more views are rendered.
    std::optional<Belief> propagateWithin(double limit, const Belief& belief, Motion& motion,
                                          bool backward = false);

    /// Cost of a motion that no belief can undercut: alpha times its length.
    double lowerBound(double length) const { return options_.alpha * length; }

    /// A higher one: the noise of each step is charged before the next view.
    double lowerBound(const Motion& motion) const {
        return lowerBound(motion.length) + leastCharge(motion);
    }

    /// The belief at every step of a path. A slow and independent implementation (compound() in the
    /// camera frame, Eigen's LU, its own poses and costs) to check propagate().
    std::vector<BeliefPoint> evaluate(const std::vector<const ompl::base::State*>& path);

    /// One motion of evaluate(): appends its steps to `points`, whose last one is the beginning.
    void evaluateMotion(const ompl::base::State* from, const ompl::base::State* to,
                        std::vector<BeliefPoint>& points);

    /// Fisher information of the view from a body pose, in the camera frame of that pose.
    Matrix6 informationAt(const Pose& T_w_b);

    /// Weighted trace of the motion noise per metre.
    double noiseTrace() const { return trace(noiseCamera_); }

    /// The initial covariance before any view, camera frame.
    const Matrix6& initialCovariance() const { return initialCamera_; }

    /// A belief's covariance at a state, camera frame, as in results and files.
    Matrix6 cameraCovariance(const ompl::base::State* state, const Belief& belief) const;

    const FlightSpace& space() const { return space_; }
    const BeliefOptions& options() const { return options_; }
    InformationField& field() const { return *field_; }
    const std::shared_ptr<InformationField>& sharedField() const { return field_; }

    std::size_t fallbacks() const { return fallbacks_; }  ///< steps for which fourth order failed
    double seconds() const { return seconds_; }           ///< spent in propagate(), views excluded
    void clear();                                         ///< resets the counters, not the field

  private:
    std::optional<Belief> propagateNow(double limit, const Belief& belief, Motion& motion,
                                       bool backward);
    void updateViews(Motion& motion);
    const InformationField::Entry& viewAt(Motion& motion, int k);
    double leastCharge(const Motion& motion) const;
    Belief chargePenalties(const Belief& belief, const Motion& motion, bool backward) const;
    double penaltyAt(const Motion& motion, int k) const;
    BeliefPoint penalisedPoint(const BeliefPoint& last, const Motion& motion, int k);
    Pose cameraPose(const Motion& motion, int k) const;  // T_w_c after k steps
    double trace(const Matrix6& covariance) const {
        return weightedTrace(covariance, options_.characteristicLength);
    }

    FlightSpace space_;
    std::shared_ptr<InformationField> field_;
    BeliefOptions options_;
    Matrix6 initialCamera_;  // options_.initialCovariance in the camera frame
    Matrix6 noiseCamera_;    // options_.motionNoise in the camera frame
    std::size_t fallbacks_ = 0;
    double seconds_ = 0.;
};

}  // namespace photonav
