// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/measured_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>

#include "alignment/hole_margin.hpp"
#include "geometry/constants.hpp"
#include "photometry/opencv_image.hpp"

namespace photonav {
namespace {

constexpr double kAgreeWithin = 3.;  // standard deviations

/// Least and largest depth within the margin of each pixel; pixels without a surface do not count.
struct DepthRange {
    ImageF least, most;
};

DepthRange rangeOf(ImageF depth, const HoleMargin& margin) {
    DepthRange range{ImageF(depth.getHeight(), depth.getWidth()),
                     ImageF(depth.getHeight(), depth.getWidth())};
    const cv::Mat around = cv::Mat::ones(2 * margin.rows + 1, 2 * margin.columns + 1, CV_8U);
    cv::dilate(asMat(depth), asMat(range.most), around);
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        if (!(depth.bitmap[i] > 0.F)) depth.bitmap[i] = static_cast<float>(kInfinity);
    }
    cv::erode(asMat(depth), asMat(range.least), around);
    return range;
}

/// Variance along the optical axis of the surface in view of each pixel, for an uncertain pose.
class DepthVariance {
  public:
    DepthVariance(const Matrix6& covariance, const Camera& camera) : camera_(camera) {
        covariance_ = covariance({2, 3, 4}, {2, 3, 4});
    }

    /// A point X moves by rho + phi x X: along the axis by rho_z + phi_x Y - phi_y X.
    double at(unsigned u, unsigned v, double depth) const {
        const Eigen::Vector3d x = camera_.unproject(u, v, depth);
        const Eigen::Vector3d J(1., x.y(), -x.x());
        return J.dot(covariance_ * J);
    }

  private:
    const Camera& camera_;
    Eigen::Matrix3d covariance_;  // of (rho_z, phi_x, phi_y)
};

}  // namespace

MeasuredSurfaces::MeasuredSurfaces(std::shared_ptr<const ViewSource> map,
                                   const DepthAccuracy& accuracy)
    : map_(std::move(map)), accuracy_(accuracy) {}

void MeasuredSurfaces::measure(const ImageF& measured, const Camera& camera,
                               const UncertainPose& T_c_w) {
    View expected;
    map_->render(camera, T_c_w.mean, expected);
    measure(expected, measured, camera, T_c_w);
}

void MeasuredSurfaces::measure(const View& expected, const ImageF& measured, const Camera& camera,
                               const UncertainPose& T_c_w) {
    contradicted_.clear();
    width_ = camera.width;
    if (measured.getSize() == 0) return;
    if (measured.getSize() != expected.depth.getSize()) {
        throw std::invalid_argument("measured surfaces: depth image and view differ in size");
    }
    const HoleMargin margin = holeMargin(T_c_w.covariance, camera, meanDepth(expected));
    const DepthRange range = rangeOf(expected.depth, margin);
    const DepthVariance ofPose(T_c_w.covariance, camera);
    for (unsigned v = 0; v < measured.getHeight(); ++v) {
        for (unsigned u = 0; u < measured.getWidth(); ++u) {
            const double z = measured[v][u];
            if (!(z > 0.) || !(expected.depth[v][u] > 0.F)) continue;
            const double sigma = accuracy_.sigmaAtOneMetre * z * z;
            const double error =
                kAgreeWithin * std::sqrt(sigma * sigma + ofPose.at(u, v, z)) + accuracy_.ofMap;
            if (z < range.least[v][u] - error || z > range.most[v][u] + error) {
                contradicted_.push_back({u, v});
            }
        }
    }
}

void MeasuredSurfaces::render(const Camera& camera, const Pose& T_c_w, View& view) const {
    map_->render(camera, T_c_w, view);
    if (contradicted_.empty()) return;
    const unsigned scale = std::max(1U, (width_ + camera.width / 2) / camera.width);
    for (const Pixel& pixel : contradicted_) {
        view.depth[std::min(pixel.v / scale, camera.height - 1)]
                  [std::min(pixel.u / scale, camera.width - 1)] = 0.F;
    }
}

}  // namespace photonav
