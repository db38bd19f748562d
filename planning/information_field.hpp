// SPDX-License-Identifier: BSD-3-Clause
// What a view from a body pose is worth, evaluated lazily and remembered.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <numbers>
#include <unordered_map>

#include "feature_information.hpp"
#include "map_uncertainty.hpp"
#include "photometric.hpp"
#include "view.hpp"

namespace photonav {

/// Fisher information of one view, in the camera frame, as a function of the camera pose. Swap it
/// to plan with another sensor model.
using InformationModel = std::function<Matrix6(const Pose& T_c_w)>;

/// The model of the paper: render what the camera would see, sum its photometric Jacobians.
/// `map` must outlive the returned function.
InformationModel photometricModel(const ViewSource& map, const Camera& camera,
                                  const PhotometricOptions& options);

/// Information of the visible corners' reprojection errors (Achtelik et al. 2014).
InformationModel featureReprojectionModel(const ViewSource& map, const Camera& camera,
                                          const FeatureOptions& options);

/// What flying past a view costs per metre, for planners that ask something else of a view than
/// what it tells about the pose.
struct ViewPenalty {
    double base = 0.;       ///< whatever the direction of the motion
    MapCertainty relief{};  ///< less what the motion measures of the map

    /// @param t_c way of the camera by way flown: a unit vector, shorter where the camera also
    /// turns
    double along(const Eigen::Vector3d& t_c) const {
        return base - (1. - relief.varianceLeft(t_c));
    }
};
using PenaltyModel = std::function<ViewPenalty(const Pose& T_c_w)>;

/// The fewer corners, the more (Sadat et al. 2014); see featurePenalty().
PenaltyModel featureCountModel(const ViewSource& map, const Camera& camera,
                               const FeatureOptions& options);

/// The depth variance that flying past a view leaves (Forster et al. 2014); see mapCertainty().
PenaltyModel mapUncertaintyModel(const ViewSource& map, const Camera& camera,
                                 const PhotometricOptions& photometric,
                                 const MapUncertaintyOptions& options);

/// Information, or penalties, over body poses: one view per cell of a pose grid.
///
/// The view is taken at the *centre* of the cell, so that the value depends on the pose alone and
/// not on who asked first: a path costs the same whenever it is evaluated.
class InformationField {
  public:
    struct Options {
        double positionPitch = 0.125;  ///< edge of a cell [m]
        double rotationPitch =
            std::numbers::pi / 36.;  ///< per component of the rotation vector [rad]
    };

    struct Entry {
        Matrix6 information;  ///< camera frame, left perturbation
        bool isZero;          ///< nothing to see: the update can be skipped
        ViewPenalty penalty;  ///< where the field has penalties instead of information
    };

    /// @param model empty: nothing is ever looked at, and no view tells anything
    /// @param T_b_c camera mount
    /// @throws std::invalid_argument unless both pitches are positive
    InformationField(InformationModel model, const Pose& T_b_c, const Options& options);

    /// A field of penalties, whose views tell nothing about the pose.
    InformationField(PenaltyModel model, const Pose& T_b_c, const Options& options);

    /// What the view from the cell of T_w_b is worth. The reference stays valid until clear().
    const Entry& at(const Pose& T_w_b);

    /// Whether motions are to be charged by penalty and not by covariance.
    bool hasPenalties() const { return static_cast<bool>(penalty_); }

    const Pose& mount() const { return T_b_c_; }
    std::size_t views() const { return entries_.size(); }
    std::size_t cacheHits() const { return queries_ - entries_.size(); }
    double seconds() const { return seconds_; }  ///< spent in the model
    void clear();

  private:
    using Cell = std::array<std::int32_t, 6>;
    struct CellHash {
        std::size_t operator()(const Cell& cell) const;
    };

    Cell cellOf(const Pose& T_w_b) const;
    Pose centreOf(const Cell& cell) const;

    InformationModel information_;
    PenaltyModel penalty_;
    Pose T_b_c_;
    Options options_;
    std::unordered_map<Cell, std::uint32_t, CellHash> index_;
    std::deque<Entry> entries_;
    std::size_t queries_ = 0;
    double seconds_ = 0.;
};

}  // namespace photonav
