// SPDX-License-Identifier: BSD-3-Clause
#include "flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "constants.hpp"
#include "flight_estimator.hpp"
#include "lost_watch.hpp"
#include "photometric_servo.hpp"
#include "route.hpp"
#include "se3.hpp"

namespace photonav {
namespace {

constexpr double kSettleTime = 1.5;       // at the goal [s]
constexpr double kPhotometricTime = 10.;  // at most, for the goal's image [s]
constexpr double kPhotometricStep =
    0.01;                               // below which, or twice the noise, it is reached [m, rad]
constexpr int kPhotometricImages = 6;   // in a row
constexpr double kSearchGrowth = 0.05;  // of the radius searched, per image
constexpr double kSearchTurn = 0.1;     // standard deviation of the heading searched [rad]

/// Different numbers from one seed for everything that draws.
std::uint64_t seedOf(std::uint64_t seed, std::uint64_t use) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                           static_cast<std::uint32_t>(use)};
    std::array<std::uint32_t, 2> words{};
    sequence.generate(words.begin(), words.end());
    return (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
}

/// An image in the exposure of the model.
ImageF asModelled(const ImageF& observed, const Exposure& exposure) {
    ImageF image = observed;
    for (unsigned i = 0; i < image.getSize(); ++i) {
        image.bitmap[i] = static_cast<float>((image.bitmap[i] - exposure.offset) / exposure.gain);
    }
    return image;
}

class Flight {
  public:
    Flight(const std::vector<PlannedView>& plan, const FlightWorld& world,
           const FlightOptions& options, const OnExposure& onExposure)
        : world_(world),
          options_(options),
          onExposure_(onExposure),
          start_{(plan.front().T_w_b * world.T_b_c).inverse(), options.initialCovariance},
          mav_(trueStart(), options.mav, seedOf(options.seed, 1)),
          camera_(*world.truth, world.camera, world.noise, options.camera, seedOf(options.seed, 2)),
          aligner_(*world.map, world.camera, options.alignment),
          estimator_(start_, world.T_b_c),
          watch_(options.lost, start_.mean),
          route_(plan, world.T_b_c, options),
          servo_(world.T_b_c, options.servo),
          goalServo_(*world.map, world.camera, world.T_b_c, plan.back().T_w_b,
                     {.photometric = options.alignment.photometric}),
          timeLimit_(60. + options.timePerMetre * plan.back().distance) {
        result_.leastClearance = kInfinity;
    }

    FlightResult run(const std::function<bool()>& isStopped) {
        look();
        while (!hasEnded(isStopped)) {
            command_ = limited(decide(), command_, options_.servo, options_.timeStep);
            move();
            look();
        }
        result_.duration = time_;
        result_.lost = watch_.lostTime(time_);
        result_.timesLost = watch_.timesLost();
        result_.goalError = goalError();
        return std::move(result_);
    }

  private:
    Pose trueStart() const {
        std::mt19937_64 random(seedOf(options_.seed, 0));
        const Pose T_c_w = expSE3(draw(rootOf(start_.covariance), random)) * start_.mean;
        return T_c_w.inverse() * world_.T_b_c.inverse();
    }

    Pose trueCamera() const { return (mav_.T_w_b() * world_.T_b_c).inverse(); }
    /// At the last image.
    Pose believedBody() const {
        return estimator_.atLastImage().mean.inverse() * world_.T_b_c.inverse();
    }
    double goalError() const {
        return (mav_.T_w_b().translation() - route_.goal().T_w_b.translation()).norm();
    }

    void move();
    void look();
    void receiveAll();
    void receive(const TakenImage& taken);
    void search(const ImageF& image);
    void leaveImage();
    void approachOnImage(const ImageF& image);
    BodyVelocity decide();
    bool hasEnded(const std::function<bool()>& isStopped);
    bool end(FlightEnd how) {
        result_.end = how;
        return true;
    }

    const FlightWorld& world_;
    FlightOptions options_;
    const OnExposure& onExposure_;
    UncertainPose start_;
    SimulatedMav mav_;
    SimulatedCamera camera_;
    WideAligner aligner_;
    FlightEstimator estimator_;
    LostWatch watch_;
    Route route_;
    WaypointServo servo_;
    PhotometricServo goalServo_;
    double timeLimit_;

