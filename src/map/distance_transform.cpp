// SPDX-License-Identifier: BSD-3-Clause
#include "map/distance_transform.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace photonav {
namespace {

using Eigen::Array3i;

constexpr int kBlock = DistanceTransform::kBlock;

int inBlocks(int n) { return (n + kBlock - 1) / kBlock; }

/// out[x] = min over |k| < reach of in[x + k * stride] + k^2 for one block of x: for a small cap it
/// is fastest to try all parabolas. Stops when no further k can improve.
void lowerEnvelope(const std::uint16_t* in, std::ptrdiff_t stride, int reach, std::uint16_t* out) {
    std::uint16_t best[kBlock];
    std::copy_n(in, kBlock, best);
    for (int k = 1; k < reach; ++k) {
        const auto square = static_cast<std::uint16_t>(k * k);
        const std::uint16_t* below = in - k * stride;
        const std::uint16_t* above = in + k * stride;
        std::uint16_t worst = 0;
        for (int x = 0; x < kBlock; ++x) {
            const auto near = std::min(below[x], above[x]);
            best[x] = std::min(best[x], static_cast<std::uint16_t>(near + square));
            worst = std::max(worst, best[x]);
        }
        if (worst <= (k + 1) * (k + 1)) break;
    }
    const auto cap = static_cast<std::uint16_t>(reach * reach);
    for (int x = 0; x < kBlock; ++x) out[x] = std::min(best[x], cap);
}

/// Marks the elements of a line that lie less than `reach` from a changed one.
void markReached(const std::uint8_t* changed, int n, int reach, std::vector<std::uint8_t>& marks) {
    marks.assign(n, 0);
    for (int i = 0; i < n; ++i) {
        if (changed[i] == 0) continue;
        const int low = std::max(i - reach + 1, 0), high = std::min(i + reach, n);
        std::fill(marks.begin() + low, marks.begin() + high, std::uint8_t{1});
    }
}

}  // namespace

DistanceTransform::DistanceTransform(const Array3i& inner, int reach)
    : inner_(inner),
      reach_(reach),
      pitch_(kBlock * inBlocks(kBlock * inBlocks(inner.x()) + 2 * reach)) {
    const Array3i n = outer();
    const std::size_t blocks = pitch_ / kBlock;
    column_.assign(std::size_t(pitch_) * n.y() * n.z(), static_cast<std::uint8_t>(reach));
    plane_.assign(std::size_t(pitch_) * inner.y() * inner.z(),
                  static_cast<std::uint16_t>(reach * reach));
    changedCells_.resize(blocks * n.z());
    changedColumn_.assign(blocks * inner.y() * n.z(), 0);
    changedPlane_.assign(blocks * inner.y() * inner.z(), 0);
    squares_.resize(std::size_t(kBlock) * n.z());
}

double DistanceTransform::bytes(const Eigen::Array3d& inner, double reach) {
    const Eigen::Array3d outer = inner + 2. * reach;
    return outer.prod() + 2. * outer.x() * inner.y() * inner.z();
}

void DistanceTransform::set(const Array3i& first, const Array3i& last, bool isObstacle) {
    const Array3i from = first.max(0), to = last.min(outer());
    for (int z = from.z(); z < to.z(); ++z) {
        for (int y = from.y(); y < to.y(); ++y) {
            std::uint8_t* row = column(0, y, z);
            for (int x = from.x(); x < to.x(); ++x) setCell(row, x, y, z, isObstacle);
        }
    }
}

void DistanceTransform::setBlock(const Array3i& first, const std::array<bool, 64>& isObstacle) {
    const Array3i from = first.max(0), to = (first + 4).min(outer());
    for (int z = from.z(); z < to.z(); ++z) {
        for (int y = from.y(); y < to.y(); ++y) {
            std::uint8_t* row = column(0, y, z);
            const bool* cells = &isObstacle[16 * (z - first.z()) + 4 * (y - first.y())];
            for (int x = from.x(); x < to.x(); ++x) setCell(row, x, y, z, cells[x - first.x()]);
        }
    }
}

/// @param row of the cell
void DistanceTransform::setCell(std::uint8_t* row, int x, int y, int z, bool isObstacle) {
    if ((row[x] == 0) == isObstacle) return;
    row[x] = isObstacle ? std::uint8_t{0} : static_cast<std::uint8_t>(reach_);
    changedCells_[std::size_t(x / kBlock) * outer().z() + z].extend(y);
}

