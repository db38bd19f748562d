// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/image_pyramid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "photometry/opencv_image.hpp"

namespace photonav {
namespace {

constexpr int kTaps = 8;
constexpr std::array<float, kTaps> kBinomial = {1.F / 128,  7.F / 128,  21.F / 128, 35.F / 128,
                                                35.F / 128, 21.F / 128, 7.F / 128,  1.F / 128};
constexpr double kBinomialVariance = 0.25 * (kTaps - 1);  // [pixels^2]

/// Smoothed by a Gaussian of any width, in a time that does not grow with it: a wide one is applied
/// to the reduced image. One as wide as the image leaves nothing but its mean.
cv::Mat smoothed(const cv::Mat& image, double sigma) {
    sigma = std::min(sigma, static_cast<double>(std::max(image.rows, image.cols)));
    constexpr double kLeastSigma = 8.;  // of a reduced image [pixels]: reducing blurs little beside
    const int reduction =
        std::clamp(static_cast<int>(sigma / kLeastSigma), 1, std::min(image.rows, image.cols));
    cv::Mat smooth;
    if (reduction == 1) {
        cv::GaussianBlur(image, smooth, {}, sigma);
        return smooth;
    }
    cv::resize(image, smooth, {image.cols / reduction, image.rows / reduction}, 0., 0.,
               cv::INTER_AREA);
    cv::GaussianBlur(smooth, smooth, {}, sigma / reduction);
    cv::resize(smooth, smooth, image.size(), 0., 0., cv::INTER_LINEAR);
    return smooth;
}

/// The largest variance of a kernel of three pixels without negative weights [pixels^2].
constexpr double kWidestKernel = 0.5;

/// A variance as a sum of equal ones, each of a kernel of three pixels.
std::vector<double> widenings(double variance) {
    if (!(variance > 0.)) return {};
    const double times = std::ceil(variance / kWidestKernel);
    return std::vector<double>(static_cast<std::size_t>(times), variance / times);
}

/// Convolved with the kernel (side, 1 - 2 side, side).
std::vector<double> convolved(const std::vector<double>& kernel, double side) {
    std::vector<double> result(kernel.size() + 2, 0.);
    for (std::size_t i = 0; i < kernel.size(); ++i) {
        result[i] += side * kernel[i];
        result[i + 1] += (1. - 2. * side) * kernel[i];
        result[i + 2] += side * kernel[i];
    }
    return result;
}

/// @param variance not above kWidestKernel
ImageF widenedOnce(const ImageF& image, double variance) {
    const auto side = static_cast<float>(0.5 * variance);
    const float middle = 1.F - 2.F * side;
    const unsigned width = image.getWidth(), height = image.getHeight();
    if (width < 2) return image;
    ImageF result(height, width);
    std::vector<float> column(width);
    for (unsigned v = 0; v < height; ++v) {
        const float* row = image[v];
        const float* above = image[v > 0 ? v - 1 : 0];
        const float* below = image[std::min(v + 1, height - 1)];
        for (unsigned u = 0; u < width; ++u) {
            column[u] = middle * row[u] + side * (above[u] + below[u]);
        }
        float* out = result[v];
        for (unsigned u = 1; u + 1 < width; ++u) {
            out[u] = middle * column[u] + side * (column[u - 1] + column[u + 1]);
        }
        out[0] = (1.F - side) * column[0] + side * column[1];
        out[width - 1] = (1.F - side) * column[width - 1] + side * column[width - 2];
    }
    return result;
}

}  // namespace

Camera halved(const Camera& camera) {
    const auto centre = [](double c) { return 0.5 * (c + 0.5) - 0.5; };
    return {camera.width / 2, camera.height / 2,
            vpCameraParameters(0.5 * camera.fx(), 0.5 * camera.fy(), centre(camera.cx()),
                               centre(camera.cy()))};
}

double noiseAfterWidening(double variance, double scale) {
    const double added = std::max(variance, 0.);
    std::vector<double> kernel{1.};  // along one axis
    for (const double once : widenings(added)) kernel = convolved(kernel, 0.5 * once);
    double ofWhite = 0.;  // both axes
    for (const double weight : kernel) ofWhite += weight * weight;
    const double smoothed = 1. / (4. * std::numbers::pi * scale);
    return std::max(ofWhite, std::sqrt(smoothed / (smoothed + added)));
}

ImageF widened(const ImageF& image, double variance) {
    const std::vector<double> steps = widenings(variance);
    if (steps.empty()) return image;
    ImageF result = widenedOnce(image, steps.front());
    for (std::size_t i = 1; i < steps.size(); ++i) result = widenedOnce(result, steps[i]);
    return result;
}

double finerThan(double cellSize, double depth, const Camera& camera, const ImageF& image) {
    const double cell = cellSize * camera.fx() / depth;  // [pixels]
    if (!(cell > 0.)) return 0.;
    const cv::Mat sharp = asMat(image);
    return cv::norm(sharp, smoothed(sharp, 0.5 * cell), cv::NORM_L2SQR) / image.getSize();
}

ImageF halvedAsRendered(const ImageF& image) {
    const int width = static_cast<int>(image.getWidth());
    const int height = static_cast<int>(image.getHeight());
    ImageF half(image.getHeight() / 2, image.getWidth() / 2);
    std::vector<float> row(static_cast<std::size_t>(width) + kTaps);  // filtered over rows, padded
    constexpr int kBefore = kTaps / 2 - 1;
    for (int v = 0; v < height / 2; ++v) {
        std::array<const float*, kTaps> source;
        for (int k = 0; k < kTaps; ++k) {
            source[k] = image[std::clamp(2 * v + k - kBefore, 0, height - 1)];
        }
        for (int u = 0; u < width; ++u) {
            float sum = 0.F;
            for (int k = 0; k < kTaps; ++k) sum += kBinomial[k] * source[k][u];
            row[u + kBefore] = sum;
        }
        std::fill_n(row.begin(), kBefore, row[kBefore]);
        std::fill(row.begin() + kBefore + width, row.end(), row[kBefore + width - 1]);
        float* out = half[v];
        for (int u = 0; u < width / 2; ++u) {
            float sum = 0.F;
            for (int k = 0; k < kTaps; ++k) sum += kBinomial[k] * row[2 * u + k];
            out[u] = sum;
        }
    }
    return half;
}

double blurAfterHalving(double blur) { return 0.5 * std::sqrt(blur * blur + kBinomialVariance); }

double blurVarianceBeforeHalving(double variance) { return 4. * variance - kBinomialVariance; }

}  // namespace photonav
