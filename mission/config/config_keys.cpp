// SPDX-License-Identifier: BSD-3-Clause
#include "config/config_keys.hpp"

#include <fmt/format.h>

#include <cmath>

#include "belief/view_model_table.hpp"
#include "geometry/constants.hpp"
#include "io/number.hpp"
#include "planners/planner_traits.hpp"

namespace photonav {
namespace {

constexpr double kTiny = 1e-6;
constexpr double kFarthest = 1e5;  // of lengths [m]
constexpr double kLargest = 1e12;  // of weights: what is larger overflows in products

Place readPlace(YamlMap& root, const std::string& key, const Eigen::AlignedBox3d& bounds) {
    if (!root.has(key)) root.fail(key, "missing");
    std::vector<double> numbers;
    root.readNumbers(key, numbers, 3, 4);
    Place place{Eigen::Vector3d(numbers[0], numbers[1], numbers[2]), std::nullopt};
    if (numbers.size() == 4) {
        if (std::abs(numbers[3]) > kLargestHeading) {
            root.fail(key, fmt::format("heading beyond {} rad", kLargestHeading));
        }
        place.yaw = numbers[3];
    }
    if (!bounds.contains(place.position)) {
        const auto text = [](const Eigen::Vector3d& p) {
            return fmt::format("[{:g}, {:g}, {:g}]", p.x(), p.y(), p.z());
        };
        root.fail(key, fmt::format("{} is outside the bounds {} to {}", text(place.position),
                                   text(bounds.min()), text(bounds.max())));
    }
    return place;
}

Eigen::AlignedBox3d readBounds(YamlMap& root) {
    if (!root.has("bounds")) root.fail("bounds", "missing");
    std::vector<std::vector<double>> corners;
    root.read("bounds", corners);
    if (corners.size() != 2 || corners[0].size() != 3 || corners[1].size() != 3) {
        root.fail("bounds", "expected [[x, y, z], [x, y, z]]");
    }
    const Eigen::AlignedBox3d box(Eigen::Vector3d(corners[0].data()),
                                  Eigen::Vector3d(corners[1].data()));
    if (!box.min().allFinite() || !box.max().allFinite()) {
        root.fail("bounds", "not a finite number");
    }
    if (box.min().minCoeff() < -kFarthest || box.max().maxCoeff() > kFarthest) {
        root.fail("bounds", fmt::format("farther than {} m from the origin", kFarthest));
    }
    if (box.isEmpty()) root.fail("bounds", "the first corner must be the lower one");
    if (box.sizes().isZero(0.)) root.fail("bounds", "the bounds must not be a single point");
    return box;
}

YAML::Node nodeOf(const Place& place) {
    std::vector<double> numbers(place.position.data(), place.position.data() + 3);
    if (place.yaw) numbers.push_back(*place.yaw);
    return yamlList(numbers);
}

YAML::Node nodeOf(const Eigen::AlignedBox3d& box) {
    YAML::Node corners(YAML::NodeType::Sequence);
    for (const Eigen::Vector3d& corner : {box.min(), box.max()}) {
        corners.push_back(yamlList(std::vector<double>(corner.data(), corner.data() + 3)));
    }
    corners.SetStyle(YAML::EmitterStyle::Flow);
    return corners;
}

/// The state space by name; "auto" follows start and goal.
StateKind readSpace(YamlMap& root, const Config& config) {
    static const std::vector<std::string> kSpaces{"auto", "xyz", "xyz_yaw", "se3"};
    std::string space = "auto";
    root.readChoice("space", space, kSpaces);
    if (space == "auto") space = config.start.yaw || config.goal.yaw ? "xyz_yaw" : "xyz";
    if (space == "xyz" && config.goal.yaw) {
        root.fail("goal", "a heading at the goal needs space xyz_yaw (xyz keeps the start's)");
    }
    if (space == "xyz") return StateKind::position;
    return space == "xyz_yaw" ? StateKind::positionYaw : StateKind::se3;
}

constexpr const char* kSceneAsConfig = "is a scene file; name it as scene.file in a config";

void addWorld(KeyTable& keys, Config& c) {
    static const std::vector<std::string> kUnknown{"free", "occupied"};
    keys.beginSection("scene");
    keys.file({"file", "",
               "procedural scene (`.yaml`) or mesh; either this or `map.file`, only "
               "[`explore`](explore.md#a-map-that-is-known) takes both"},
              c.sceneFile);
    keys.beginSection("map");
    keys.file({"file", "", "OctoMap (`.ot`, `.bt`)"}, c.mapFile);
    keys.text({"made_by", "", "the command that makes the map, shown where the file is missing"},
              c.mapMadeBy);
    keys.choice({"unknown", "", "how the planner treats cells that no ray has visited"},
                c.unknownToPlanner, kUnknown);
    keys.choice({"unknown_to_camera", "", "how predicted views treat such cells"},
                c.unknownToCamera, kUnknown);
    keys.beginSection("");
    keys.add({.words = {"bounds", "m", "lower and upper corner; equal heights plan at one height"},
              .allowed = "`[[x, y, z], [x, y, z]]`",
              .read =
                  [&c](YamlMap& root) {
                      for (const char* key : {"textures", "planes", "boxes", "walls"}) {
                          if (root.has(key)) root.fail("", kSceneAsConfig);
                      }
                      if (c.sceneFile.empty() && c.mapFile.empty()) {
                          root.fail("scene.file", "give scene.file or map.file");
                      }
                      c.bounds = readBounds(root);
                  },
              .value = [&c] { return c.bounds.isEmpty() ? YAML::Node() : nodeOf(c.bounds); }});
}

void addFlight(KeyTable& keys, Config& c) {
    const auto place = [&](const KeyWords& words, Place& value) {
        keys.add(
            {.words = words,
             .allowed = "`[x, y, z]`, `[x, y, z, heading]`",
             .read = [&c, &value, name = words.name](
                         YamlMap& root) { value = readPlace(root, name, c.bounds); },
             .value = [&c, &value] { return c.bounds.isEmpty() ? YAML::Node() : nodeOf(value); }});
    };
    place({"start", "m, rad", "position, heading of the body"}, c.start);
    place({"goal", "m, rad",
           "position and heading; without a heading, the robot may arrive with any heading"},
          c.goal);
    keys.add({.words = {"space", "",
                        "`xyz` (the heading stays the start's), `xyz_yaw`, `se3`; `auto`: "
                        "`xyz_yaw` if start or goal has a heading, else `xyz`"},
              .allowed = "auto, xyz, xyz_yaw, se3",
              .read = [&c](YamlMap& root) { c.space = readSpace(root, c); },
              .value =
                  [&c] {
                      static const std::vector<std::string> kNames{"xyz", "xyz_yaw", "se3"};
                      return YAML::Node(c.bounds.isEmpty()
                                            ? "auto"
                                            : kNames.at(static_cast<std::size_t>(c.space)));
                  }});
    keys.count({"seed", "", "seed of all random numbers"}, c.seed, {1., 4294967295.});
    keys.beginSection("robot");
    keys.number({"radius", "m", "radius of the sphere that must stay free"}, c.robotRadius,
                {0., kFarthest});
    keys.number({"clearance_resolution", "m",
                 "edge of the cells in which the clearance of a scene is measured"},
                c.clearanceResolution, {1e-3, 10.});
}

void addCamera(KeyTable& keys, Config& c) {
    keys.beginSection("camera");
    keys.add({.words = {"mount", "degrees", "direction of the camera below the horizon"},
              .allowed = "down, front45, forward, -90 to 90",
              .read =
                  [&c](YamlMap& map) {
                      map.read("mount", c.camera.mount);
                      if (mountDegrees(c.camera.mount)) return;
                      map.fail("mount", "'" + c.camera.mount +
                                            "' is not down, front45, forward, or -90 to 90 degrees "
                                            "below the horizon");
                  },
              .value = [&c] { return YAML::Node(c.camera.mount); }});
    keys.count({"width", "pixels", "width of the predicted views"}, c.camera.width, {16., 8192.});
    keys.count({"height", "pixels", "height of the predicted views"}, c.camera.height,
               {16., 8192.});
    keys.number({"hfov", "degrees", "horizontal field of view"}, c.camera.hfov, {1., 170.});
    keys.number({"blur", "pixels",
                 "standard deviation of the point spread of the images; 0.2887: pixels "
                 "that average over their area, no defocus. Views of a mesh are compared "
                 "with images at this sharpness"},
                c.camera.blur, {0., 2.});
    keys.number(
        {"sigma", "grey value", "standard deviation of the image noise, grey values in [0, 1]"},
        c.photometric.sigma, {kTiny, 1.});
    keys.number({"information_scale", "",
                 "factor on the information, the inverse of the number of pixels that count as one "
                 "measurement: 1 for independent noise, 1 / (4 pi s^2) for noise smoothed by a "
                 "Gaussian of s pixels; 0.08: s = 1"},
                c.photometric.scale, {0., kLargest});
    keys.count({"stride", "pixels", "use every n-th row and column"}, c.photometric.stride,
               {1., 64.});
}

void addNoise(KeyTable& keys, Config& c) {
    keys.beginSection("noise");
    keys.variances({"initial", "m^2, rad^2", "variances at the start"}, c.belief.initialCovariance);
    keys.variances(
        {"motion", "m^2, rad^2 per m",
         "variances added per metre flown ([which metre](concepts/cost.md#with-a-heading))"},
        c.belief.motionNoise);
    keys.choice({"propagation", "", "order of the compounding"}, c.belief.order,
                {"second", "fourth"});
    keys.beginSection("features");
    keys.number({"threshold", "grey value",
                 "contrast of a corner; for `feature_reprojection` and `feature_count`"},
                c.viewModel.features.threshold, {1. / 255., 1.});
    keys.number({"pixel_sigma", "pixels", "standard deviation of a tracked corner"},
                c.viewModel.features.pixelSigma, {kTiny, 1e4});
    keys.number(
        {"reference_count", "corners", "number of corners that halves the penalty of a view"},
        c.viewModel.features.referenceCount, {kTiny, kLargest});
}

void readKappa(YamlMap& map, double& kappa) {
    if (!map.has("kappa")) return;
    std::string word;
    map.read("kappa", word);
    kappa = kAutomaticKappa;
    if (word == "auto") return;
    kappa = 0.;
    map.readNumber("kappa", kappa, 0., kLargest);
}

/// What the planner optimises.
void addObjective(KeyTable& keys, Config& c) {
    keys.beginSection("planner");
    keys.choice({"name", "", "[planners](concepts/planning.md)"}, c.planner, plannerNames());
    keys.choice({"information", "", "the information model of a view"}, c.viewModel.name,
                viewModelNames());
    keys.number({"alpha", "", "1: the shortest path, 0: the most certain one"}, c.belief.alpha,
                {0., 1.});
    keys.add(
        {.words = {"kappa", "1/m^2",
                   "metres of detour that 1 m of flight at tr(Sigma) = 1 m^2 is worth; `auto`: "
                   "[both terms weigh the same on the shortest path]"
                   "(concepts/cost.md#which-kappa)"},
         .allowed = fmt::format("auto, 0 to {}", numberText(kLargest)),
         .read = [&c](YamlMap& map) { readKappa(map, c.belief.kappa); },
         .value =
             [&c] {
                 return isAutomatic(c.belief.kappa) ? YAML::Node("auto")
                                                    : yamlNumber(c.belief.kappa);
             }});
    keys.number({"ds", "m", "longest distance flown between views"}, c.belief.ds,
                {1e-3, kFarthest});
    keys.flag({"view_at_start", "", "plans count the view from the start, which a flight takes"},
              c.belief.viewAtStart);
    keys.choice({"cost", "",
                 "uncertainty is charged by the metre flown, or per vertex (the paper's "
                 "rule)"},
                c.belief.cost, {"integral", "per_vertex"});
    keys.number({"characteristic_length", "m", "weighs rad^2 against m^2 in the trace"},
                c.belief.characteristicLength, {0., kFarthest});
    keys.number({"rotation_weight", "m/rad",
                 "turning by 1 rad costs as much as flying so many metres "
                 "([with a heading](concepts/cost.md#with-a-heading))"},
                c.rotationWeight, {0., kFarthest});
    keys.number(
        {"penalty_kappa", "", "replaces `planner.kappa` for `feature_count` and `map_uncertainty`"},
        c.viewModel.kappa, {0., kLargest});
    keys.number({"map_prior_sigma", "",
                 "standard deviation of log depth before the first view (`map_uncertainty`)"},
                c.viewModel.mapPriorSigma, {0., 100.});
    keys.number({"view_pitch", "m", "edge of a cell of the grid of views, see below"},
                c.field.positionPitch, {kTiny, 1.});
    keys.number({"view_rotation_pitch", "rad", "edge of a cell of the grid of views in rotation"},
                c.field.rotationPitch, {kTiny, 0.5});
    keys.flag({"quick_views", "",
               "rank paths by views of half the size, and evaluate the best ones by full views at "
               "their exact poses ([quick views](planner.md#quick-views))"},
              c.quickViews);
}

/// How it searches.
void addSearch(KeyTable& keys, Config& c) {
    keys.count({"vertices", "", "number of vertices of the tree or roadmap"}, c.vertices,
               {2., 1e8});
    keys.count({"labels", "", "beliefs kept per vertex (`belief_rrt_star`)"}, c.search.labels,
               {1., 1e6});
    keys.flag(
        {"informed", "", "reject most samples where no better path can pass (`belief_rrt_star`)"},
        c.search.informed);
    keys.count({"shortcut", "",
                "changes tried by the descent; 0: none (`belief_rrt_star`; `rrt_star`: to shorten "
                "its path)"},
               c.search.shortcut, {0., 1e9});
    keys.number({"range", "m", "longest motion added; 0: a fifth of the space's extent"},
                c.growth.range, {1e-3, kFarthest, true});
    keys.number({"goal_bias", "", "share of samples drawn at the goal until it is reached"},
                c.growth.goalBias, {1e-4, 1.});
    keys.number({"rewire_factor", "", "factor on the connection radius of RRT*"},
                c.growth.rewireFactor, {kTiny, kLargest});
    keys.flag({"compare_with_rrt_star", "", "`plan` also runs RRT*"}, c.compareWithRrtStar);
}

}  // namespace

/// Degrees below the horizon of a mount name or number; nothing when it is neither.
std::optional<double> mountDegrees(const std::string& mount) {
    if (mount == "down") return 90.;
    if (mount == "front45") return 45.;
    if (mount == "forward") return 0.;
    const std::optional<double> degrees = numberIn(mount);
    return degrees && std::abs(*degrees) <= 90. ? degrees : std::nullopt;
}

KeyTable keysOf(Config& config) {
    KeyTable keys;
    addWorld(keys, config);
    addFlight(keys, config);
    addCamera(keys, config);
    addNoise(keys, config);
    addObjective(keys, config);
    addSearch(keys, config);
    addKeys(keys, config.sweep);
    addKeys(keys, config.fly);
    addKeys(keys, config.explore);
    return keys;
}

}  // namespace photonav
