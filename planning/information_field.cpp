// SPDX-License-Identifier: BSD-3-Clause
#include "information_field.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace photonav {

InformationModel photometricModel(const ViewSource& map, const Camera& camera,
                                  const PhotometricOptions& options) {
    auto view = std::make_shared<View>();
    return [&map, camera, options, view](const Pose& T_c_w) {
        map.render(camera, T_c_w, *view);
        return photometricInformation(*view, camera, options);
    };
}

InformationModel featureReprojectionModel(const ViewSource& map, const Camera& camera,
                                          const FeatureOptions& options) {
    auto view = std::make_shared<View>();
    return [&map, camera, options, view](const Pose& T_c_w) {
        map.render(camera, T_c_w, *view);
        return reprojectionInformation(visibleFeatures(*view, options), camera, options);
    };
}

PenaltyModel featureCountModel(const ViewSource& map, const Camera& camera,
                               const FeatureOptions& options) {
    auto view = std::make_shared<View>();
    return [&map, camera, options, view](const Pose& T_c_w) -> ViewPenalty {
        map.render(camera, T_c_w, *view);
        return {.base = featurePenalty(visibleFeatures(*view, options).size(), options)};
    };
}

PenaltyModel mapUncertaintyModel(const ViewSource& map, const Camera& camera,
                                 const PhotometricOptions& photometric,
                                 const MapUncertaintyOptions& options) {
    auto view = std::make_shared<View>();
    return [&map, camera, photometric, options, view](const Pose& T_c_w) -> ViewPenalty {
        map.render(camera, T_c_w, *view);
        return {.base = 1., .relief = mapCertainty(*view, camera, photometric, options)};
    };
}

InformationField::InformationField(InformationModel model, const Pose& T_b_c,
                                   const Options& options)
    : information_(std::move(model)), T_b_c_(T_b_c), options_(options) {
    if (!(options.positionPitch > 0. && options.rotationPitch > 0.)) {
        throw std::invalid_argument("information field: the pitch must be positive");
    }
}

InformationField::InformationField(PenaltyModel model, const Pose& T_b_c, const Options& options)
    : InformationField(InformationModel{}, T_b_c, options) {
    penalty_ = std::move(model);
}

const InformationField::Entry& InformationField::at(const Pose& T_w_b) {
    static const Entry kNothing{Matrix6::Zero(), true, {}};
    if (!information_ && !penalty_) return kNothing;
    ++queries_;
    const Cell cell = cellOf(T_w_b);
    if (const auto known = index_.find(cell); known != index_.end()) return entries_[known->second];
    const auto start = std::chrono::steady_clock::now();
    const Pose T_c_w = (centreOf(cell) * T_b_c_).inverse();
    Entry entry = kNothing;
    if (information_) entry.information = information_(T_c_w);
    if (penalty_) entry.penalty = penalty_(T_c_w);
    entry.isZero = entry.information.isZero(0.);
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    index_.emplace(cell, static_cast<std::uint32_t>(entries_.size()));
    return entries_.emplace_back(entry);
}

void InformationField::clear() {
    index_.clear();
    entries_.clear();
    queries_ = 0;
    seconds_ = 0.;
}

InformationField::Cell InformationField::cellOf(const Pose& T_w_b) const {
    Cell cell{};
    // Boundaries are shifted off round numbers: a pose like 0.25 m must not change cells with the
    // last bit of how it was computed.
    const auto round = [](double x) { return static_cast<std::int32_t>(std::lround(x + 1e-7)); };
    for (int i = 0; i < 3; ++i) cell[i] = round(T_w_b.translation()[i] / options_.positionPitch);
    if (!T_w_b.linear().isIdentity(0.)) {
        const Eigen::AngleAxisd rotation(T_w_b.linear());
        const Eigen::Vector3d phi = rotation.angle() * rotation.axis();
        for (int i = 0; i < 3; ++i) cell[3 + i] = round(phi[i] / options_.rotationPitch);
    }
    return cell;
}

Pose InformationField::centreOf(const Cell& cell) const {
    Pose T_w_b = Pose::Identity();
    T_w_b.translation() = options_.positionPitch * Eigen::Vector3d(cell[0], cell[1], cell[2]);
    const Eigen::Vector3d phi = options_.rotationPitch * Eigen::Vector3d(cell[3], cell[4], cell[5]);
    if (phi.squaredNorm() > 0.) {
        T_w_b.linear() = Eigen::AngleAxisd(phi.norm(), phi.normalized()).toRotationMatrix();
    }
    return T_w_b;
}

std::size_t InformationField::CellHash::operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int32_t component : cell) {
        hash = (hash ^ static_cast<std::uint32_t>(component)) * 0x9E3779B97F4A7C15ULL;
        hash ^= hash >> 29;
    }
    return hash;
}

}  // namespace photonav
