// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_snapshots.hpp"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

namespace photonav {
namespace {

constexpr std::size_t kMaxSpares = 2;
constexpr std::size_t kMaxUpdates = 8;  // renderers older than that are copied as a whole

}  // namespace

/// Renderers that are no longer in use.
struct VoxelSnapshots::Spares {
    struct Spare {
        std::unique_ptr<VoxelRenderer> renderer;
        std::size_t version = 0;
    };

    std::mutex mutex;
    std::vector<Spare> spares;

    /// The newest, or none.
    Spare take() {
        const std::lock_guard lock(mutex);
        if (spares.empty()) return {};
        auto newest = spares.begin();
        for (auto it = spares.begin(); it != spares.end(); ++it) {
            if (it->version > newest->version) newest = it;
        }
        Spare spare = std::move(*newest);
        spares.erase(newest);
        return spare;
    }

    void add(std::unique_ptr<VoxelRenderer> renderer, std::size_t version) {
        const std::lock_guard lock(mutex);
        if (spares.size() < kMaxSpares) spares.push_back({std::move(renderer), version});
    }
};

VoxelSnapshots::VoxelSnapshots(const TexturedOcTree& map, UnknownPolicy unknown)
    : VoxelSnapshots(map, unknown, std::make_unique<VoxelRenderer>(VoxelGrid{})) {}

VoxelSnapshots::VoxelSnapshots(const TexturedOcTree& map, UnknownPolicy unknown,
                               std::unique_ptr<VoxelRenderer> first)
    : builder_(map, unknown, first->grid_),
      spares_(std::make_shared<Spares>()),
      current_(share(std::move(first))) {}

/// When its last user releases the renderer, it is added to the spares.
std::shared_ptr<const VoxelRenderer> VoxelSnapshots::share(
    std::unique_ptr<VoxelRenderer> renderer) {
    const auto recycle = [spares = spares_, version = version_](VoxelRenderer* unused) {
        spares->add(std::unique_ptr<VoxelRenderer>(unused), version);
    };
    return {renderer.release(), recycle};
}

std::unique_ptr<VoxelRenderer> VoxelSnapshots::copyOfCurrent() const {
    Spares::Spare spare = spares_->take();
    if (spare.renderer == nullptr) return std::make_unique<VoxelRenderer>(*current_);
    const std::size_t missed = version_ - spare.version;
    if (missed > updates_.size()) {
        spare.renderer->grid_ = current_->grid_;
    } else {
        for (auto it = updates_.end() - static_cast<std::ptrdiff_t>(missed); it != updates_.end();
             ++it) {
            copyUpdate(current_->grid_, *it, spare.renderer->grid_);
        }
    }
    return std::move(spare.renderer);
}

std::shared_ptr<const VoxelRenderer> VoxelSnapshots::update(const TexturedOcTree& map,
                                                            const MapChange& change) {
    if (change.empty()) return current_;
    std::unique_ptr<VoxelRenderer> next = copyOfCurrent();
    updates_.push_back(builder_.update(map, change, next->grid_));
    if (updates_.size() > kMaxUpdates) updates_.pop_front();
    ++version_;
    current_ = share(std::move(next));
    return current_;
}

}  // namespace photonav
