// SPDX-License-Identifier: BSD-3-Clause
#include "depth/stereo_depth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "depth/disparity_refinement.hpp"

namespace photonav {
namespace {

constexpr int kDisparityUnit = 16;  // OpenCV gives sixteenths of pixels
/// Noise of images whose noise is not given: their disparities are refined with it [grey values].
constexpr double kUsualNoise = 1.;
constexpr int kMaxDisparities = 512;
constexpr int kLeastBlock = 5;  // of OpenCV's block matching [pixels]

/// Standard deviation of the Gaussian whose derivative lets as much noise through as Sobel's
/// filter.
constexpr double kSobelWidth = 0.68;  // [pixels]
// The middle of a block, as a part of its edge, and the least share of texture there. Texture that
// is spread evenly has the share 1.
constexpr double kMiddle = 0.4, kShareInMiddle = 0.25;

cv::Matx33d matrixOf(const Camera& camera) {
    return {camera.fx(), 0., camera.cx(), 0., camera.fy(), camera.cy(), 0., 0., 1.};
}

cv::Mat wrapped(const vpImage<unsigned char>& image) {
    return {static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()), CV_8UC1,
            image.bitmap};
}

/// Multiples of 16, enough for the nearest surface.
int disparities(double focalTimesBaseline, double minDepth) {
    const int needed = static_cast<int>(std::ceil(focalTimesBaseline / minDepth / 16.)) * 16;
    return std::clamp(needed, 16, kMaxDisparities);
}

/// The block size asked for, or the largest odd one that fits into an image.
int blockSizeFor(const cv::Size& image, int wanted) {
    const int side = std::min(image.width, image.height);
    if (side < kLeastBlock) {
        throw std::invalid_argument("stereo: images are less than " + std::to_string(kLeastBlock) +
                                    " pixels wide or high");
    }
    return std::min(wanted, side % 2 == 1 ? side : side - 1);
}

cv::Ptr<cv::StereoMatcher> makeMatcher(const StereoOptions& o, const cv::Size& image, int count) {
    cv::Ptr<cv::StereoMatcher> matcher;
    const int blockSize = blockSizeFor(image, o.blockSize);
    if (o.method == StereoMethod::blockMatching) {
        const auto blocks = cv::StereoBM::create(count, blockSize);
        blocks->setTextureThreshold(o.texture);
        blocks->setUniquenessRatio(o.uniqueness);
        matcher = blocks;
    } else {
        const int block = std::max(3, blockSize / 3) | 1;
        const int area = block * block;
        matcher = cv::StereoSGBM::create(0, count, block, 8 * area, 32 * area, 1, 31, o.uniqueness);
    }
    matcher->setSpeckleWindowSize(o.speckle);
    matcher->setSpeckleRange(2);
    return matcher;
}

/// Mean over blocks of the squared horizontal gradient of an image, which is the information about
/// disparity [squared grey values per pixel].
cv::Mat meanSquare(const cv::Mat& gradient, int block) {
    cv::Mat mean;
    cv::sqrBoxFilter(gradient, mean, CV_32F, {block, block}, {-1, -1}, true, cv::BORDER_REFLECT);
    return mean;
}

/// Pixels whose block of texture is strong enough, and not all at its rim: 255, others 0.
/// A disparity that is found by least squares has the variance 2 noise^2 / sum of g^2, where g is
/// the gradient without noise. Smoothing makes g less, so that this is an upper limit.
cv::Mat texturedPixels(const cv::Mat& image, int block, const StereoOptions& options) {
    cv::Mat gradient;
    cv::Sobel(image, gradient, CV_32F, 1, 0, 3, 1. / 8.);
    const double noise = 255. * options.noise;
    const double width = std::hypot(options.blur, kSobelWidth);
    const double ofNoise = noise * noise / (8. * std::numbers::pi * std::pow(width, 4));
    const double least =
        2. * noise * noise / (kMostDisparitySigma * kMostDisparitySigma * block * block);
    const int middle = static_cast<int>(kMiddle * block) | 1;
    const cv::Mat inBlock = meanSquare(gradient, block) - ofNoise;
    const cv::Mat inMiddle = meanSquare(gradient, middle) - ofNoise;
    return (inBlock >= least) & (inMiddle >= kShareInMiddle * inBlock);
}

}  // namespace

