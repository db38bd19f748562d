// SPDX-License-Identifier: BSD-3-Clause
// A cache of the information of views over body poses. Each value is computed when it is first
// needed, and again after the map has changed in its view.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "belief/view_extent.hpp"
#include "belief/view_models.hpp"
#include "map/brick_tree.hpp"

namespace photonav {

/// Information, or penalties, of views over body poses: one view per cell of a grid of poses.
///
/// The view is taken at the *centre* of the cell, so that the value depends on the pose alone and
/// not on the order of queries: a path costs the same whenever it is evaluated. Information is
/// stored in world-oriented axes, by the rotation of the camera at the centre of the cell. If it
/// were stored in the camera frame, it would be applied at headings that differ from the centre's,
/// which would mix observed and unobserved directions. Negative eigenvalues of the information that
/// a model returns are set to 0; a query throws std::domain_error if the information is not finite.
class InformationField {
  public:
    struct Options {
        double positionPitch = 0.125;  ///< edge of a cell [m]
        double rotationPitch =
            std::numbers::pi / 36.;  ///< per component of the rotation vector [rad]
        /// Number of updates over which the entries with a change in view become stale: one part of
        /// them at each update. 1: all at once.
        unsigned updatesUntilStale = 1;
    };

    struct Entry {
        Matrix6 information;  ///< about the camera centre, world-oriented axes (see Belief)
        bool isZero;          ///< no information: the update of the belief can be skipped
        bool isStale;         ///< the map has changed: call current() before use
        std::uint32_t index;  ///< number of the entry in the field
        std::uint32_t epoch;  ///< epoch of the field at which the entry was evaluated
        ViewPenalty penalty;  ///< for fields of penalties; `reduction` in world-oriented axes
    };

    /// A field of information over a map.
    /// @param views renders the map; kept until update() replaces it
    /// @param T_b_c camera mount
    /// @throws std::invalid_argument unless both pitches and `updatesUntilStale` are positive
    InformationField(std::shared_ptr<const ViewSource> views, const Camera& camera,
                     const InformationModel& model, const Pose& T_b_c, const Options& options);
    /// A field of penalties, whose views give no information about the pose.
    InformationField(std::shared_ptr<const ViewSource> views, const Camera& camera,
                     const PenaltyModel& model, const Pose& T_b_c, const Options& options);

    /// A field without a map; update() has no effect on it.
    /// @param formula empty: there is no information at any pose
    InformationField(const InformationFormula& formula, const Pose& T_b_c, const Options& options);
    InformationField(const PenaltyFormula& formula, const Pose& T_b_c, const Options& options);

    /// The information of the view from the cell of T_w_b in the map as it is now, or as it was
    /// less than `updatesUntilStale` updates ago. The reference stays valid until forget() or
    /// clear(); update() may make the entry stale.
    const Entry& at(const Pose& T_w_b);

    /// As at(), but a stale entry is returned without being evaluated again.
    const Entry& atAnyEpoch(const Pose& T_w_b);

    /// Evaluates an entry of this field again, in place, if it is stale.
    /// @returns the same entry
    const Entry& current(const Entry& entry);

    /// Updates the field after a change of the map. From now on views are rendered from `views`,
    /// and entries whose view may depend on the change become stale (see
    /// Options::updatesUntilStale). All other entries equal newly evaluated ones bit by bit, except
    /// for changes of grey values below the tolerance of MapChange::texture, if the model depends
    /// on the view alone: an entry keeps what a model that learns (of the noise of the map, of
    /// unseen places) returned when the entry was evaluated. Takes about 1 us per
    /// entry in view of a change of 600 bricks (map_update_bench): for 1000 entries as long as a
    /// few views.
    ///
    /// Assumes that cameras are inside the map's bounding box, or that the unknown space between
    /// camera and box is free.
    /// @param views of the map after the change
    /// @throws std::invalid_argument without views, for a field over a map
    void update(std::shared_ptr<const ViewSource> views, const MapChange& change);

    std::uint32_t epoch() const { return epoch_; }  ///< number of updates so far

    /// Whether the cost of motions depends on penalties instead of covariances.
    bool hasPenalties() const { return hasPenalties_; }

    const Pose& mount() const { return T_b_c_; }          ///< T_b_c, the camera mount
    std::size_t size() const { return entries_.size(); }  ///< number of entries
    std::size_t stale() const;                            ///< number of stale entries
    /// Number of entries with a change in view, summed over all updates.
    std::size_t marked() const { return marked_; }
    /// Number of views evaluated, including those evaluated again.
    std::size_t views() const { return views_; }
    std::size_t cacheHits() const { return cacheHits_; }  ///< queries answered without a view
    double seconds() const { return seconds_; }           ///< time spent on views [s]
    void forget();  ///< removes all entries; the counters stay
    void clear();   ///< removes all entries and resets the counters

  private:
    using Cell = std::array<std::int64_t, 6>;
    struct CellHash {
        std::size_t operator()(const Cell& cell) const;
    };
    using Evaluate = std::function<void(const View& view, const Pose& T_c_w, Entry& entry)>;

    InformationField(Evaluate evaluate, const Pose& T_b_c, const Options& options);
    Cell cellOf(const Pose& T_w_b) const;
    Pose cameraPose(const Cell& cell) const;  // T_c_w at the centre
    void evaluate(const Cell& cell, Entry& entry, ViewExtent& extent);
    bool isInView(const Entry& entry, const BrickTree& changed) const;

    Evaluate evaluate_;
    std::shared_ptr<const ViewSource> source_;  // none: formulas
    Camera camera_;
    bool hasPenalties_ = false;
    Pose T_b_c_;
    Options options_;
    std::unordered_map<Cell, std::uint32_t, CellHash> index_;
    std::deque<Entry> entries_;
    std::vector<Cell> cells_;                  // by entry
    std::vector<ViewExtent> extents_;          // by entry, for fields over a map
    std::vector<Eigen::AlignedBox3d> bounds_;  // of the extents
    std::vector<char> isTouched_;              // by entry: waits for its turn to become stale
    View view_;                                // rendered last
    std::uint32_t epoch_ = 0;
    std::size_t views_ = 0;
    std::size_t marked_ = 0;
    std::size_t cacheHits_ = 0;
    double seconds_ = 0.;
};

}  // namespace photonav
