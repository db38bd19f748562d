// SPDX-License-Identifier: BSD-3-Clause
// A planning problem as a YAML file describes it, with the default of every key.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "belief/belief.hpp"
#include "config/explore_config.hpp"
#include "config/fly_config.hpp"
#include "config/sweep_config.hpp"
#include "geometry/camera.hpp"
#include "map/textured_octree.hpp"
#include "photometry/photometric.hpp"
#include "planners/belief_rrt_star.hpp"
#include "render/area_sensor.hpp"

namespace photonav {

/// [x, y, z] or [x, y, z, yaw] in the world [m, rad].
struct Place {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::optional<double> yaw;
};

struct CameraConfig {
    std::string mount = "down";  ///< down, front45, forward, or degrees below the horizon
    double hfov = 70.;           ///< horizontal field of view [degrees]
    unsigned width = 188;
    unsigned height = 120;
    double blur = kAreaBlur;  ///< point spread of images, standard deviation [pixels]

    Camera camera() const;
    Pose T_b_c() const;
};

/// The planner's model of a view's information. Paths are evaluated by the photometric information,
/// whatever the planner's model is.
struct ViewModelConfig {
    std::string name = "photometric";  ///< a name of makeViewModel()
    FeatureOptions features;
    double mapPriorSigma = 1.;  ///< MapUncertaintyOptions::priorSigma
    double kappa = 2.5;         ///< metres of detour that 1 m of flight at a penalty of 1 is worth
};

/// In place of BeliefOptions::kappa: PlanningProblem::kappa() chooses it.
inline constexpr double kAutomaticKappa = std::numeric_limits<double>::quiet_NaN();
inline bool isAutomatic(double kappa) { return std::isnan(kappa); }

/// BeliefOptions with the variances of a small robot, kappa automatic.
BeliefOptions defaultBelief();

/// PhotometricOptions::scale of a camera whose noise is smoothed by a Gaussian of one pixel, about
/// as by the demosaicing of colour filters: the correlation exp(-d^2 / 4) of pixels at a distance d
/// sums to 4 pi pixels, which together count as one measurement. Rounded.
inline constexpr double kSmoothedNoiseScale = 0.08;

struct Config {
    std::string file;  ///< where this was read from

    std::string sceneFile;  ///< procedural scene (.yaml) or mesh; absolute. Either this
    std::string mapFile;    ///< or a textured OctoMap (.ot, .bt); absolute
    std::string mapMadeBy;  ///< the command that makes it, shown where it is missing
    UnknownPolicy unknownToPlanner = UnknownPolicy::occupied;
    UnknownPolicy unknownToCamera = UnknownPolicy::free;

    Eigen::AlignedBox3d bounds;
    StateKind space = StateKind::position;
    Place start;
    Place goal;
    double robotRadius = 0.2;           ///< [m]
    double clearanceResolution = 0.05;  ///< cells that a scene is sampled into for clearance [m]

    CameraConfig camera;
    PhotometricOptions photometric{.scale = kSmoothedNoiseScale};
    BeliefOptions belief = defaultBelief();
    InformationField::Options field;
    bool quickViews = false;  ///< for the planners: see PlanningProblem

    std::string planner = "belief_rrt_star";
    ViewModelConfig viewModel;
    unsigned vertices = 2500;
    SearchOptions search;  ///< of belief_rrt_star
    GrowthOptions growth;
    double rotationWeight = 0.25;  ///< turning by 1 rad costs as much as flying so many metres
    bool compareWithRrtStar = true;
    SweepConfig sweep;
    FlyConfig fly;
    ExploreConfig explore;

    std::uint32_t seed = 1;
};

/// Reads a config and applies overrides "key.path=value" on top. Paths in the file are relative to
/// the file, paths in overrides to the working directory.
/// @throws InputError naming file, key and reason for anything unknown, missing or out of range
Config loadConfig(const std::string& file, const std::vector<std::string>& overrides = {});

/// The same of the text of a config.
/// @param name of the text, for messages; paths are relative to its folder, as if it were a file
Config parseConfig(const std::string& text, const std::string& name,
                   const std::vector<std::string>& overrides = {});

/// The complete config, defaults filled in, as YAML that loadConfig() reads back.
std::string toYaml(const Config& config);

}  // namespace photonav