struct StereoDepth::Impl {
    StereoOptions options;
    Camera recorded;  ///< size of the images to come
    Camera camera;
    Pose T_r_c = Pose::Identity();
    double baseline = 0.;
    std::array<std::array<cv::Mat, 2>, 2> maps;  ///< of left and right
    int count = 0;                               ///< of disparities
    std::array<cv::Mat, 2> small;
    /// Rectified images with `count` black columns before them: OpenCV gives no disparity to as
    /// many first columns, although far surfaces are seen there by the right camera as well.
    std::array<cv::Mat, 2> padded;
    std::array<cv::Mat, 2> smooth;  ///< the same, smoothed; without smoothing `padded` itself
    cv::Mat matched;                ///< in units of 1 / kDisparityUnit, as wide as `padded`
    cv::Mat disparity;              ///< CV_32F [pixels]
    cv::Ptr<cv::StereoMatcher> matcher;

    Impl(const DistortedCamera& left, const DistortedCamera& right, const StereoOptions& o);
    void rectify(const vpImage<unsigned char>& image, std::size_t side);
    void match();
    void leaveOutBorder();
};

StereoDepth::Impl::Impl(const DistortedCamera& left, const DistortedCamera& right,
                        const StereoOptions& o)
    : options(o), recorded(left.camera) {
    const Camera& l = left.camera;
    const Camera& r = right.camera;
    if (l.width != r.width || l.height != r.height) {
        throw std::invalid_argument("stereo: the two cameras differ in size");
    }
    const auto halved = [&](Camera c) {
        const auto width = c.width >> static_cast<unsigned>(o.halvings);
        const auto height = c.height >> static_cast<unsigned>(o.halvings);
        c = scaled(c, std::ldexp(1., -o.halvings));
        c.width = width;  // odd last rows and columns are dropped
        c.height = height;
        return c;
    };
    const Camera smallLeft = halved(l);
    const Camera smallRight = halved(r);
    const cv::Size size(static_cast<int>(smallLeft.width), static_cast<int>(smallLeft.height));
    const Pose T_r_l = right.T_b_c.inverse() * left.T_b_c;
    cv::Matx33d R;
    cv::Vec3d t;
    for (int i = 0; i < 3; ++i) {
        t[i] = T_r_l.translation()[i];
        for (int j = 0; j < 3; ++j) R(i, j) = T_r_l.linear()(i, j);
    }
    const cv::Vec4d dLeft(left.distortion.data());
    const cv::Vec4d dRight(right.distortion.data());
    cv::Matx33d R1, R2;
    cv::Matx34d P1, P2;
    cv::Matx44d Q;
    cv::stereoRectify(matrixOf(smallLeft), dLeft, matrixOf(smallRight), dRight, size, R, t, R1, R2,
                      P1, P2, Q, cv::CALIB_ZERO_DISPARITY, 0.);
    baseline = -P2(0, 3) / P2(0, 0);
    if (!(baseline > 0.)) {
        throw std::invalid_argument("stereo: the right camera is not to the right of the left one");
    }
    camera.width = smallLeft.width;
    camera.height = smallLeft.height;
    camera.intrinsics = vpCameraParameters(P1(0, 0), P1(1, 1), P1(0, 2), P1(1, 2));
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) T_r_c.linear()(i, j) = R1(i, j);
    }
    cv::initUndistortRectifyMap(matrixOf(smallLeft), dLeft, R1, P1, size, CV_16SC2, maps[0][0],
                                maps[0][1]);
    cv::initUndistortRectifyMap(matrixOf(smallRight), dRight, R2, P2, size, CV_16SC2, maps[1][0],
                                maps[1][1]);
    count = disparities(baseline * camera.fx(), o.minDepth);
    for (cv::Mat& image : padded) image = cv::Mat::zeros(size.height, count + size.width, CV_8UC1);
    matcher = makeMatcher(o, size, count);
}