void DistanceTransform::update(const Visit& visit) {
    const int blocks = pitch_ / kBlock, depth = outer().z();
    reached_ = {};
    for (int block = 0; block < blocks; ++block) {
        for (int z = 0; z < depth; ++z) {
            const Range changed =
                std::exchange(changedCells_[std::size_t(block) * depth + z], Range{});
            if (changed.low <= changed.high) updateColumns(block, z, changed);
        }
    }
    for (int y = reached_.y.low; y <= reached_.y.high; ++y) {
        reached_.z = {};
        for (int block = reached_.block.low; block <= reached_.block.high; ++block) {
            updatePlane(block, y);
        }
        for (int z = reached_.z.low; z <= reached_.z.high; ++z) updateRows(y, z, visit);
    }
}

/// Two sweeps over the columns of one block, between obstacles that are near enough.
void DistanceTransform::updateColumns(int block, int z, const Range& changed) {
    const int height = outer().y(), x = block * kBlock;
    const int low = std::max(changed.low - reach_ + 1, 0);
    const int high = std::min(changed.high + reach_ - 1, height - 1);
    const int first = std::max(low - reach_ + 1, 0), last = std::min(high + reach_ - 1, height - 1);
    std::vector<std::array<std::uint8_t, kBlock>> rows(last - first + 1);
    for (int y = first; y <= last; ++y) {
        const std::uint8_t* from = column(x, y, z);
        for (int i = 0; i < kBlock; ++i) {
            rows[y - first][i] = from[i] == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(reach_);
        }
    }
    const auto relax = [&](auto& row, const auto& neighbour) {
        for (int i = 0; i < kBlock; ++i) {
            row[i] = std::min(row[i], static_cast<std::uint8_t>(neighbour[i] + 1));
        }
    };
    for (std::size_t i = 1; i < rows.size(); ++i) relax(rows[i], rows[i - 1]);
    for (std::size_t i = rows.size() - 1; i > 0; --i) relax(rows[i - 1], rows[i]);
    for (int y = low; y <= high; ++y) {
        const bool held = y >= changed.low && y <= changed.high;  // cells that were set
        const auto& row = rows[y - first];
        if (!held && std::memcmp(row.data(), column(x, y, z), kBlock) == 0) continue;
        std::copy_n(row.data(), kBlock, column(x, y, z));
        const int inner = y - reach_;
        if (inner < 0 || inner >= inner_.y()) continue;
        changedColumn_[(std::size_t(inner) * (pitch_ / kBlock) + block) * outer().z() + z] = 1;
        reached_.y.extend(inner);
        reached_.block.extend(block);
    }
}

void DistanceTransform::updatePlane(int block, int y) {
    const int depth = outer().z(), x = block * kBlock, blocks = pitch_ / kBlock;
    std::uint8_t* changed = changedColumn_.data() + (std::size_t(y) * blocks + block) * depth;
    if (std::find(changed, changed + depth, 1) == changed + depth) return;
    markReached(changed, depth, reach_, todo_);
    for (int z = 0; z < depth; ++z) changed[z] = 0;
    for (int z = 0; z < depth; ++z) {
        const std::uint8_t* distance = column(x, y + reach_, z);
        std::uint16_t* squares = squares_.data() + std::ptrdiff_t(z) * kBlock;
        for (int i = 0; i < kBlock; ++i) {
            squares[i] = static_cast<std::uint16_t>(distance[i] * distance[i]);
        }
    }
    for (int z = 0; z < inner_.z(); ++z) {
        if (todo_[z + reach_] == 0) continue;
        std::uint16_t out[kBlock];
        lowerEnvelope(squares_.data() + std::ptrdiff_t(z + reach_) * kBlock, kBlock, reach_, out);
        if (std::memcmp(out, plane(x, y, z), sizeof(out)) == 0) continue;
        std::copy_n(out, kBlock, plane(x, y, z));
        changedPlane_[(std::size_t(y) * inner_.z() + z) * blocks + block] = 1;
        reached_.z.extend(z);
    }
}

void DistanceTransform::updateRows(int y, int z, const Visit& visit) {
    const int blocks = pitch_ / kBlock;
    std::uint8_t* changed = changedPlane_.data() + (std::size_t(y) * inner_.z() + z) * blocks;
    if (std::memchr(changed, 1, blocks) == nullptr) return;
    for (int x = 0; x < inner_.x(); x += kBlock) {
        const int first = (x + 1) / kBlock;  // an inner cell x is the outer cell x + reach
        const int last = std::min((x + kBlock + 2 * reach_ - 2) / kBlock, blocks - 1);
        if (std::memchr(changed + first, 1, last - first + 1) == nullptr) continue;
        std::uint16_t out[kBlock];
        lowerEnvelope(plane(x + reach_, y, z), 1, reach_, out);
        visit(x, y, z, std::min(kBlock, inner_.x() - x), out);
    }
    std::memset(changed, 0, blocks);
}

}  // namespace photonav
