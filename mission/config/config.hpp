// SPDX-License-Identifier: BSD-3-Clause
// A planning problem as described by a YAML file, with the default value of every key.
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
#include "io/error.hpp"
#include "map/textured_octree.hpp"
#include "photometry/map_uncertainty.hpp"
#include "photometry/photometric.hpp"
#include "planners/belief_rrt_star.hpp"
#include "render/area_sensor.hpp"

namespace photonav {

/// Largest absolute heading of a place [rad]: of 1e16 no digit is left within a turn.
inline constexpr double kLargestHeading = 1e3;

/// A position and perhaps a heading of the body in the world, [x, y, z] or [x, y, z, yaw]
/// [m, rad].
struct Place {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::optional<double> yaw;
};

struct CameraConfig {
    std::string mount = "down";  ///< down, front45, forward, or degrees below the horizon
    double hfov = 70.;           ///< horizontal field of view [degrees]
    unsigned width = 188;        ///< [pixels]
    unsigned height = 120;       ///< [pixels]
    double blur = kAreaBlur;     ///< standard deviation of the images' point spread [pixels]

    Camera camera() const;
    Pose T_b_c() const;
};

/// The planner's model of the information of a view. Final paths are always evaluated by the
/// photometric information, also if the planner uses another model.
struct ViewModelConfig {
    std::string name = "photometric";  ///< a name of makeViewModel()
    FeatureOptions features;
    double mapPriorSigma = MapUncertaintyOptions{}.priorSigma;
    /// Weight of penalties, for models that give a penalty instead of an information matrix [1/m]:
    /// metres of detour that 1 m of flight at a penalty of 1 is worth.
    double kappa = 2.5;
};

/// Value of BeliefOptions::kappa that lets PlanningProblem::kappa() choose kappa.
inline constexpr double kAutomaticKappa = std::numeric_limits<double>::quiet_NaN();
inline bool isAutomatic(double kappa) { return std::isnan(kappa); }

/// Default BeliefOptions of a config: initial and motion variances of a small robot, automatic
/// kappa.
BeliefOptions defaultBelief();

/// PhotometricOptions::scale for image noise smoothed by a Gaussian of one pixel, which is about
/// the effect of demosaicing. The correlation exp(-d^2 / 4) of two pixels at a distance of d pixels
/// then sums to 4 pi pixels, which together count as one measurement: 1 / (4 pi), rounded.
inline constexpr double kSmoothedNoiseScale = 0.08;

struct Config {
    std::string file;                         ///< the file that the config was read from
    std::vector<std::string> overrides = {};  ///< "key.path=value" of --set

    /// The error of a key whose value cannot be used. It names the file, and the command line if
    /// the value was given there.
    InputError invalid(const std::string& key, const std::string& reason) const;

    // Either sceneFile or mapFile is given; for explorations also both, see knowsMap().
    std::string sceneFile;  ///< procedural scene (.yaml) or mesh; absolute path
    std::string mapFile;    ///< textured OctoMap (.ot, .bt); absolute path
    std::string mapMadeBy;  ///< command that makes the map, shown if the map file is missing
    UnknownPolicy unknownToPlanner = UnknownPolicy::occupied;  ///< unknown cells, for clearance
    UnknownPolicy unknownToCamera = UnknownPolicy::free;       ///< unknown cells, in views

    Eigen::AlignedBox3d bounds;  ///< of the body's position, world frame [m]
    StateKind space = StateKind::position;
    Place start;
    Place goal;
    double robotRadius = 0.2;           ///< radius of the sphere that must stay free [m]
    double clearanceResolution = 0.05;  ///< edge of the cells that give a scene's clearance [m]

    CameraConfig camera;
    PhotometricOptions photometric{.scale = kSmoothedNoiseScale};
    BeliefOptions belief = defaultBelief();
    InformationField::Options field;
    bool quickViews = false;  ///< planners use views of half the size, see PlanningProblem

    std::string planner = "belief_rrt_star";
    ViewModelConfig viewModel;
    unsigned vertices = 2500;
    SearchOptions search;  ///< for belief_rrt_star only
    GrowthOptions growth;
    /// Turning by 1 rad costs as much as flying rotationWeight metres [m/rad].
    double rotationWeight = 0.25;
    bool compareWithRrtStar = true;  ///< `photonav plan` also runs RRT*
    SweepConfig sweep;
    FlyConfig fly;
    ExploreConfig explore;

    std::uint32_t seed = 1;
};

/// Reads a config file and applies overrides of the form "key.path=value". Paths in the file are
/// relative to the folder of the file, paths in overrides to the working directory.
/// @throws InputError naming file, key and reason for a key or value that is unknown, missing or
///         out of range
Config loadConfig(const std::string& file, const std::vector<std::string>& overrides = {});

/// As loadConfig(), for a config given as YAML text.
/// @param name file name that stands for the text: it is named in messages, and paths in the text
///        are relative to its folder
Config parseConfig(const std::string& text, const std::string& name,
                   const std::vector<std::string>& overrides = {});

/// The files that a config was read from and that it names; empty for those that it does not name.
std::vector<std::string> inputFiles(const Config& config);

/// The complete config with all default values, as YAML that loadConfig() can read.
std::string toYaml(const Config& config);

}  // namespace photonav
