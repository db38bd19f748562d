// SPDX-License-Identifier: BSD-3-Clause
// Beliefs along motions: propagation, update by views at fixed steps, and the cost of a motion.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "belief/information_field.hpp"
#include "geometry/constants.hpp"
#include "geometry/uncertain_pose.hpp"
#include "space/flight_space.hpp"

namespace photonav {

/// How the cost of a path depends on the uncertainty along it.
enum class CostRule {
    integral,  ///< (1 - alpha) kappa times the integral of the trace over the distance flown
    perVertex  ///< the paper's eq. (22): (1 - alpha) kappa tr(Sigma) at each vertex, one view there
};

struct BeliefOptions {
    double alpha = 0.1;  ///< trade-off in [0, 1]: 1 is the shortest path, 0 the most certain one
    /// Weight of uncertainty against length: 1 m of flight at tr(Sigma) = 1 m^2 weighs as much as
    /// kappa metres of detour [1/m^2; 1/m by CostRule::perVertex].
    double kappa = 2.5;
    double ds = 0.25;                   ///< distance flown between views [m]
    bool viewAtStart = true;            ///< update the belief at the start by the view from there
    double characteristicLength = 1.0;  ///< weighs rad^2 against m^2 in the trace [m]
    PropagationOrder order = PropagationOrder::fourth;
    CostRule cost = CostRule::integral;
    Matrix6 initialCovariance = Matrix6::Zero();  ///< at the start, body frame
    Matrix6 motionNoise = Matrix6::Zero();        ///< per metre of motion, body frame

    /// @throws std::invalid_argument for alpha outside [0, 1], kappa < 0, ds <= 0, a covariance
    ///        that is not symmetric positive semi-definite
    void check() const;
};

/// The belief at a vertex: covariance of T_c_w and cost-to-come.
///
/// The perturbation is about the camera centre in world-oriented axes: with T_c_w = exp(xi^) mean,
/// xi = (rho, phi) in the camera frame, the covariance is one of xi' = diag(R_w_c, R_w_c) xi. It
/// has the same trace as the covariance in the camera frame. In these axes the adjoint of a motion
/// is [1 t^; 0 1] for any rotation of the camera.
struct Belief {
    Matrix6 covariance = Matrix6::Zero();
    double cost = 0.;
};

/// A straight motion between two states, divided into equal steps no longer than ds (one step by
/// CostRule::perVertex). It stores the views at the ends of the steps, so that several beliefs can
/// be propagated along it, in both directions. The states must outlive it.
struct Motion {
    const ompl::base::State* from = nullptr;
    const ompl::base::State* to = nullptr;
    double length = 0.;  ///< metric of the flight space [m]
    int steps = 0;
    /// steps + 1 views, null where a view was not needed yet; empty before the first propagation.
    std::vector<const InformationField::Entry*> views;
    std::uint32_t epoch = 0;  ///< epoch of the field at which `views` were current
};

/// One point of an evaluated path.
struct BeliefPoint {
    Pose T_w_b = Pose::Identity();
    double length = 0.;                     ///< distance that the position has travelled [m]
    double distance = 0.;                   ///< distance so far, metric of the flight space [m]
    Matrix6 covariance = Matrix6::Zero();   ///< after the update, camera frame
    double traceBefore = 0.;                ///< weighted trace before the update [m^2]
    double trace = 0.;                      ///< weighted trace after the update [m^2]
    double cost = 0.;                       ///< cost so far
    Matrix6 information = Matrix6::Zero();  ///< of the view from here, camera frame
    bool isWaypoint = false;                ///< whether it is a state of the path, not a step
};

/// Computes beliefs and costs along motions. If the field has penalties instead of information,
/// penalties replace the trace in the cost. Beliefs then keep the covariance of the start, which no
/// cost depends on.
class BeliefModel {
  public:
    /// @throws std::invalid_argument as BeliefOptions::check()
    /// @param field information or penalties of views; models may share a field, so that no view is
    ///        rendered twice
    BeliefModel(const FlightSpace& space, std::shared_ptr<InformationField> field,
                const BeliefOptions& options);

    /// The belief at the start of a flight, at cost 0: the initial covariance, updated by the view
    /// from there if BeliefOptions::viewAtStart is set.
    Belief root(const ompl::base::State* start);

    /// The motion between two states, without views.
    Motion motion(const ompl::base::State* from, const ompl::base::State* to) const;

    /// The belief at the end of a motion (at its beginning, if flown backward). For each step:
    /// propagate the covariance, add to the cost, update by the view at the end of the step. The
    /// information of this view is multiplied by (length of the step) / ds, so that a path gives
    /// the same information wherever its vertices are (CostRule::perVertex: not multiplied).
    /// Costs never fall along a motion, or a tree could get a cycle: if a covariance is not
    /// positive semi-definite, so that the cost would fall, it becomes infinite.
    Belief propagate(const Belief& belief, Motion& motion, bool backward = false) {
        return *propagateWithin(kInfinity, belief, motion, backward);
    }

    /// As propagate(), but returns nothing if the cost at the end exceeds `limit`, and renders no
    /// more views as soon as this is certain. The limit is not applied to penalties or by
    /// CostRule::perVertex.
    std::optional<Belief> propagateWithin(double limit, const Belief& belief, Motion& motion,
                                          bool backward = false);

    /// Lower bound on the cost of a motion, for any belief: alpha times its length.
    double lowerBound(double length) const { return options_.alpha * length; }

    /// A tighter lower bound. It adds the cost of the motion noise: the noise of a step is in the
    /// trace at the end of the step, before the next view can reduce it.
    double lowerBound(const Motion& motion) const {
        return lowerBound(motion.length) + leastCharge(motion);
    }

    /// The belief at every step of a path. A slow and independent implementation (compound() in the
    /// camera frame, Eigen's LU, its own poses and costs) to check propagate().
    /// @param root belief at the first state; none: the initial covariance, and the view from there
    std::vector<BeliefPoint> evaluate(const std::vector<const ompl::base::State*>& path,
                                      const std::optional<Belief>& root = {});

    /// One motion of evaluate(): appends its steps to `points`.
    /// @param points the last one is the belief at the beginning of the motion
    void evaluateMotion(const ompl::base::State* from, const ompl::base::State* to,
                        std::vector<BeliefPoint>& points);

    /// Fisher information of the view from a body pose, in the camera frame of that pose.
    Matrix6 informationAt(const Pose& T_w_b);

    /// Weighted trace of the motion noise per metre [m^2/m].
    double noiseTrace() const { return trace(noiseCamera_); }

    /// The initial covariance before any view, camera frame.
    const Matrix6& initialCovariance() const { return initialCamera_; }

    /// The covariance of a belief at a state, expressed in the camera frame as in results and
    /// files.
    Matrix6 cameraCovariance(const ompl::base::State* state, const Belief& belief) const;

    const FlightSpace& space() const { return space_; }
    const BeliefOptions& options() const { return options_; }
    InformationField& field() const { return *field_; }
    const std::shared_ptr<InformationField>& sharedField() const { return field_; }

    /// Number of steps for which fourth-order propagation fell back to second order.
    std::size_t fallbacks() const { return fallbacks_; }
    double seconds() const { return seconds_; }  ///< time spent in propagate() without views [s]
    void clear();                                ///< resets both counters, not the field

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
