// SPDX-License-Identifier: BSD-3-Clause
#include "space/flight_space.hpp"

#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <ompl/util/GeometricEquations.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "geometry/se3.hpp"

namespace photonav {
namespace ob = ompl::base;
namespace {

constexpr double kFlat = 1e-9;      // an extent below this [m] is no direction to plan in
constexpr double kMinStep = 0.005;  // shortest advance of the motion check [m]

ob::RealVectorBounds toOmpl(const Eigen::AlignedBox3d& box) {
    ob::RealVectorBounds bounds(3);
    for (unsigned i = 0; i < 3; ++i) {
        bounds.setLow(i, box.min()[i]);
        bounds.setHigh(i, box.max()[i]);
    }
    return bounds;
}

ob::StateSpacePtr makeSpace(StateKind kind, const Eigen::AlignedBox3d& box, double rotationWeight) {
    if (kind == StateKind::se3) {
        auto space = std::make_shared<ob::SE3StateSpace>();
        space->setBounds(toOmpl(box));
        space->setSubspaceWeight(1, 2. * rotationWeight);  // OMPL's SO(3) metric is half the angle
        return space;
    }
    auto position = std::make_shared<ob::RealVectorStateSpace>(3);
    position->setBounds(toOmpl(box));
    if (kind == StateKind::position) return position;
    auto space = std::make_shared<ob::CompoundStateSpace>();
    space->addSubspace(position, 1.0);
    space->addSubspace(std::make_shared<ob::SO2StateSpace>(), rotationWeight);
    return space;
}

/// One of OMPL's samplers with a generator of its own seed.
template <typename Sampler>
class Seeded : public Sampler {
  public:
    Seeded(const ob::StateSpace* space, std::uint32_t seed) : Sampler(space) {
        this->rng_.setLocalSeed(seed);
    }
};

class ClearanceChecker : public ob::StateValidityChecker {
  public:
    ClearanceChecker(ob::SpaceInformation* si, const FlightSpace& space, Clearance clearance,
                     double radius)
        : ob::StateValidityChecker(si),
          space_(space),
          clearance_(std::move(clearance)),
          radius_(radius) {}

    bool isValid(const ob::State* state) const override {
        return si_->satisfiesBounds(state) && clearance(state) > radius_;
    }

    double clearance(const ob::State* state) const override {
        return clearance_(space_.position(state));
    }

  private:
    FlightSpace space_;
    Clearance clearance_;
    double radius_;
};

/// Checks straight motions. The position moves on a line whatever the rotation does, and the robot
/// is a sphere, so only the line is checked.
class ClearanceMotionValidator : public ob::MotionValidator {
  public:
    ClearanceMotionValidator(ob::SpaceInformation* si, const FlightSpace& space,
                             Clearance clearance, double radius)
        : ob::MotionValidator(si),
          space_(space),
          clearance_(std::move(clearance)),
          radius_(radius) {}

    bool checkMotion(const ob::State* from, const ob::State* to) const override {
        const bool isFree = si_->isValid(to) && reachableFraction(from, to) >= 1.;
        (isFree ? valid_ : invalid_)++;
        return isFree;
    }

    bool checkMotion(const ob::State* from, const ob::State* to,
                     std::pair<ob::State*, double>& lastValid) const override {
        const double reached = reachableFraction(from, to);
        (reached >= 1. ? valid_ : invalid_)++;
        if (reached >= 1.) return true;
        lastValid.second = reached;
        if (lastValid.first != nullptr) {
            si_->getStateSpace()->interpolate(from, to, reached, lastValid.first);
        }
        return false;
    }

  private:
    double reachableFraction(const ob::State* from, const ob::State* to) const {
        const Eigen::Vector3d start = space_.position(from);
        const Eigen::Vector3d motion = space_.position(to) - start;
        const double length = motion.norm();
        double travelled = 0.;
        while (travelled < length) {
            const double margin = clearance_(start + motion * (travelled / length)) - radius_;
            if (margin <= 0.) return std::max(0., travelled - kMinStep) / length;
            travelled += std::max(margin, kMinStep);
        }
        return si_->isValid(to) ? 1. : std::max(0., length - kMinStep) / std::max(length, kMinStep);
    }

