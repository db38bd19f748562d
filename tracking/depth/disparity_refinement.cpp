// SPDX-License-Identifier: BSD-3-Clause
#include "depth/disparity_refinement.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace photonav {
namespace {

constexpr int kRefinements = 2;
constexpr float kFarthestFromMatch = 1.F;  // from the disparity that was matched [pixels]
/// Standard deviation of the slopes of disparity that is assumed beforehand.
constexpr double kSlope = 0.3;
/// Gaussian that smooths the images, so that they are nearly linear between pixels.
constexpr double kSmooth = 0.7;  // [pixels]

/// Both images, smoothed, and their horizontal gradients.
struct StereoPair {
    cv::Mat left, right, ofLeft, ofRight;

    StereoPair(const cv::Mat& l, const cv::Mat& r) {
        cv::GaussianBlur(l, left, {}, kSmooth, 0., cv::BORDER_REFLECT);
        cv::GaussianBlur(r, right, {}, kSmooth, 0., cv::BORDER_REFLECT);
        cv::Sobel(left, ofLeft, CV_32F, 1, 0, 3, 1. / 8.);
        cv::Sobel(right, ofRight, CV_32F, 1, 0, 3, 1. / 8.);
    }
};

/// The grey value, or gradient, of a row of the right image at the match of a pixel.
float at(const float* row, float u, int last) {
    const int first = static_cast<int>(u);
    const float part = u - static_cast<float>(first);
    return (1.F - part) * row[first] + part * row[std::min(first + 1, last)];
}

/// The contrast of the left image divided by that of the right one, over all matched pixels.
double contrastRatio(const StereoPair& pair, const cv::Mat& disparity) {
    Eigen::Array2d sum(0., 0.), square(0., 0.);
    double n = 0.;
    for (int v = 0; v < disparity.rows; ++v) {
        const auto* d = disparity.ptr<float>(v);
        for (int u = 0; u < disparity.cols; ++u) {
            if (!(d[u] > 0.F) || static_cast<float>(u) < d[u]) continue;
            const Eigen::Array2d grey(
                pair.left.at<float>(v, u),
                at(pair.right.ptr<float>(v), static_cast<float>(u) - d[u], disparity.cols - 1));
            sum += grey;
            square += grey * grey;
            ++n;
        }
    }
    const Eigen::Array2d variance = square - sum * sum / std::max(n, 1.);
    return variance.minCoeff() > 0. ? std::sqrt(variance[0] / variance[1]) : 1.;
}

/// The sums of a block's normal equations for the unknowns a, b, c of D = a + b u + c v, and o, an
/// offset between the two images. Each pixel has the equation g (a + b u + c v) - o = y. Summed are
/// g^2 times 1, u, v, u^2, u v, v^2; g y and g times 1, u, v; y, and the number of pixels. The last
/// two are 0, which fill whole registers.
using Sums = Eigen::Array<double, 16, 1>;

/// The equations of a row of pixels. Where the right image is moved by the present disparity d, the
/// left one is e brighter, and g is the mean gradient of the two. But for an offset, e + g (D - d)
/// vanishes at the disparity D; so y = g d - e.
void equationsOf(const StereoPair& pair, const cv::Mat& disparity, double contrast, int v,
                 std::vector<Sums>& row) {
    const int last = disparity.cols - 1;
    const auto* d = disparity.ptr<float>(v);
    const auto ratio = static_cast<float>(contrast);
    for (int u = 0; u <= last; ++u) {
        const float from = static_cast<float>(u) - d[u];
        if (!(d[u] > 0.F) || from < 0.F) {
            row[u].setZero();
            continue;
        }
        const float moved = ratio * at(pair.right.ptr<float>(v), from, last);
        const float ofMoved = ratio * at(pair.ofRight.ptr<float>(v), from, last);
        const double g = 0.5 * (pair.ofLeft.at<float>(v, u) + ofMoved);
        const double y = g * d[u] - (pair.left.at<float>(v, u) - moved);
        const double byU = g * u, byV = g * v;
        row[u] << g * g, g * byU, g * byV, byU * byU, byU * byV, byV * byV, y * g, y * byU, y * byV,
            g, byU, byV, y, 1., 0., 0.;
    }
}

/// What a block says of the disparity of its middle.
struct Disparity {
    double mean, information;  ///< [pixels], [(grey values / pixel)^2]
};

/// @param u,v middle of the block
/// @param ofSlopes information of the assumption about slopes
Disparity solve(const Sums& s, double u, double v, double ofSlopes) {
    enum Sum { gg, ggu, ggv, gguu, gguv, ggvv, gy, gyu, gyv, g1, gu, gv, y1, n };
    // From the corner of the image to the middle of the block
    const double du = s[ggu] - u * s[gg], dv = s[ggv] - v * s[gg];
    const double duv = s[gguv] - u * s[ggv] - v * du;
    const Eigen::Vector3d g(s[g1], s[gu] - u * s[g1], s[gv] - v * s[g1]);
    const Eigen::Vector3d b(s[gy], s[gyu] - u * s[gy], s[gyv] - v * s[gy]);
    Eigen::Matrix3d A;
    A << s[gg], du, dv,                                   //
        du, s[gguu] - u * (s[ggu] + du) + ofSlopes, duv,  //
        dv, duv, s[ggvv] - v * (s[ggv] + dv) + ofSlopes;
    A -= g * g.transpose() / s[n];  // without the offset
    const Eigen::Vector3d row = A.inverse().row(0);
    return {row.dot(b - s[y1] / s[n] * g), 1. / row[0]};
}

/// One Gauss-Newton step of every disparity. Sums over blocks are kept up to date from row to row,
/// and from pixel to pixel.
void improve(const StereoPair& pair, int block, double noise, const cv::Mat& matched,
             cv::Mat& disparity) {
    const double variance = 2. * noise * noise;  // of the difference of two grey values
    const double ofSlopes = variance / (kSlope * kSlope);
    const int width = disparity.cols, height = disparity.rows, half = block / 2;
    const double contrast = contrastRatio(pair, disparity);
    std::vector<std::vector<Sums>> rows(block, std::vector<Sums>(width, Sums::Zero()));
    std::vector<Sums> columns(width, Sums::Zero());
    for (int v = -half; v < height; ++v) {
        const int enters = v + half;
        std::vector<Sums>& row = rows[enters % block];
        for (int u = 0; u < width; ++u) columns[u] -= row[u];  // leaves
        if (enters < height) {
            equationsOf(pair, disparity, contrast, enters, row);
            for (int u = 0; u < width; ++u) columns[u] += row[u];
        } else {
            std::fill(row.begin(), row.end(), Sums::Zero());
        }
        if (v < 0) continue;
        Sums sum = Sums::Zero();
        for (int u = 0; u < std::min(half, width); ++u) sum += columns[u];
        for (int u = 0; u < width; ++u) {
            if (u + half < width) sum += columns[u + half];
            if (u - half - 1 >= 0) sum -= columns[u - half - 1];
            float& d = disparity.at<float>(v, u);
            if (!(d > 0.F)) continue;
            const Disparity found = solve(sum, u, v, ofSlopes);
            const auto better = static_cast<float>(found.mean);
            const bool isNear = std::abs(better - matched.at<float>(v, u)) <= kFarthestFromMatch;
            const bool isSure =
                variance <= found.information * kMostDisparitySigma * kMostDisparitySigma;
            d = isNear && isSure && better > 0.F ? better : 0.F;
        }
    }
}

}  // namespace

void refineDisparities(const cv::Mat& left, const cv::Mat& right, int block, double noise,
                       cv::Mat& disparity) {
    const StereoPair pair(left, right);
    const cv::Mat matched = disparity.clone();
    for (int i = 0; i < kRefinements; ++i) {
        improve(pair, block, noise, matched, disparity);
    }
}

}  // namespace photonav
