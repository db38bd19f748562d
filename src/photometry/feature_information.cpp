// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/feature_information.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>

#include "geometry/se3.hpp"

namespace photonav {

std::vector<Feature> visibleFeatures(const View& view, const FeatureOptions& options) {
    const cv::Mat grey(static_cast<int>(view.intensity.getHeight()),
                       static_cast<int>(view.intensity.getWidth()), CV_32F, view.intensity.bitmap);
    cv::Mat bytes;
    grey.convertTo(bytes, CV_8U, 255.);
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
        const double Z = feature.depth;
        const Eigen::Vector3d p((feature.u - camera.cx()) / camera.fx() * Z,
                                (feature.v - camera.cy()) / camera.fy() * Z, Z);
        Eigen::Matrix<double, 2, 3> projection;                             // d pi / d p
        projection << camera.fx() / Z, 0., -camera.fx() * p.x() / (Z * Z),  //
            0., camera.fy() / Z, -camera.fy() * p.y() / (Z * Z);
        Eigen::Matrix<double, 3, 6> motion;  // d p / d xi = [1 | -p^]
        motion << Eigen::Matrix3d::Identity(), -hat(p);
        const Eigen::Matrix<double, 2, 6> J = projection * motion;
        sum += J.transpose() * J;
    }
    return sum / (options.pixelSigma * options.pixelSigma);
}

double featurePenalty(std::size_t count, const FeatureOptions& options) {
    return 1. / (1. + static_cast<double>(count) / options.referenceCount);
}

}  // namespace photonav
