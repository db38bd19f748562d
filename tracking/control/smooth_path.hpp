// SPDX-License-Identifier: BSD-3-Clause
// A smooth curve close to the legs of a plan, and the speed along it within the limits of a MAV.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "control/motion_limits.hpp"

namespace photonav {

/// Position of a body in the world [m] and its heading [rad]; or their derivatives.
using Station = Eigen::Vector4d;

struct PathTolerance {
    double position = 0.05;  ///< [m]
    double yaw = 0.1;        ///< [rad]
};

/// A curve that bends as little as it can within a tolerance of the straight legs of a plan. It
/// starts and ends where the plan does.
///
/// Its parameter is the phase: the time at which a body would be there that flew the legs at the
/// limit of speed, or turned at the limit of yaw rate where that takes longer. A flight goes along
/// at a rate of up to 1: seconds of phase per second. Velocity is rate * derivative, acceleration
/// rate^2 * second derivative + change of rate * derivative.
///
/// The curve is a uniform quadratic B-spline: its second derivative is constant between knots, and
/// it stays within the convex hulls of three control points, each of which is within the tolerance.
class SmoothPath {
  public:
    /// @param corners of the plan, at least one; headings may be wrapped
    /// @throws std::invalid_argument without corners, or for limits or tolerances that are not
    /// positive
    SmoothPath(std::vector<Station> corners, const MotionLimits& limits,
               const PathTolerance& tolerance);

    /// Phase of the end [s].
    double end() const { return phases_.back(); }
    /// Phase of a corner of the plan [s].
    double phaseOf(std::size_t corner) const { return phases_[corner]; }

    /// A place on the legs of the plan.
    struct OnLeg {
        std::size_t from = 0;  ///< corner before it
        double share = 0.;     ///< of the leg that begins there
    };
    OnLeg legAt(double phase) const;

    struct Point {
        Station station;
        Station first;   ///< derivative by the phase
        Station second;  ///< second derivative
    };
    /// @param phase 0 to end(); below and beyond, the curve stays where it begins and ends
    Point at(double phase) const;

    /// The largest rate at which all limits hold from here to a stop at the end.
    double rateLimit(double phase) const;
    /// By how much the rate may grow [1/s] within the limits of acceleration.
    double rateGrowth(double phase, double rate) const;

  private:
    void measureLegs();
    Station onLegs(double phase) const;
    void relax(const PathTolerance& tolerance);
    void limitRates();
    Station control(std::ptrdiff_t i) const;
    Station slope(std::ptrdiff_t i) const { return (control(i + 1) - control(i)) / step_; }
    Station bend(std::ptrdiff_t i) const { return (slope(i) - slope(i - 1)) / step_; }

    MotionLimits limits_;
    std::vector<Station> corners_;  // headings unwrapped
    std::vector<double> phases_;    // of the corners [s]
    double step_ = 0.;              // of phase between control points [s]
    std::vector<Station> controls_;
    std::vector<double> squaredRates_;  // limits at the control points
};

}  // namespace photonav
