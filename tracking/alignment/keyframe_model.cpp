// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/keyframe_model.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "alignment/image_pyramid.hpp"
#include "alignment/keyframe_points.hpp"
#include "geometry/se3.hpp"

namespace photonav {

namespace {

/// The same equations for a perturbation on the left: exp(eta^) T = T exp(xi^), eta = Ad(T) xi.
template <class Equations>
Equations onTheLeft(Equations e, const Pose& T) {
    Matrix8 M = Matrix8::Identity();
    M.topLeftCorner<6, 6>() = adjoint(T.inverse());
    e.AtA = M.transpose() * e.AtA * M;
    e.Atr = M.transpose() * e.Atr;
    return e;
}

}  // namespace

KeyframeOptions::KeyframeOptions() {
    alignment.measureCovariance = true;
    alignment.trust.residualSigmas = 0.;
    alignment.levels = 3;
    alignment.coarseStep = 0.3;
    alignment.fineStep = 1.;
}

class KeyframeModel::Points : public Comparison {
  public:
    Points(const View& view, const Camera& camera, const Pose& T_k_w,
           const KeyframeOptions& options)
        : options_(options), full_(camera), T_k_w_(T_k_w) {
        if (!fits(view.intensity) || !fits(view.depth)) {
            throw std::invalid_argument("keyframe: view and camera differ in size");
        }
        const auto spread = static_cast<float>(options.depthSpread);
        const View* fine = &view;
        View coarse;
        Camera c = camera;
        const int end = options.finest + std::max(1, options.alignment.levels);
        for (int l = 0; l < end; ++l) {
            if (l >= options.finest && std::min(c.width, c.height) < kMinSide) break;
            if (l >= options.finest) levels_.emplace_back(*fine, c, options);
            if (l + 1 == end) break;
            View half{halvedByMean(fine->intensity), halvedDepth(fine->depth, spread)};
            coarse = std::move(half);
            fine = &coarse;
            c = halved(c);
        }
        if (levels_.empty()) throw std::invalid_argument("keyframe: image too small");
        observed_.resize(levels_.size());
    }

    void observe(const ImageF& image) {
        if (!fits(image)) throw std::invalid_argument("keyframe: image and camera differ in size");
        if (options_.finest == 0) {
            observed_[0] = image;
        } else {
            observed_[0] = halvedByMean(image);
            for (int l = 1; l < options_.finest; ++l) observed_[0] = halvedByMean(observed_[0]);
        }
        for (std::size_t l = 1; l < observed_.size(); ++l) {
            observed_[l] = halvedByMean(observed_[l - 1]);
        }
    }

    const AlignmentOptions& options() const { return options_.alignment; }
    const Pose& pose() const { return T_k_w_; }
    std::size_t levels() const override { return levels_.size(); }
    const Camera& camera(std::size_t level) const override { return levels_[level].camera(); }
    std::size_t pixels() const override { return std::max<std::size_t>(1, levels_[0].size()); }
    double robustSigma() const override { return levels_[last_].robustSigma(); }

    NormalEquations compare(std::size_t level, const Pose& T_c_w, const Exposure& exposure,
                            const Loss& loss) override {
        last_ = level;
        const Pose T_c_k = T_c_w * T_k_w_.inverse();
        return onTheLeft(levels_[level].compare(observed_[level], T_c_k, exposure, loss), T_c_k);
    }

    std::vector<ImageBlock> blocks(std::size_t level, const Pose& T_c_w, const Exposure& exposure,
                                   const Loss& loss) override {
        const Pose T_c_k = sinceModel(T_c_w);
        auto blocks = levels_[level].blocks(observed_[level], T_c_k, exposure, loss);
        for (ImageBlock& block : blocks) block = onTheLeft(block, T_c_k);
        return blocks;
    }

    Pose sinceModel(const Pose& T_c_w) const override { return T_c_w * T_k_w_.inverse(); }

  private:
    bool fits(const ImageF& image) const {
        return image.getWidth() == full_.width && image.getHeight() == full_.height;
    }

    KeyframeOptions options_;
    Camera full_;
    Pose T_k_w_;
    std::vector<PointSet> levels_;
    std::vector<ImageF> observed_;
    std::size_t last_ = 0;  ///< level compared last
};

KeyframeModel::KeyframeModel(const View& view, const Camera& camera, const Pose& T_k_w,
                             const KeyframeOptions& options)
    : points_(std::make_unique<Points>(view, camera, T_k_w, options)) {}
KeyframeModel::~KeyframeModel() = default;
KeyframeModel::KeyframeModel(KeyframeModel&&) noexcept = default;
KeyframeModel& KeyframeModel::operator=(KeyframeModel&&) noexcept = default;

const Pose& KeyframeModel::pose() const { return points_->pose(); }

Alignment KeyframeModel::align(const ImageF& observed, const Pose& T_start) {
    points_->observe(observed);
    return alignCoarseToFine(*points_, points_->options(), T_start, nullptr);
}

Alignment KeyframeModel::align(const ImageF& observed, const UncertainPose& prior) {
    points_->observe(observed);
    return alignCoarseToFine(*points_, points_->options(), prior.mean, &prior);
}

}  // namespace photonav
