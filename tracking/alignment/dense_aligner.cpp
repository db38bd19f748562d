// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/dense_aligner.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "alignment/certain_information.hpp"
#include "alignment/hole_margin.hpp"
#include "alignment/image_pyramid.hpp"

namespace photonav {

/// Compares images with the model rendered for the camera of each level.
class DenseAligner::RenderedModel : public Comparison {
  public:
    RenderedModel(const ViewSource& model, const Camera& full, const AlignmentOptions& options)
        : options_(options), model_(model) {
        // The same information by pixels of less noise, which is correlated.
        const double noise = noiseAfterWidening(-widening(), options.photometric.scale);
        options_.photometric.sigma *= noise;
        options_.photometric.scale *= noise * noise;
        Camera c = full;
        levels_.reserve(std::max(1, options.levels));  // or all images are copied at each growth
        for (int l = 0; l < std::max(1, options.levels); ++l) {
            levels_.push_back({c,
                               ViewComparison(c, options.photometric),
                               ViewComparison(c, options.photometric),
                               {},
                               {}});
            c = halved(c);
            if (std::min(c.width, c.height) < kMinSide) break;
        }
    }

    void observe(const ImageF& image) {
        if (image.getWidth() != camera(0).width || image.getHeight() != camera(0).height) {
            throw std::invalid_argument("alignment: image and camera differ in size");
        }
        levels_[0].observed = widened(image, -widening());
        for (std::size_t l = 1; l < levels_.size(); ++l) {
            levels_[l].observed = halvedAsRendered(levels_[l - 1].observed);
        }
    }

    /// The pose is as uncertain as this from now on.
    void setPrior(const UncertainPose& prior) {
        const Level& coarsest = levels_.back();
        model_.render(coarsest.camera, prior.mean, displaced_);
        for (Level& level : levels_) {
            level.margin = holeMargin(prior.covariance, level.camera, meanDepth(displaced_));
        }
    }

    const AlignmentOptions& options() const { return options_; }
    std::size_t levels() const override { return levels_.size(); }
    const Camera& camera(std::size_t level) const override { return levels_[level].camera; }
    std::size_t pixels() const override { return std::size_t(camera(0).width) * camera(0).height; }
    double finerThanModel(double depth) const override {
        return finerThan(options_.cellSize, depth, camera(0), levels_[0].observed);
    }
    double robustSigma() const override { return levels_[last_].compare.robustSigma(); }

    NormalEquations compare(std::size_t level, const Pose& T_c_w, const Exposure& exposure,
                            const Loss& loss) override {
        last_ = level;
        lastPose_ = T_c_w;
        Level& at = levels_[level];
        render(at, T_c_w, predicted_);
        return withUnknownBlur(level, at.compare(predicted_, at.observed, exposure, loss));
    }

    std::vector<ImageBlock> blocks(std::size_t level, const Pose&, const Exposure& exposure,
                                   const Loss& loss) override {
        return withUnknownBlur(level, levels_[level].compare.blocks(exposure, loss));
    }

    bool hasTiles() const override { return true; }

    std::vector<GradientTile> tiles(std::size_t level, const Exposure& exposure) const override {
        return levels_[level].compare.tiles(exposure);
    }

    std::vector<GradientTile> resampledTiles() override {
        Level& at = levels_[last_];
        render(at, betweenPixels(at.camera), lastPose_, displaced_);
        at.comparePredictions(predicted_, atPixels(displaced_.intensity), Exposure{}, Loss{});
        return at.comparePredictions.tiles(Exposure{});
    }

    AgainstPrediction predictionAsImage(std::size_t level, const Pose& T_image_w) override {
        return [this, level, T_image_w, isRendered = false](const Pose& T_c_w) mutable {
            Level& at = levels_[level];
            const auto isSame = [&T_image_w](const Pose& T) {
                return T.matrix() == T_image_w.matrix();
            };
            if (!isRendered) {
                if (last_ == level && isSame(lastPose_)) {
                    asImage_ = predicted_;
                } else {
                    render(at, T_image_w, asImage_);
                }
                isRendered = true;
            }
            const bool isHere = isSame(T_c_w);
            if (!isHere) render(at, T_c_w, displaced_);
            return withUnknownBlur(
                level, at.comparePredictions(isHere ? asImage_ : displaced_, asImage_.intensity,
                                             Exposure{}, Loss{}));
        };
    }

  private:
    struct Level {
        Camera camera;
        ViewComparison compare, comparePredictions;
        ImageF observed;
        HoleMargin margin;
    };

    /// Variance by which images are blurrier than rendered views; negative: sharper [pixels^2].
    /// Texture in cells is blurred itself: images are compared as they are.
    double widening() const {
        if (options_.cellSize > 0.) return 0.;
        return options_.blur * options_.blur - kRenderedBlur * kRenderedBlur;
    }

    /// Of equations, or of blocks.
    template <class Equations>
    Equations withUnknownBlur(std::size_t level, Equations e) const {
        const PhotometricOptions& p = options_.photometric;
        const double ofLevel = std::ldexp(options_.modelErrors.blur, -2 * static_cast<int>(level));
        return withoutBlur(std::move(e), ofLevel, p.sigma * p.sigma / p.scale);
    }

    void render(const Level& level, const Pose& T_c_w, View& view) const {
        render(level, level.camera, T_c_w, view);
    }

    /// @param camera of the level's size
    void render(const Level& level, const Camera& camera, const Pose& T_c_w, View& view) const {
        model_.render(camera, T_c_w, view);
        if (&level == levels_.data() && widening() > 0.) {
            view.intensity = widened(view.intensity, widening());
        }
        widenHoles(view, level.margin);
    }

    AlignmentOptions options_;
    const ViewSource& model_;
    std::vector<Level> levels_;
    std::size_t last_ = 0;              ///< level compared last
    Pose lastPose_ = Pose::Identity();  ///< of predicted_
    View predicted_, asImage_, displaced_;
};

DenseAligner::DenseAligner(const ViewSource& model, const Camera& camera,
                           const AlignmentOptions& options)
    : model_(std::make_unique<RenderedModel>(model, camera, options)) {}
DenseAligner::~DenseAligner() = default;
DenseAligner::DenseAligner(DenseAligner&&) noexcept = default;
DenseAligner& DenseAligner::operator=(DenseAligner&&) noexcept = default;

const AlignmentOptions& DenseAligner::options() const { return model_->options(); }
const Camera& DenseAligner::camera() const { return model_->camera(0); }

Alignment DenseAligner::align(const ImageF& observed, const Pose& T_start) {
    model_->observe(observed);
    model_->setPrior({T_start, Matrix6::Zero()});
    return alignCoarseToFine(*model_, options(), T_start, nullptr);
}

Alignment DenseAligner::align(const ImageF& observed, const UncertainPose& prior) {
    return align(observed, prior, prior.mean);
}

Alignment DenseAligner::align(const ImageF& observed, const UncertainPose& prior,
                              const Pose& T_start) {
    model_->observe(observed);
    model_->setPrior(prior);
    return alignCoarseToFine(*model_, options(), T_start, &prior);
}

}  // namespace photonav
