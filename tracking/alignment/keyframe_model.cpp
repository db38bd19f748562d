// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/keyframe_model.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "alignment/image_pyramid.hpp"
#include "alignment/keyframe_points.hpp"

namespace photonav {

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
        levels_.reserve(std::size_t(end));
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
        return levels_[level].compare(observed_[level], sinceModel(T_c_w), exposure, loss);
    }

    std::vector<ImageBlock> blocks(std::size_t level, const Pose& T_c_w, const Exposure& exposure,
                                   const Loss& loss) override {
        return levels_[level].blocks(observed_[level], sinceModel(T_c_w), exposure, loss);
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
