// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/own_map.hpp"

namespace photonav {
namespace {

constexpr double kLooksAhead = 0.25;  // horizontal part of the axis of such a camera

constexpr double kBeside = 0.02;      // [cells]
constexpr float kForgotten = -0.01F;  // log odds: free, until a surface is seen there once

Eigen::Array3i brickOf(const octomap::OcTreeKey& key) {
    return Eigen::Array3i(key[0] - kKeyOfZero, key[1] - kKeyOfZero, key[2] - kKeyOfZero)
        .unaryExpr([](int cell) { return cell >> 2; });
}

/// Depths that are fused; the others are 0.
ImageF fusedDepth(const ImageF& depth, const FusionOptions& fusion) {
    ImageF fused = depth;
    for (unsigned i = 0; i < fused.getSize(); ++i) {
        float& z = fused.bitmap[i];
        if (!(z >= fusion.minRange && z <= fusion.maxRange)) z = 0.F;
    }
    return fused;
}

}  // namespace

bool looksAhead(const Pose& T_b_c) { return T_b_c.linear().col(2).head<2>().norm() > kLooksAhead; }

OwnMap::OwnMap(const Config& config)
    : cells_(std::make_shared<TexturedOcTree>(config.explore.resolution)),
      obstacles_(config.explore.resolution, config.bounds, config.explore.unknown),
      errors_(std::make_shared<MapErrors>(config.explore.resolution)),
      photometric_(config.photometric),
      radius_(config.robotRadius),
      looksDown_(!looksAhead(config.camera.T_b_c())) {
    if (config.explore.unknownInformation == UnknownInformation::predicted) unseen_.emplace();
    fusion_.maxRange = config.explore.range;
}

void OwnMap::compare(const View& shown, const ImageF& image, const Camera& camera) {
    noise_.observe(shown, image, camera);
    if (unseen_) unseen_->observe(shown, noise_.model(camera, photometric_)(shown));
}

MapChange OwnMap::fuse(const View& image, const Camera& camera, const Pose& T_c_w, int number) {
    MapChange change = photonav::fuse(*cells_, image, camera, T_c_w, fusion_);
    errors_->addSurfaces(number, fusedDepth(image.depth, fusion_), camera);
    change.join(obstacles_.update(*cells_, change));
    if (looksDown_) {
        change.join(obstacles_.addHidden(*cells_, image, camera, T_c_w, 2. * radius_));
    }
    return change;
}

MapChange OwnMap::forget(const View& shown, const Camera& camera, const Pose& T_c_w) {
    MapChange change{.resolution = cells_->getResolution()};
    const Pose T_w_c = T_c_w.inverse();
    const auto forgetCellAt = [&](const Eigen::Vector3d& p_w) {
        const octomap::OcTreeKey key = cells_->coordToKey(p_w.x(), p_w.y(), p_w.z());
        const TexturedOcTreeNode* known = cells_->search(key);
        if (known == nullptr || !cells_->isNodeOccupied(*known)) return;
        TexturedOcTreeNode* cell = cells_->setNodeValue(key, kForgotten, true);
        cell->faces = {};
        cell->surfaces.clear();
        change.occupancy.push_back(brickOf(key));
    };
    for (unsigned v = 0; v < shown.depth.getHeight(); ++v) {
        for (unsigned u = 0; u < shown.depth.getWidth(); ++u) {
            const double z = shown.depth[v][u];
            if (!(z > 0.)) continue;
            // A surface may lie on the border of two cells.
            for (const double beside : {-kBeside, kBeside}) {
                forgetCellAt(T_w_c * camera.unproject(u, v, z + beside * change.resolution));
            }
        }
    }
    cells_->updateInnerOccupancy();
    change.normalize();
    change.join(obstacles_.update(*cells_, change));
    return change;
}

InformationModel OwnMap::information(const Camera& camera,
                                     const PhotometricOptions& options) const {
    const InformationModel seen = noise_.model(camera, options);
    return unseen_ ? unseen_->complete(seen) : seen;
}

bool OwnMap::isSeen(const Eigen::Vector3d& p_w) const {
    const double cell = cells_->getResolution();
    for (double below = 0.; below <= fusion_.maxRange; below += cell) {
        if (cells_->search(p_w.x(), p_w.y(), p_w.z() - below) != nullptr) return true;
    }
    return false;
}

}  // namespace photonav