/// Halves first: averaging pixels is sharp enough and leaves a quarter of the work.
void StereoDepth::Impl::rectify(const vpImage<unsigned char>& image, std::size_t side) {
    if (image.getWidth() != recorded.width || image.getHeight() != recorded.height) {
        throw std::invalid_argument("stereo: image and camera differ in size");
    }
    const cv::Size size(static_cast<int>(camera.width), static_cast<int>(camera.height));
    const int factor = 1 << options.halvings;
    const cv::Mat whole = wrapped(image)(cv::Rect(0, 0, size.width * factor, size.height * factor));
    if (factor > 1) {
        cv::resize(whole, small[side], size, 0., 0., cv::INTER_AREA);
    } else {
        small[side] = whole;
    }
    cv::Mat rectified = padded[side].colRange(count, padded[side].cols);
    cv::remap(small[side], rectified, maps[side][0], maps[side][1], cv::INTER_LINEAR);
    if (!(options.blur > 0.)) {
        smooth[side] = padded[side];
        return;
    }
    cv::Mat smoothed;  // without the black columns
    cv::GaussianBlur(rectified, smoothed, {}, options.blur, 0., cv::BORDER_REFLECT);
    cv::copyMakeBorder(smoothed, smooth[side], 0, 0, count, 0, cv::BORDER_CONSTANT);
}

/// Disparities of the left image's pixels, 0 for none.
void StereoDepth::Impl::match() {
    matcher->compute(smooth[0], smooth[1], matched);
    const cv::Rect image(count, 0, smooth[0].cols - count, smooth[0].rows);
    matched(image).convertTo(disparity, CV_32F, 1. / kDisparityUnit);
    if (options.noise > 0.) {
        const cv::Mat textured = texturedPixels(smooth[0](image), matcher->getBlockSize(), options);
        disparity.setTo(0., ~textured);
    }
    leaveOutBorder();
    // Semi-global matching has small blocks, and takes disparities from what is around them.
    if (options.method == StereoMethod::semiGlobal) return;
    std::array<cv::Mat, 2> pair;
    for (int i = 0; i < 2; ++i) padded[i](image).convertTo(pair[i], CV_32F);
    const double noise = options.noise > 0. ? 255. * options.noise : kUsualNoise;
    refineDisparities(pair[0], pair[1], matcher->getBlockSize(), noise, disparity);
}

/// Leaves out disparities whose block is not in the right image, with what the edge filter and the
/// comparison with the next disparity need.
void StereoDepth::Impl::leaveOutBorder() {
    const int margin = matcher->getBlockSize() / 2 + 2;
    for (int v = 0; v < disparity.rows; ++v) {
        auto* row = disparity.ptr<float>(v);
        for (int u = 0; u < disparity.cols; ++u) {
            if (row[u] > static_cast<float>(u - margin)) row[u] = 0.F;
        }
    }
}

StereoDepth::StereoDepth(const DistortedCamera& left, const DistortedCamera& right,
                         const StereoOptions& options)
    : impl_(std::make_unique<Impl>(left, right, options)) {}
StereoDepth::~StereoDepth() = default;
StereoDepth::StereoDepth(StereoDepth&&) noexcept = default;
StereoDepth& StereoDepth::operator=(StereoDepth&&) noexcept = default;

const Camera& StereoDepth::camera() const { return impl_->camera; }
const Pose& StereoDepth::T_r_c() const { return impl_->T_r_c; }
double StereoDepth::baseline() const { return impl_->baseline; }

void StereoDepth::operator()(const StereoImages& images, View& view) {
    Impl& m = *impl_;
    m.rectify(images.left, 0);
    m.rectify(images.right, 1);
    m.match();
    const auto focalTimesBaseline = static_cast<float>(m.camera.fx() * m.baseline);
    const auto least = static_cast<float>(
        std::max(1. / kDisparityUnit, m.camera.fx() * m.baseline / m.options.maxDepth));
    view.intensity.resize(m.camera.height, m.camera.width);
    view.depth.resize(m.camera.height, m.camera.width);
    for (unsigned v = 0; v < m.camera.height; ++v) {
        const auto* grey = m.padded[0].ptr<std::uint8_t>(static_cast<int>(v)) + m.count;
        const auto* disparity = m.disparity.ptr<float>(static_cast<int>(v));
        for (unsigned u = 0; u < m.camera.width; ++u) {
            view.intensity[v][u] = static_cast<float>(grey[u]) / 255.F;
            view.depth[v][u] = disparity[u] >= least ? focalTimesBaseline / disparity[u] : 0.F;
        }
    }
}

}  // namespace photonav
