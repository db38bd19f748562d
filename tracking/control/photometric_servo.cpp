// SPDX-License-Identifier: BSD-3-Clause
#include "control/photometric_servo.hpp"

#include "alignment/image_pyramid.hpp"
#include "control/mav_task.hpp"
#include "geometry/se3.hpp"
#include "photometry/luminance_feature.hpp"

namespace photonav {
namespace {

/// sum (a - b)^2 / sum of both variances: 0 for equal images, 1 for unrelated ones.
double unexplainedShare(const ImageF& a, const ImageF& b) {
    double difference = 0.;
    double sumA = 0., sumB = 0., squaresA = 0., squaresB = 0.;
    for (unsigned i = 0; i < a.getSize(); ++i) {
        const double x = a.bitmap[i];
        const double y = b.bitmap[i];
        difference += (x - y) * (x - y);
        sumA += x;
        sumB += y;
        squaresA += x * x;
        squaresB += y * y;
    }
    const double n = a.getSize();
    const double both = squaresA - sumA * sumA / n + squaresB - sumB * sumB / n;
    return both > 0. ? std::min(1., difference / both) : 1.;
}

/// Largest standard deviation that the view leaves in the four velocities' displacements.
double worstSigma(const View& goal, const Camera& camera, const Pose& T_b_c,
                  const PhotometricOptions& options) {
    const vpMatrix J = vpVelocityTwistMatrix(toVisp(Pose(T_b_c.inverse()))) * mavJacobian();
    Eigen::Matrix<double, 6, 4> velocities;
    for (unsigned i = 0; i < 6; ++i) {
        for (unsigned j = 0; j < 4; ++j) velocities(i, j) = J[i][j];
    }
    const Eigen::Matrix4d Lambda =
        velocities.transpose() * photometricInformation(goal, camera, options) * velocities;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(Lambda, Eigen::EigenvaluesOnly);
    return 1. / std::sqrt(std::max(solver.eigenvalues()[0], 1e-12));
}

}  // namespace

/// At half the size: a quarter of the work, twice the convergence.
struct PhotometricServo::Impl {
    const ViewSource& map;
    PhotometricServoOptions options;
    Camera camera;
    Pose T_b_c, T_w_goal;
    View goal;
    double sigma;
    PixelDepthLuminance s, sd;
    vpServo task;

    Impl(const ViewSource& map_, const Camera& full, const Pose& mount, const Pose& goal_,
         const PhotometricServoOptions& o)
        : map(map_), options(o), camera(halved(full)), T_b_c(mount), T_w_goal(goal_) {
        map.render(full, (T_w_goal * T_b_c).inverse(), goal);
        sigma = worstSigma(goal, full, T_b_c, options.photometric);
        setUpMavTask(task, T_b_c, options.gain);
        task.setInteractionMatrixType(vpServo::DESIRED);
        task.setForceInteractionMatrixComputation(true);
        task.addFeature(s, sd);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() { task.kill(); }

    /// Tilt cannot be commanded: the goal as the body would see it that hangs as it does.
    void aimAt(const Pose& T_w_b) {
        Pose hanging = T_w_goal;
        hanging.linear() =
            Eigen::AngleAxisd(yawOf(T_w_goal) - yawOf(T_w_b), Eigen::Vector3d::UnitZ()) *
            T_w_b.linear();
        map.render(camera, (hanging * T_b_c).inverse(), goal);
        sd.buildFrom(goal, camera, options.photometric);
    }
};

PhotometricServo::PhotometricServo(const ViewSource& map, const Camera& camera, const Pose& T_b_c,
                                   const Pose& T_w_goal, const PhotometricServoOptions& options)
    : impl_(std::make_unique<Impl>(map, camera, T_b_c, T_w_goal, options)) {}
PhotometricServo::~PhotometricServo() = default;
PhotometricServo::PhotometricServo(PhotometricServo&&) noexcept = default;
PhotometricServo& PhotometricServo::operator=(PhotometricServo&&) noexcept = default;

bool PhotometricServo::isInformative() const { return impl_->sigma < impl_->options.maxSigma; }
double PhotometricServo::sigma() const { return impl_->sigma; }

PhotometricServo::Step PhotometricServo::toward(const ImageF& observed, const Pose& T_w_b) {
    Impl& impl = *impl_;
    impl.aimAt(T_w_b);
    const ImageF small = halvedAsRendered(observed);
    // Gradients are the goal's: of `s` only the grey values count.
    impl.s.buildFrom({small, impl.goal.depth}, impl.camera, impl.options.photometric);
    Step step;
    step.velocity = bodyVelocityFrom(impl.task.computeControlLaw());
    step.displacement = {step.velocity.linear / impl.options.gain,
                         step.velocity.yawRate / impl.options.gain};
    step.unexplained = unexplainedShare(small, impl.goal.intensity);
    step.isTrusted = step.unexplained < impl.options.maxUnexplained;
    return step;
}

}  // namespace photonav
