// SPDX-License-Identifier: BSD-3-Clause
#include "depth/epipolar_search.hpp"

#include <algorithm>
#include <cmath>

#include "photometry/bilinear.hpp"

namespace photonav {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMaxScale = 2.;      // of a patch between the images
constexpr float kRivalScore = 0.95F;  // share of the best score: as good
constexpr int kRivalDistance = 3;     // steps from the best: another place

Vector2d across(const Vector2d& along) { return {-along.y(), along.x()}; }

}  // namespace

/// Places where the patch's centre may be: start + k * spacing * along, k from 0 to steps - 1.
struct EpipolarSearch::Line {
    Vector2d start, along;  ///< pixels; unit
    double spacing = 1.;    ///< pixels
    int steps = 0;

    Vector2d at(double k) const { return start + k * spacing * along; }

    /// Cuts the line to where the whole patch is inside. @return whether nothing was cut off
    bool clip(const Camera& camera) {
        const double margin = kRadius * spacing * along.lpNorm<1>();
        double first = 0.;
        double last = steps - 1.;
        const std::array<double, 2> size = {double(camera.width), double(camera.height)};
        for (int axis = 0; axis < 2; ++axis) {
            const double d = spacing * along[axis];
            const double low = margin - start[axis];
            const double high = size[axis] - 1.001 - margin - start[axis];
            const bool isNever = low > high || (std::abs(d) < 1e-9 && (low > 0. || high < 0.));
            if (isNever) last = -1.;
            if (isNever || std::abs(d) < 1e-9) continue;
            first = std::max(first, std::min(low / d, high / d));
            last = std::min(last, std::max(low / d, high / d));
        }
        first = std::ceil(first);
        const int count = last < first ? 0 : static_cast<int>(last - first) + 1;
        const bool whole = count == steps;
        start = at(first);
        steps = count;
        return whole;
    }
};

EpipolarSearch::EpipolarSearch(const ImageF& reference, const ImageF& image, const Camera& camera,
                               const Pose& T_c_r, const EpipolarOptions& options)
    : reference_(reference),
      image_(image),
      camera_(camera),
      T_c_r_(T_c_r),
      t_r_(T_c_r.inverse().translation()),
      options_(options),
      scores_(static_cast<std::size_t>(options.maxSteps)),
      sums_(scores_.size() + kSide),
      squares_(sums_.size()) {
    strip_.fill(sums_);
}

EpipolarMatch EpipolarSearch::operator()(unsigned u, unsigned v, double low, double w,
                                         double high) {
    using enum EpipolarMatch::Outcome;
    const Vector3d f = camera_.unproject(u, v);
    const Vector2d away = -camera_.projectionJacobian(f) * t_r_;
    const Vector3d q = T_c_r_.linear() * f;
    const Vector3d& t = T_c_r_.translation();
    const auto point = [&](double inverseDepth) -> Vector3d { return q + inverseDepth * t; };
    const Vector3d h = point(w);
    if (!(h.z() > 1. / kMaxScale && h.z() < kMaxScale)) return {};
    if (point(low).z() < 0.1 || point(high).z() < 0.1 || away.squaredNorm() < 1e-12) return {};

    Line line;
    line.along = camera_.projectionJacobian(h) * t;  // by w
    if (line.along.squaredNorm() < 1e-12) return {};
    line.along.normalize();
    line.spacing = 1. / h.z();
    const Vector2d first = camera_.project(point(low));
    const double length = (camera_.project(point(high)) - first).dot(line.along);
    if (!(length < line.spacing * (options_.maxSteps - 4))) return {};
    line.start = first - line.spacing * line.along;
    line.steps = static_cast<int>(std::ceil(length / line.spacing)) + 3;
    const bool whole = line.clip(camera_);
    if (line.steps < 3 || !sampleReference(u, v, away.normalized())) return {};

    sampleStrip(line);
    float score = 0.F;
    const int best = bestStep(line.steps, score);
    if (best < 0) return {};
    if (score < options_.minScore || best == 0 || best == line.steps - 1) {
        return {.outcome = whole ? different : undecided};
    }
    const float before = scores_[best - 1];
    const float after = scores_[best + 1];
    const Vector2d place = line.at(best + 0.5 * (before - after) / (before - 2.F * score + after));
    // The place is that of q + w t: solved along the axis on which it moves more.
    const int axis = std::abs(line.along.x()) > std::abs(line.along.y()) ? 0 : 1;
    const double x = axis == 0 ? (place.x() - camera_.cx()) / camera_.fx()
                               : (place.y() - camera_.cy()) / camera_.fy();
    EpipolarMatch match{.outcome = found, .w = (q[axis] - x * q.z()) / (x * t.z() - t[axis])};
    const double variance =
        options_.matchSigma * options_.matchSigma +
        line.spacing * line.spacing * 2. * options_.sigma * options_.sigma / gradient_;
    match.sigma = std::sqrt(variance) / (camera_.projectionJacobian(point(match.w)) * t).norm();
    return match;
}

