// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/online_map.hpp"

#include <cmath>

#include "map/brick_leaves.hpp"
#include "onlinemap/known_map.hpp"

namespace photonav {
namespace {

constexpr double kLooksAhead = 0.25;  // horizontal part of the axis of such a camera

constexpr double kBeside = 0.02;  // [cells]
/// Standard deviation of block matching [pixels]: measured 0.2 with a projector, 0.3 without.
constexpr double kDisparity = 0.25;
// Hits in a row after which a cell is occupied however long it was free, less a half for rounding.
// A wrong hit beside a surface makes a cell occupied with the square of its probability.
constexpr float kHitsToOccupy = 1.5F;

}  // namespace

bool looksAhead(const Pose& T_b_c) { return T_b_c.linear().col(2).head<2>().norm() > kLooksAhead; }

double depthSigmaAtOneMetre(const Config& config) {
    const ExploreConfig& explore = config.explore;
    if (explore.sensor == ExploreSensor::depth) return explore.depthSigma;
    return kDisparity / (config.camera.camera().fx() * explore.baseline);
}

ObstacleRange obstacleRange(const Config& config, double distance) {
    // There three standard deviations of depth reach a surface's neighbours.
    const double beside = std::max(config.explore.cell(), kSurfaceBeside);
    const double precise = std::sqrt(beside / (3. * depthSigmaAtOneMetre(config)));
    return {distance, precise, config.bounds.min().z() - config.robotRadius,
            config.bounds.max().z() + config.robotRadius};
}

OnlineMap::OnlineMap(const Config& config, const TexturedOcTree* known)
    : cells_(known != nullptr ? std::make_shared<TexturedOcTree>(*known)
                              : std::make_shared<TexturedOcTree>(config.explore.cell())),
      states_(config.explore.cell()),
      obstacles_(config.explore.cell(), config.bounds, config.explore.unknown),
      doubted_(config.explore.cell(), config.explore.range),
      photometric_(config.photometric),
      range_(obstacleRange(config, config.explore.range)),
      radius_(config.robotRadius),
      looksDown_(!looksAhead(config.camera.T_b_c())) {
    if (config.explore.unknownInformation == UnknownInformation::predicted) unseen_.emplace();
    fusion_.maxRange = config.explore.range;
    // Matched depths err alike in neighbouring pixels: their noise does not say which are of one
    // surface.
    if (config.explore.sensor == ExploreSensor::depth)
        fusion_.depthNoise = config.explore.depthSigma;
    cells_->setClampingThresMin(octomap::probability(-kHitsToOccupy * cells_->getProbHitLog()));
    if (known != nullptr) addKnown();
}

/// What was known long ago may have changed since: a free cell is as soon occupied as one that was
/// seen in this flight.
void OnlineMap::addKnown() {
    const float least = cells_->getClampingThresMinLog();
    for (auto leaf = cells_->begin_leafs(); leaf != cells_->end_leafs(); ++leaf) {
        if (leaf->getLogOdds() < least) leaf->setLogOdds(least);
    }
    cells_->updateInnerOccupancy();
    updateKnown(whole());
    obstacles_.update(*cells_, whole());
}

MapChange OnlineMap::whole() const {
    return {.resolution = cells_->getResolution(),
            .occupancy = bricksWith(*cells_, [](const TexturedOcTreeNode&) { return true; })};
}

void OnlineMap::compare(const View& shown, const ImageF& image, const Camera& camera) {
    noise_.observe(shown, image, camera);
    if (unseen_) unseen_->observe(shown, noise_.model(camera, photometric_));
}

MapChange OnlineMap::add(const MapInput& input, const Camera& camera, const IsStopped& isStopped) {
    MapChange change;
    if (input.isMapInconsistent) change.join(forget(input.shown, camera, input.T_c_w.mean));
    if (!input.keyframe) return change;
    compare(input.shown, input.image.intensity, camera);
    change.join(fuse(input.keyframe->view, camera, input.keyframe->T_c_w, isStopped));
    return change;
}

MapChange OnlineMap::fuse(const View& image, const Camera& camera, const Pose& T_c_w,
                          const IsStopped& isStopped) {
    FusionOptions fusion = fusion_;
    fusion.isStopped = isStopped;
    const ObstaclesInView seen(image.depth, camera, T_c_w, states_, range_);
    MapChange change = photonav::fuse(*cells_, image, camera, T_c_w, fusion);
    updateKnown(change);
    change.join(obstacles_.update(*cells_, change));
    change.join(obstacles_.forget(*cells_, seen.aboveNewWalls()));
    change.join(obstacles_.remember(*cells_, image.depth, camera, T_c_w));
    doubted_.doubtAround(seen.newWalls());
    doubted_.look(image.depth, camera, T_c_w);
    if (looksDown_) {
        change.join(obstacles_.addHidden(*cells_, image, camera, T_c_w, 2. * radius_));
    }
    return change;
}

void OnlineMap::updateKnown(const MapChange& change) {
    states_.set(CellStates::bricksOf(*cells_, change.occupancy));
}

MapChange OnlineMap::forget(const View& shown, const Camera& camera, const Pose& T_c_w) {
    MapChange change{.resolution = cells_->getResolution()};
    const Pose T_w_c = T_c_w.inverse();
    const auto forgetCellAt = [&](const Eigen::Vector3d& p_w) {
        const octomap::OcTreeKey key = cells_->coordToKey(p_w.x(), p_w.y(), p_w.z());
        const TexturedOcTreeNode* known = cells_->search(key);
        if (known == nullptr || !cells_->isNodeOccupied(*known)) return;
        cells_->makeUnknown(key);
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
    change.normalize();
    updateKnown(change);
    change.join(obstacles_.update(*cells_, change));
    return change;
}

InformationModel OnlineMap::information(const Camera& camera,
                                        const PhotometricOptions& options) const {
    const InformationModel seen = noise_.model(camera, options);
    return unseen_ ? unseen_->complete(seen) : seen;
}

bool OnlineMap::isSeen(const Eigen::Vector3d& p_w) const {
    if (doubted_.contains(p_w)) return false;
    if (cells_->search(p_w.x(), p_w.y(), p_w.z()) != nullptr) return true;
    const double cell = cells_->getResolution();
    const int wall = wallCells(cell);
    int known = 0;
    for (double below = cell; below <= fusion_.maxRange && known < wall; below += cell) {
        const auto* node = cells_->search(p_w.x(), p_w.y(), p_w.z() - below);
        if (node == nullptr) continue;
        // Something may stand on a surface above which nothing is known.
        if (known == 0 && cells_->isNodeOccupied(*node)) return false;
        ++known;
    }
    return known == wall;
}

}  // namespace photonav
