// SPDX-License-Identifier: BSD-3-Clause
// Fig. 3 of the paper: clouds of positions every ten of a hundred uncertain motions, from sampled
// motions and from beliefs that were propagated to fourth and to second order.
#include <cstdio>
#include <numbers>
#include <random>

#include "geometry/se3.hpp"
#include "geometry/uncertain_pose.hpp"
#include "plot/figure.hpp"

using namespace photonav;

namespace {

constexpr int kMotions = 100, kStage = 10, kSamples = 150;

/// Positions after every kStage motions.
using Clouds = std::vector<std::vector<Eigen::Vector3d>>;

/// T_k_w at the start without uncertainty, and the motion that follows k times: T_b_a.
struct Chain {
    std::string name;
    Pose T_0_w;
    UncertainPose motion;
};

Eigen::Vector3d position(const Pose& T_k_w) { return T_k_w.inverse().translation(); }

/// Draws poses; the covariance may be singular.
class PoseSampler {
  public:
    explicit PoseSampler(UncertainPose pose) : mean_(std::move(pose.mean)) {
        const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(pose.covariance);
        root_ = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.).cwiseSqrt().asDiagonal();
    }
    Pose operator()(std::mt19937& random) const {
        std::normal_distribution<double> normal;
        return expSE3(root_ * Vector6::NullaryExpr([&] { return normal(random); })) * mean_;
    }

  private:
    Pose mean_;
    Matrix6 root_;
};

/// The errors of the motions are independent, and each motion starts where the last one ended.
Clouds cloudsOfMotions(const Chain& chain) {
    std::mt19937 random(1);
    const PoseSampler motion(chain.motion);
    Clouds clouds(kMotions / kStage);
    for (int i = 0; i < kSamples; ++i) {
        Pose T_k_w = chain.T_0_w;
        for (int k = 1; k <= kMotions; ++k) {
            T_k_w = motion(random) * T_k_w;
            if (k % kStage == 0) clouds[k / kStage - 1].push_back(position(T_k_w));
        }
    }
    return clouds;
}

Clouds cloudsOfBeliefs(const Chain& chain, PropagationOrder order) {
    std::mt19937 random(1);
    Clouds clouds;
    UncertainPose T_k_w{chain.T_0_w};
    for (int k = 1; k <= kMotions; ++k) {
        T_k_w = compound(chain.motion, T_k_w, order);
        if (k % kStage != 0) continue;
        const PoseSampler belief(T_k_w);
        auto& cloud = clouds.emplace_back();
        for (int i = 0; i < kSamples; ++i) cloud.push_back(position(belief(random)));
    }
    return clouds;
}

/// The clouds in the plane of two axes (0: x, 1: y, 2: z).
Plot inPlane(const Clouds& clouds, int first, int second, const Eigen::AlignedBox2d& area) {
    constexpr double kSide = 300.;  // [px]
    constexpr const char* kLabels[] = {"x [m]", "y [m]", "z [m]"};
    Plot plot = Plot::map(area, kSide);
    plot.x.label = kLabels[first];
    plot.y.label = kLabels[second];
    for (std::size_t i = 0; i < clouds.size(); ++i) {
        Plot::Points points;
        for (const Eigen::Vector3d& p : clouds[i]) points.emplace_back(p[first], p[second]);
        const double share = static_cast<double>(i) / static_cast<double>(clouds.size() - 1);
        plot.dots(points, {.color = viridis(0.9 * share), .width = 3., .opacity = 0.6});
    }
    return plot;
}

/// A row of panels: one plane, by three methods.
std::vector<Plot> rowOf(const Chain& chain, int first, int second,
                        const Eigen::AlignedBox2d& area) {
    std::vector<Plot> row;
    for (const auto& [method, clouds] :
         {std::pair{"sampled motions", cloudsOfMotions(chain)},
          {"fourth order", cloudsOfBeliefs(chain, PropagationOrder::fourth)},
          {"second order", cloudsOfBeliefs(chain, PropagationOrder::second)}}) {
        row.push_back(inPlane(clouds, first, second, area));
        row.back().title = chain.name + ", " + method;
    }
    return row;
}

Eigen::AlignedBox2d areaOf(double left, double right, double low, double high) {
    return {Eigen::Vector2d(left, low), Eigen::Vector2d(right, high)};
}

/// Along x, with an uncertain yaw.
Chain inThePlane() {
    Chain chain{"(a)", Pose::Identity(), {}};
    chain.motion.mean.translation() << -1., 0., 0.;
    chain.motion.covariance(5, 5) = 0.03;
    return chain;
}

/// Forward and up, everything uncertain. The start is turned by 22.5 degrees.
Chain inSpace() {
    Chain chain{"(b)", Pose::Identity(), {}};
    chain.T_0_w.linear() =
        Eigen::AngleAxisd(-std::numbers::pi / 8., Eigen::Vector3d::UnitZ()).toRotationMatrix();
    chain.motion.mean.translation() << -1., 0., -0.1;
    Vector6 variances;
    variances << 0.01, 0.01, 0.01, 0.001, 0.001, 0.03;
    chain.motion.covariance = variances.asDiagonal();
    return chain;
}

}  // namespace

int main() {
    const Chain a = inThePlane(), b = inSpace();
    const Figure figure{"Positions after 10, 20, ... 100 motions (dark to bright)",
                        {rowOf(a, 0, 1, areaOf(-70., 110., -90., 90.)),
                         rowOf(b, 0, 1, areaOf(-70., 110., -90., 90.)),
                         rowOf(b, 0, 2, areaOf(-70., 110., -40., 50.)),
                         rowOf(b, 1, 2, areaOf(-90., 90., -40., 50.))}};
    for (const std::string ending : {".png", ".svg", ".pdf"})
        figure.save("propagation_clouds" + ending);
    std::puts("wrote propagation_clouds.png, .svg and .pdf");
}
