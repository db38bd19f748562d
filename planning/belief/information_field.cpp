// SPDX-License-Identifier: BSD-3-Clause
#include "belief/information_field.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "geometry/eigensystem.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

/// The information without its negative eigenvalues. Views are summed in single precision: along
/// bars that leaves -1 1/m^2 beside 1e8, enough to turn a standard deviation of a metre into a
/// negative variance, negative costs of edges, and a tree with a cycle. The eigenvalues are those
/// in units in which the diagonal is 1.
Matrix6 withoutNegative(const Matrix6& information) {
    constexpr double kNegligible = 1e-13;
    if (!information.allFinite()) {
        throw std::domain_error("information field: the information of a view is not finite");
    }
    const auto sqrtOr1 = [](double x) { return x == 0. ? 1. : std::sqrt(std::abs(x)); };
    const Vector6 unit = information.diagonal().unaryExpr(sqrtOr1);
    const Vector6 inverse = unit.cwiseInverse();
    const auto [values, vectors] =
        eigensystem(inverse.asDiagonal() * information * inverse.asDiagonal());
    if (values[0] >= -kNegligible) return information;
    const Matrix6 V = unit.asDiagonal() * vectors;
    const Matrix6 positive = V * values.cwiseMax(0.).asDiagonal() * V.transpose();
    return 0.5 * (positive + positive.transpose());
}

void setInformation(const Matrix6& camera, const Pose& T_c_w, InformationField::Entry& entry) {
    entry.information = inRotatedAxes(withoutNegative(camera), T_c_w.linear().transpose());
    entry.isZero = camera.isZero(0.);
}

void setPenalty(const ViewPenalty& camera, const Pose& T_c_w, InformationField::Entry& entry) {
    entry.penalty = camera;
    entry.penalty.reduction.gain =
        T_c_w.linear().transpose() * camera.reduction.gain * T_c_w.linear();
}

/// The bricks of a change, each grown to the space from which it can change a view. A view depends
/// on the cells along its rays and on the cells around the ends of its rays: grey values are
/// interpolated between neighbouring faces, also across steps and borders of the surface.
BrickTree bricksThatAffectViews(const MapChange& change) {
    constexpr int kReach = 2;  // of the interpolation [cells]
    const MapChange shown{change.resolution, change.occupancy, change.texture};
    return {shown, shown.bricks(), kReach * change.resolution};
}

}  // namespace

InformationField::InformationField(Evaluate evaluate, const Pose& T_b_c, const Options& options)
    : evaluate_(std::move(evaluate)), T_b_c_(T_b_c), options_(options) {
    if (!(options.positionPitch > 0. && options.rotationPitch > 0.)) {
        throw std::invalid_argument("information field: the pitch must be positive");
    }
    if (options.updatesUntilStale == 0) {
        throw std::invalid_argument("information field: updatesUntilStale must be positive");
    }
}

InformationField::InformationField(std::shared_ptr<const ViewSource> views, const Camera& camera,
                                   const InformationModel& model, const Pose& T_b_c,
                                   const Options& options)
    : InformationField([model](const View& view, const Pose& T_c_w,
                               Entry& entry) { setInformation(model(view), T_c_w, entry); },
                       T_b_c, options) {
    source_ = std::move(views);
    camera_ = camera;
}

InformationField::InformationField(std::shared_ptr<const ViewSource> views, const Camera& camera,
                                   const PenaltyModel& model, const Pose& T_b_c,
                                   const Options& options)
    : InformationField([model](const View& view, const Pose& T_c_w,
                               Entry& entry) { setPenalty(model(view), T_c_w, entry); },
                       T_b_c, options) {
    source_ = std::move(views);
    camera_ = camera;
    hasPenalties_ = true;
}

InformationField::InformationField(const InformationFormula& formula, const Pose& T_b_c,
                                   const Options& options)
    : InformationField(Evaluate{}, T_b_c, options) {
    if (!formula) return;
    evaluate_ = [formula](const View&, const Pose& T_c_w, Entry& entry) {
        setInformation(formula(T_c_w), T_c_w, entry);
    };
}

InformationField::InformationField(const PenaltyFormula& formula, const Pose& T_b_c,
                                   const Options& options)
    : InformationField([formula](const View&, const Pose& T_c_w,
                                 Entry& entry) { setPenalty(formula(T_c_w), T_c_w, entry); },
                       T_b_c, options) {
    hasPenalties_ = true;
}

const InformationField::Entry& InformationField::at(const Pose& T_w_b) {
    return current(atAnyEpoch(T_w_b));
}

