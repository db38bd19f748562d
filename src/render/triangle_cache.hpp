// SPDX-License-Identifier: BSD-3-Clause
// What a view computes of the triangles in it, once per triangle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "render/surface_shader.hpp"

namespace photonav {

/// What has been computed of the triangles seen so far in this view. A triangle replaces an older
/// one in the same slot.
template <typename Seen>
class TriangleCache {
  public:
    static constexpr std::size_t kSlots = 256;
    static std::size_t slotOf(std::uint32_t id) { return id % kSlots; }

    TriangleCache() { ids_.fill(VisibilityImage::kNothing); }

    /// @param setUp computes what is not there, in place
    template <typename SetUp>
    const Seen& get(std::uint32_t id, const SetUp& setUp) {
        const std::size_t slot = slotOf(id);
        if (ids_[slot] != id) {
            ids_[slot] = id;
            setUp(seen_[slot]);
        }
        return seen_[slot];
    }

  private:
    std::array<std::uint32_t, kSlots> ids_;
    std::array<Seen, kSlots> seen_;
};

}  // namespace photonav