    double time_ = 0.;
    BodyVelocity command_;
    std::optional<double> atGoalSince_;
    std::optional<BodyVelocity> onImage_;  // what the goal's image asks for
    int smallSteps_ = 0;
    int searched_ = 0;
    FlightResult result_;
};

void Flight::move() {
    const Eigen::Vector3d before_w = mav_.T_w_b().translation();
    estimator_.move(mav_.step(command_, options_.timeStep));
    time_ += options_.timeStep;
    result_.way += (mav_.T_w_b().translation() - before_w).norm();
    result_.leastClearance =
        std::min(result_.leastClearance, world_.clearance(mav_.T_w_b().translation()));
}

void Flight::look() {
    receiveAll();
    if (camera_.expose(time_, trueCamera())) {
        estimator_.expose(time_);
        if (onExposure_) {
            onExposure_(time_, trueCamera(), camera_.lastImage(), camera_.lastView().depth);
        }
        const UncertainPose belief = estimator_.belief();
        result_.samples.push_back({time_, route_.progress(belief.mean), trueCamera(), belief});
        receiveAll();  // of a camera without latency
    }
    watch_.onTime(time_);
}

void Flight::receiveAll() {
    while (const auto taken = camera_.receive(time_)) receive(*taken);
}

void Flight::receive(const TakenImage& taken) {
    const Alignment alignment = estimator_.receive(aligner_, taken.time, taken.image);
    ++result_.images;
    if (isLost(alignment.verdict)) ++result_.badImages;
    watch_.onAlignment(time_, alignment);
    if (watch_.isLostNow()) {
        leaveImage();
        search(taken.image);
    } else if (atGoalSince_) {
        approachOnImage(isLost(alignment.verdict) ? taken.image
                                                  : asModelled(taken.image, alignment.exposure));
    }
    const auto sample = std::find_if(result_.samples.rbegin(), result_.samples.rend(),
                                     [&](const FlightSample& s) { return s.time == taken.time; });
    sample->belief = estimator_.atLastImage();
    sample->distance = route_.progress(sample->belief.mean);
}

/// Perhaps it is not the image but the estimate that is bad: the same image with a wider prior, the
/// wider the longer it takes.
void Flight::search(const ImageF& image) {
    UncertainPose wide = estimator_.atLastImage();
    const double radius = options_.lost.searchRadius * (1. + kSearchGrowth * searched_++);
    wide.covariance.diagonal().head<3>().array() += radius * radius;
    const Eigen::Vector3d up_c = wide.mean.linear().col(2);
    wide.covariance.bottomRightCorner<3, 3>() +=
        kSearchTurn * kSearchTurn * up_c * up_c.transpose();
    const Alignment found = aligner_.align(image, wide);
    if (found.verdict != Verdict::converged) return;
    estimator_.reset({found.T_c_w, found.covariance});
    watch_.onFound(time_);
    searched_ = 0;
}

/// The belief is all there is.
void Flight::leaveImage() {
    onImage_.reset();
    smallSteps_ = 0;
}

void Flight::approachOnImage(const ImageF& image) {
    if (!options_.photometricGoal || !goalServo_.isInformative()) return;
    const PhotometricServo::Step step = goalServo_.toward(image, believedBody());
    if (!step.isTrusted) return leaveImage();
    if (!result_.photometric) result_.goalErrorBefore = goalError();
    result_.photometric = true;
    onImage_ = step.velocity;
    const double small = std::max(kPhotometricStep, 2. * goalServo_.sigma());
    const bool isSmall =
        step.displacement.linear.norm() < small && std::abs(step.displacement.yawRate) < small;
    smallSteps_ = isSmall ? smallSteps_ + 1 : 0;
}

BodyVelocity Flight::decide() {
    if (watch_.isHovering(time_)) return {};
    const Pose T_c_w = estimator_.belief().mean;
    if (watch_.isLostNow()) return servo_.toward(T_c_w, watch_.lastCertainView());
    if (atGoalSince_) {
        if (onImage_) return *onImage_;
        return servo_.toward(T_c_w, route_.cameraAt(route_.goal()));
    }
    const PlannedView& wanted = route_.advance(estimator_.belief());
    if (route_.isAtGoal()) atGoalSince_ = time_;
    return servo_.toward(T_c_w, route_.cameraAt(wanted));
}

bool Flight::hasEnded(const std::function<bool()>& isStopped) {
    if (isStopped && isStopped()) return end(FlightEnd::stopped);
    if (result_.leastClearance < options_.bodyRadius) return end(FlightEnd::collided);
    if (watch_.hasGivenUp(time_)) return end(FlightEnd::lost);
    if (time_ > timeLimit_) return end(FlightEnd::outOfTime);
    if (!atGoalSince_ || watch_.isLostNow()) return false;
    const bool isThere =
        onImage_ ? smallSteps_ >= kPhotometricImages || time_ - *atGoalSince_ > kPhotometricTime
                 : time_ - *atGoalSince_ > kSettleTime;
    if (!isThere) return false;
    return end(goalError() <= options_.arrivalTolerance ? FlightEnd::arrived : FlightEnd::astray);
}

}  // namespace

std::string nameOf(FlightEnd end) {
    switch (end) {
        case FlightEnd::arrived:
            return "arrived";
        case FlightEnd::astray:
            return "astray";
        case FlightEnd::collided:
            return "collided";
        case FlightEnd::lost:
            return "lost";
        case FlightEnd::outOfTime:
            return "out of time";
        case FlightEnd::stopped:
            break;
    }
    return "stopped";
}

FlightResult fly(const std::vector<PlannedView>& plan, const FlightWorld& world,
                 const FlightOptions& options, const std::function<bool()>& isStopped,
                 const OnExposure& onExposure) {
    if (plan.size() < 2) throw std::invalid_argument("flight: a plan has at least two views");
    return Flight(plan, world, options, onExposure).run(isStopped);
}

}  // namespace photonav