/// @return whether there is a patch with texture along the line
bool EpipolarSearch::sampleReference(unsigned u, unsigned v, const Vector2d& along) {
    const double margin = kRadius * along.lpNorm<1>();
    if (u < margin || v < margin || u > camera_.width - 1.001 - margin ||
        v > camera_.height - 1.001 - margin) {
        return false;
    }
    float sum = 0.F;
    for (int r = 0; r < kSide; ++r) {
        for (int c = 0; c < kSide; ++c) {
            const Vector2d p =
                Vector2d(u, v) + (c - kRadius) * along + (r - kRadius) * across(along);
            patch_[kSide * r + c] = bilinear(reference_, p.x(), p.y());
            sum += patch_[kSide * r + c];
        }
    }
    float energy = 0.F;
    float slopes = 0.F;
    for (int r = 0; r < kSide; ++r) {
        for (int c = 0; c < kSide; ++c) {
            float& value = patch_[kSide * r + c];
            value -= sum / (kSide * kSide);
            energy += value * value;
        }
        for (int c = 1; c + 1 < kSide; ++c) {
            const float slope = 0.5F * (patch_[kSide * r + c + 1] - patch_[kSide * r + c - 1]);
            slopes += slope * slope;
        }
    }
    // Extrapolated from the inner samples to all, less the part that noise alone would give.
    const double noise = options_.sigma * options_.sigma;
    gradient_ = static_cast<float>(slopes * kSide / (kSide - 2) - 0.5 * kSide * kSide * noise);
    if (!(gradient_ > 2. * noise) || !(energy > 0.F)) return false;
    const float scale = 1.F / std::sqrt(energy);
    for (float& value : patch_) value *= scale;
    return true;
}

/// Samples all patches of the line: neighbours share theirs.
void EpipolarSearch::sampleStrip(const Line& line) {
    const Vector2d step = line.spacing * line.along;
    for (int r = 0; r < kSide; ++r) {
        const Vector2d first = line.start - kRadius * step + (r - kRadius) * across(step);
        for (int c = 0; c < line.steps + kSide - 1; ++c) {
            strip_[r][c] = bilinear(image_, first.x() + c * step.x(), first.y() + c * step.y());
        }
    }
}

/// The step of the best correlation; -1 when another place is as good.
int EpipolarSearch::bestStep(int steps, float& score) {
    const int columns = steps + kSide - 1;
    for (int c = 0; c < columns; ++c) {
        float sum = 0.F;
        float squares = 0.F;
        for (const auto& row : strip_) {
            sum += row[c];
            squares += row[c] * row[c];
        }
        sums_[c] = sum;
        squares_[c] = squares;
    }
    std::fill_n(scores_.begin(), steps, 0.F);
    for (int r = 0; r < kSide; ++r) {
        for (int c = 0; c < kSide; ++c) {
            const float weight = patch_[kSide * r + c];
            const float* values = strip_[r].data() + c;
            for (int k = 0; k < steps; ++k) scores_[k] += weight * values[k];
        }
    }
    for (int k = 0; k < steps; ++k) {
        float sum = 0.F;
        float squares = 0.F;
        for (int c = 0; c < kSide; ++c) {
            sum += sums_[k + c];
            squares += squares_[k + c];
        }
        const float energy = squares - sum * sum / (kSide * kSide);
        scores_[k] = energy > 1e-6F ? scores_[k] / std::sqrt(energy) : 0.F;
    }
    const int best = static_cast<int>(std::max_element(scores_.begin(), scores_.begin() + steps) -
                                      scores_.begin());
    score = scores_[best];
    for (int k = 0; k < steps; ++k) {
        if (std::abs(k - best) > kRivalDistance && scores_[k] > kRivalScore * score) return -1;
    }
    return best;
}

}  // namespace photonav
