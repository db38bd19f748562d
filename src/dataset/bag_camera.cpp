// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/bag_camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "dataset/intrinsics_bounds.hpp"
#include "io/error.hpp"
#include "photometry/opencv_image.hpp"

namespace photonav {
namespace {

constexpr double kLargestCoefficient = 1e3;

/// By OpenCV. The tables are made with the first image, whose size has been checked then.
class OpenCvLens : public LensCorrection {
  public:
    OpenCvLens(cv::Matx33d K, std::vector<double> D, cv::Matx33d pinhole)
        : K_(K), D_(std::move(D)), pinhole_(pinhole) {}

    ImageF corrected(const ImageF& image) const override {
        return remapped(image, cv::INTER_LINEAR);
    }
    ImageF correctedDepth(const ImageF& depth) const override {
        return remapped(depth, cv::INTER_NEAREST);
    }

  private:
    ImageF remapped(const ImageF& image, int interpolation) const {
        const cv::Mat from = asMat(image);
        std::call_once(isMade_, [&] {
            cv::initUndistortRectifyMap(K_, D_, cv::noArray(), pinhole_, from.size(), CV_32FC1, u_,
                                        v_);
        });
        ImageF result(image.getHeight(), image.getWidth());
        cv::Mat to = asMat(result);
        cv::remap(from, to, u_, v_, interpolation, cv::BORDER_REPLICATE);
        return result;
    }

    cv::Matx33d K_;
    std::vector<double> D_;
    cv::Matx33d pinhole_;
    mutable std::once_flag isMade_;
    mutable cv::Mat u_, v_;  ///< where a corrected pixel was
};

void requireBagCamera(double fx, double fy, double cx, double cy, const CameraInfoMessage& info,
                      const std::string& source) {
    const double width = info.width, height = info.height;
    const bool isCamera = width >= 16. && height >= 16. && width <= 1e5 && height <= 1e5 &&
                          IntrinsicsBounds(width).contain(fx, cx) &&
                          IntrinsicsBounds(height).contain(fy, cy);
    if (!isCamera) throw InputError(source, "", "is not calibrated: no intrinsics of a camera");
}

/// A fisheye lens distorts also where all its coefficients are 0.
bool lensDistorts(const CameraInfoMessage& info) {
    if (info.distortionModel == "equidistant" || info.distortionModel == "fisheye") return true;
    return std::ranges::any_of(info.D, [](double d) { return d != 0.; });
}

void requireKnownLens(const CameraInfoMessage& info, const std::string& source) {
    const std::size_t count = info.D.size();
    const bool isKnown = (info.distortionModel == "plumb_bob" && (count == 4 || count == 5)) ||
                         (info.distortionModel == "rational_polynomial" && count == 8);
    if (!isKnown) {
        throw InputError(source, "",
                         fmt::format("distortion model '{}' with {} coefficients is not one of "
                                     "plumb_bob, rational_polynomial",
                                     info.distortionModel, count));
    }
    if (!std::ranges::all_of(info.D, [](double d) { return std::abs(d) <= kLargestCoefficient; })) {
        throw InputError(source, "", "distortion coefficients that are of no lens");
    }
}

}  // namespace

BagCamera bagCamera(const CameraInfoMessage& info, const std::string& imageTopic,
                    const std::string& source) {
    if (info.isPart) throw InputError(source, "", "images that are binned or cropped");
    BagCamera result;
    Camera& camera = result.camera;
    camera.width = info.width;
    camera.height = info.height;
    const auto setIntrinsics = [&](double fx, double fy, double cx, double cy) {
        requireBagCamera(fx, fy, cx, cy, info, source);
        camera.intrinsics = vpCameraParameters(fx, fy, cx, cy);
    };
    if (imageTopic.find("image_rect") != std::string::npos) {
        setIntrinsics(info.P[0], info.P[5], info.P[2], info.P[6]);
        return result;
    }
    setIntrinsics(info.K[0], info.K[4], info.K[2], info.K[5]);
    if (!lensDistorts(info)) return result;
    requireKnownLens(info, source);
    const cv::Matx33d K(info.K.data());
    const cv::Size size(static_cast<int>(info.width), static_cast<int>(info.height));
    const cv::Matx33d pinhole(cv::Mat(cv::getOptimalNewCameraMatrix(K, info.D, size, 0.)));
    setIntrinsics(pinhole(0, 0), pinhole(1, 1), pinhole(0, 2), pinhole(1, 2));
    result.lens = std::make_shared<OpenCvLens>(K, info.D, pinhole);
    return result;
}

void requireRegistered(const CameraInfoMessage& depth, const CameraInfoMessage& colour,
                       const std::string& source) {
    constexpr double kAlike = 0.01;  // of the width: a pixel or some of a VGA image
    bool isAlike = depth.width == colour.width && depth.height == colour.height;
    for (std::size_t i = 0; i < depth.K.size(); ++i) {
        isAlike = isAlike && std::abs(depth.K[i] - colour.K[i]) <= kAlike * colour.width;
    }
    if (isAlike) return;
    throw InputError(source, "",
                     "depth images are of another camera than the colour images: take a topic with "
                     "registered depth, or give --camera FILE with its depth_camera");
}

}  // namespace photonav