    FlightSpace space_;
    Clearance clearance_;
    double radius_;
};

}  // namespace

FlightSpace::FlightSpace(StateKind kind, const Eigen::AlignedBox3d& bounds, double rotationWeight,
                         double fixedHeading)
    : kind_(kind),
      bounds_(bounds),
      rotationWeight_(rotationWeight),
      fixedRotation_(levelPose(Eigen::Vector3d::Zero(), fixedHeading).linear()) {
    if (bounds.isEmpty()) throw std::invalid_argument("flight space: empty bounds");
    if (!(rotationWeight >= 0.)) throw std::invalid_argument("flight space: negative weight");
    space_ = makeSpace(kind, bounds, rotationWeight);
}

Eigen::Vector3d FlightSpace::position(const ob::State* state) const {
    switch (kind_) {
        case StateKind::position: {
            const auto* s = state->as<ob::RealVectorStateSpace::StateType>();
            return {s->values[0], s->values[1], s->values[2]};
        }
        case StateKind::positionYaw: {
            const auto* s =
                state->as<ob::CompoundState>()->as<ob::RealVectorStateSpace::StateType>(0);
            return {s->values[0], s->values[1], s->values[2]};
        }
        case StateKind::se3:
            break;
    }
    const auto* s = state->as<ob::SE3StateSpace::StateType>();
    return {s->getX(), s->getY(), s->getZ()};
}

Pose FlightSpace::bodyPose(const ob::State* state) const {
    Pose T_w_b = Pose::Identity();
    T_w_b.translation() = position(state);
    T_w_b.linear() = fixedRotation_;
    if (kind_ == StateKind::positionYaw) {
        const double yaw =
            state->as<ob::CompoundState>()->as<ob::SO2StateSpace::StateType>(1)->value;
        return levelPose(T_w_b.translation(), yaw);
    }
    if (kind_ == StateKind::se3) {
        const auto& q = state->as<ob::SE3StateSpace::StateType>()->rotation();
        T_w_b.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
    }
    return T_w_b;
}

Pose FlightSpace::poseBetween(const ob::State* from, const ob::State* to, double fraction) const {
    if (fraction <= 0.) return bodyPose(from);
    if (fraction >= 1.) return bodyPose(to);
    const Pose begin = bodyPose(from);
    const Pose end = bodyPose(to);
    if (kind_ != StateKind::position) return interpolate(begin, end, fraction);
    Pose T_w_b = begin;  // the heading stays: no turn is worth computing
    T_w_b.translation() += fraction * (end.translation() - begin.translation());
    return T_w_b;
}

void FlightSpace::setState(ob::State* state, const Eigen::Vector3d& position, double yaw) const {
    setPosition(state, position);
    if (kind_ == StateKind::se3) {
        state->as<ob::SE3StateSpace::StateType>()->rotation().setAxisAngle(0., 0., 1., yaw);
    } else if (kind_ == StateKind::positionYaw) {
        auto* heading = state->as<ob::CompoundState>()->as<ob::SO2StateSpace::StateType>(1);
        heading->value = yaw;
        space_->as<ob::CompoundStateSpace>()->getSubspace(1)->enforceBounds(heading);
    }
}

void FlightSpace::setPosition(ob::State* state, const Eigen::Vector3d& position) const {
    if (kind_ == StateKind::se3) {
        state->as<ob::SE3StateSpace::StateType>()->setXYZ(position.x(), position.y(), position.z());
        return;
    }
    const auto* vector =
        kind_ == StateKind::position
            ? state->as<ob::RealVectorStateSpace::StateType>()
            : state->as<ob::CompoundState>()->as<ob::RealVectorStateSpace::StateType>(0);
    Eigen::Map<Eigen::Vector3d>{vector->values} = position;
}

ob::StateSamplerPtr FlightSpace::sampler(std::uint32_t seed) const {
    using PositionSampler = Seeded<ob::RealVectorStateSampler>;
    if (kind_ == StateKind::position) return std::make_shared<PositionSampler>(space_.get(), seed);
    const auto& parts = *space_->as<ob::CompoundStateSpace>();
    auto sampler = std::make_shared<ob::CompoundStateSampler>(space_.get());
    const auto* positions = parts.getSubspace(0).get();
    const auto* rotations = parts.getSubspace(1).get();
    sampler->addSampler(std::make_shared<PositionSampler>(positions, seed), 1.);
    if (kind_ == StateKind::se3) {
        sampler->addSampler(std::make_shared<Seeded<ob::SO3StateSampler>>(rotations, ~seed), 1.);
    } else {
        sampler->addSampler(std::make_shared<Seeded<ob::SO2StateSampler>>(rotations, ~seed), 1.);
    }
    return sampler;
}

int FlightSpace::positionDimensions() const {
    return std::max(1, static_cast<int>((bounds_.sizes().array() > kFlat).count()));
}

int FlightSpace::rotationDimensions() const {
    if (rotationWeight_ <= 0. || kind_ == StateKind::position) return 0;
    return kind_ == StateKind::se3 ? 3 : 1;
}

double FlightSpace::measure() const {
    double volume = 1.;
    for (const double extent : bounds_.sizes()) volume *= extent > kFlat ? extent : 1.;
    // Unit quaternions make SO(3) half of S^3, pi^2, in half angles: 8 pi^2 in angles.
    constexpr double pi = std::numbers::pi;
    const std::array<double, 4> angles{1., 2. * pi, 0., 8. * pi * pi};
    const int m = rotationDimensions();
    return volume * std::pow(rotationWeight_, m) * angles[m];
}

/// The volume of |p| + |r| <= 1 for k and m dimensions: V_k V_m k! m! / (k + m)!.
double FlightSpace::unitBallMeasure() const {
    const int k = positionDimensions();
    const int m = rotationDimensions();
    const double product = ompl::unitNBallMeasure(k) * (m > 0 ? ompl::unitNBallMeasure(m) : 1.);
    return product * std::tgamma(k + 1.) * std::tgamma(m + 1.) / std::tgamma(k + m + 1.);
}

ob::SpaceInformationPtr makeSpaceInformation(const FlightSpace& space, Clearance clearance,
                                             double radius) {
    auto si = std::make_shared<ob::SpaceInformation>(space.space());
    si->setStateValidityChecker(
        std::make_shared<ClearanceChecker>(si.get(), space, clearance, radius));
    si->setMotionValidator(
        std::make_shared<ClearanceMotionValidator>(si.get(), space, std::move(clearance), radius));
    si->setup();
    return si;
}

}  // namespace photonav
