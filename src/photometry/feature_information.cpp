// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/feature_information.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>

#include "geometry/se3.hpp"

namespace photonav {

std::vector<Feature> visibleFeatures(const View& view, const FeatureOptions& options) {
    cv::Mat1b bytes(static_cast<int>(view.intensity.getHeight()),
                    static_cast<int>(view.intensity.getWidth()));
    const float* grey = view.intensity.bitmap;
    std::transform(grey, grey + view.intensity.getSize(), bytes.ptr<unsigned char>(), greyLevel);
    std::vector<cv::KeyPoint> corners;
    cv::FAST(bytes, corners, std::max(1, static_cast<int>(std::lround(255. * options.threshold))),
             true, cv::FastFeatureDetector::TYPE_9_16);
    std::vector<Feature> features;
    features.reserve(corners.size());
    for (const cv::KeyPoint& corner : corners) {
        const auto u = static_cast<unsigned>(corner.pt.x);
        const auto v = static_cast<unsigned>(corner.pt.y);
        const float depth = view.depth[v][u];
        if (depth > 0.F) features.push_back({corner.pt.x, corner.pt.y, depth});
    }
    return features;
}

Matrix6 reprojectionInformation(const std::vector<Feature>& features, const Camera& camera,
                                const FeatureOptions& options) {
    Matrix6 sum = Matrix6::Zero();
    for (const Feature& feature : features) {
        const Eigen::Vector3d p = camera.unproject(feature.u, feature.v, feature.depth);
        Eigen::Matrix<double, 3, 6> motion;  // d p / d xi = [1 | -p^]
        motion << Eigen::Matrix3d::Identity(), -hat(p);
        const Eigen::Matrix<double, 2, 6> J = camera.projectionJacobian(p) * motion;
        sum += J.transpose() * J;
    }
    return sum / (options.pixelSigma * options.pixelSigma);
}

double featurePenalty(std::size_t count, const FeatureOptions& options) {
    return 1. / (1. + static_cast<double>(count) / options.referenceCount);
}

}  // namespace photonav