const InformationField::Entry& InformationField::atAnyEpoch(const Pose& T_w_b) {
    static const Entry kNothing{Matrix6::Zero(), true, false, 0, 0, {}};
    if (!evaluate_) return kNothing;
    const Cell cell = cellOf(T_w_b);
    if (const auto known = index_.find(cell); known != index_.end()) {
        const Entry& entry = entries_[known->second];
        cacheHits_ += entry.isStale ? 0 : 1;
        return entry;
    }
    Entry entry = kNothing;
    ViewExtent extent;
    evaluate(cell, entry, extent);
    entry.index = static_cast<std::uint32_t>(entries_.size());
    index_.emplace(cell, entry.index);
    cells_.push_back(cell);
    if (source_ != nullptr) {
        bounds_.push_back(extent.bounds(camera_, cameraPose(cell)));
        extents_.push_back(std::move(extent));
        isTouched_.push_back(0);
    }
    return entries_.emplace_back(entry);
}

const InformationField::Entry& InformationField::current(const Entry& entry) {
    if (!entry.isStale) return entry;
    const std::uint32_t i = entry.index;
    evaluate(cells_[i], entries_[i], extents_[i]);
    bounds_[i] = extents_[i].bounds(camera_, cameraPose(cells_[i]));
    return entries_[i];
}

void InformationField::evaluate(const Cell& cell, Entry& entry, ViewExtent& extent) {
    const auto start = std::chrono::steady_clock::now();
    const Pose T_c_w = cameraPose(cell);
    if (source_ != nullptr) {
        source_->render(camera_, T_c_w, view_);
        extent = ViewExtent(camera_, view_.depth);
    }
    evaluate_(view_, T_c_w, entry);
    entry.isStale = false;
    entry.epoch = epoch_;
    ++views_;
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void InformationField::update(std::shared_ptr<const ViewSource> views, const MapChange& change) {
    if (source_ == nullptr) return;
    if (views == nullptr) throw std::invalid_argument("information field: no views of the map");
    source_ = std::move(views);
    ++epoch_;
    const BrickTree changed = bricksThatAffectViews(change);
    for (Entry& entry : entries_) {
        char& isTouched = isTouched_[entry.index];
        if (entry.isStale) continue;
        if (isTouched == 0) {
            if (!isInView(entry, changed)) continue;
            isTouched = 1;
            ++marked_;
        }
        if ((entry.index + epoch_) % options_.updatesUntilStale != 0) continue;
        entry.isStale = true;
        isTouched = 0;
    }
}

/// Whether the view of an entry may depend on what changed.
bool InformationField::isInView(const Entry& entry, const BrickTree& changed) const {
    const Eigen::AlignedBox3d& bounds = bounds_[entry.index];
    const auto isNear = [&](const Eigen::AlignedBox3d& box) { return bounds.intersects(box); };
    if (!changed.any(isNear)) return false;
    const Pose T_c_w = cameraPose(cells_[entry.index]);
    return changed.any([&](const Eigen::AlignedBox3d& box) {
        return isNear(box) && extents_[entry.index].meets(camera_, T_c_w, box);
    });
}

std::size_t InformationField::stale() const {
    return std::count_if(entries_.begin(), entries_.end(),
                         [](const Entry& entry) { return entry.isStale; });
}

void InformationField::forget() {
    index_.clear();
    entries_.clear();
    cells_.clear();
    extents_.clear();
    bounds_.clear();
    isTouched_.clear();
}

void InformationField::clear() {
    forget();
    views_ = marked_ = cacheHits_ = 0;
    seconds_ = 0.;
}

InformationField::Cell InformationField::cellOf(const Pose& T_w_b) const {
    Cell cell{};
    // Boundaries are shifted off round numbers: a pose like 0.25 m must not change cells with the
    // last bit of how it was computed.
    const auto round = [](double x) { return static_cast<std::int64_t>(std::llround(x + 1e-7)); };
    for (int i = 0; i < 3; ++i) cell[i] = round(T_w_b.translation()[i] / options_.positionPitch);
    if (!T_w_b.linear().isIdentity(0.)) {
        const Eigen::AngleAxisd rotation(T_w_b.linear());
        const Eigen::Vector3d phi = rotation.angle() * rotation.axis();
        for (int i = 0; i < 3; ++i) cell[3 + i] = round(phi[i] / options_.rotationPitch);
    }
    return cell;
}

Pose InformationField::cameraPose(const Cell& cell) const {
    Pose T_w_b = Pose::Identity();
    T_w_b.translation() = options_.positionPitch * Eigen::Vector3d(cell[0], cell[1], cell[2]);
    const Eigen::Vector3d phi = options_.rotationPitch * Eigen::Vector3d(cell[3], cell[4], cell[5]);
    if (phi.squaredNorm() > 0.) {
        T_w_b.linear() = Eigen::AngleAxisd(phi.norm(), phi.normalized()).toRotationMatrix();
    }
    return (T_w_b * T_b_c_).inverse();
}

std::size_t InformationField::CellHash::operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t component : cell) {
        hash = (hash ^ static_cast<std::uint64_t>(component)) * 0x9E3779B97F4A7C15ULL;
        hash ^= hash >> 29;
    }
    return hash;
}

}  // namespace photonav
