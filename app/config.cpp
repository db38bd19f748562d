// SPDX-License-Identifier: BSD-3-Clause
#include "config.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "constants.hpp"
#include "octree_file.hpp"
#include "yaml_reader.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

constexpr double kTiny = 1e-6;

const std::vector<std::string> kUnknown{"free", "occupied"};
const std::vector<std::string> kSpaces{"auto", "xyz", "xyz_yaw", "se3"};
const std::vector<std::string> kCosts{"integral", "per_vertex"};
const std::vector<std::string> kOrders{"fourth", "second"};

/// Degrees below the horizon of a mount name or number; nothing when it is neither.
std::optional<double> mountDegrees(const std::string& mount) {
    if (mount == "down") return 90.;
    if (mount == "front45") return 45.;
    if (mount == "forward") return 0.;
    try {
        std::size_t used = 0;
        const double degrees = std::stod(mount, &used);
        if (used == mount.size() && degrees >= -90. && degrees <= 90.) return degrees;
    } catch (const std::exception&) {
    }
    return std::nullopt;
}

bool isPath(const std::string& key) {
    return key.ends_with(".file") || key == "sweep.reference" || key == "fly.plan" ||
           key == "fly.map";
}

/// The value of an override. A path is what was typed, whatever YAML makes of ' #' and ': ', unless
/// it is quoted; then made absolute.
YAML::Node overrideValue(const std::string& key, const std::string& text) {
    if (text.empty()) return YAML::Node("");
    try {
        const bool isQuoted = text.front() == '"' || text.front() == '\'';
        if (!isPath(key)) return YAML::Load(text);
        const auto path = isQuoted ? YAML::Load(text).as<std::string>() : text;
        return YAML::Node(path.empty() ? path : fs::absolute(path).string());
    } catch (const YAML::Exception&) {
        throw InputError("--set", key, "cannot read the value '" + text + "'");
    }
}

/// Sets node[a][b] = value for the override "a.b=value".
void applyOverride(const YAML::Node& root, const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
        throw InputError("--set", text, "expected key.path=value");
    }
    const std::string path = text.substr(0, equals);
    const YAML::Node value = overrideValue(path, text.substr(equals + 1));
    YAML::Node node = root;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('.', begin), path.size());
        const std::string key = path.substr(begin, end - begin);
        if (!node.IsMap() && !node.IsNull()) throw InputError("--set", path, "no such key");
        if (end == path.size()) {
            node[key] = value;
        } else if (!node[key].IsDefined()) {
            node[key] = YAML::Node(YAML::NodeType::Map);
        }
        node.reset(YAML::Node(node[key]));
        begin = end + 1;
    }
}

std::string resolve(const std::string& path, const std::string& configFile) {
    if (path.empty() || fs::path(path).is_absolute()) return path;
    return fs::weakly_canonical(fs::absolute(configFile).parent_path() / path).string();
}

/// Files that other commands write are often given in place of a planning problem.
void checkThatIsProblem(const std::string& file) {
    if (isOcTreeFile(file)) {
        throw InputError(file, "",
                         "is a map, not a planning problem: name it as map.file in a config "
                         "(photonav info shows what it holds)");
    }
}

void readWorld(YamlMap& root, Config& config) {
    for (const char* key : {"dataset", "scans"}) {
        if (!root.has(key)) continue;
        root.fail(key, "this is the config of a map or a replay, not of a planning problem");
    }
    YamlMap scene = root.map("scene");
    scene.read("file", config.sceneFile);
    scene.finish();
    YamlMap map = root.map("map");
    map.read("file", config.mapFile);
    map.read("made_by", config.mapMadeBy);
    std::string toPlanner = "occupied";
    std::string toCamera = "free";
    map.readChoice("unknown", toPlanner, kUnknown);
    map.readChoice("unknown_to_camera", toCamera, kUnknown);
    map.finish();
    config.unknownToPlanner = toPlanner == "free" ? UnknownPolicy::free : UnknownPolicy::occupied;
    config.unknownToCamera = toCamera == "free" ? UnknownPolicy::free : UnknownPolicy::occupied;
    config.sceneFile = resolve(config.sceneFile, root.file());
    config.mapFile = resolve(config.mapFile, root.file());
    if (config.sceneFile.empty() == config.mapFile.empty()) {
        root.fail("scene.file", "give either scene.file or map.file");
    }
}

Place readPlace(YamlMap& root, const std::string& key, const Eigen::AlignedBox3d& bounds) {
    if (!root.has(key)) root.fail(key, "missing");
    std::vector<double> numbers;
    root.readNumbers(key, numbers, 3, 4);
    Place place{Eigen::Vector3d(numbers[0], numbers[1], numbers[2]), std::nullopt};
    if (numbers.size() == 4) place.yaw = numbers[3];
    if (!bounds.contains(place.position)) root.fail(key, "outside the bounds");
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
    if (box.isEmpty()) root.fail("bounds", "the first corner must be the lower one");
    if (box.sizes().isZero(0.)) root.fail("bounds", "a point leaves nothing to plan");
    return box;
}

void readFlight(YamlMap& root, Config& config) {
    config.bounds = readBounds(root);
    config.start = readPlace(root, "start", config.bounds);
    config.goal = readPlace(root, "goal", config.bounds);
    std::string space = "auto";
    root.readChoice("space", space, kSpaces);
    if (space == "auto") space = config.start.yaw || config.goal.yaw ? "xyz_yaw" : "xyz";
    if (space == "xyz" && config.goal.yaw) {
        root.fail("goal", "a heading at the goal needs space xyz_yaw (xyz keeps the start's)");
    }
    config.space = space == "xyz"       ? StateKind::position
                   : space == "xyz_yaw" ? StateKind::positionYaw
                                        : StateKind::se3;
    YamlMap robot = root.map("robot");
    robot.readNumber("radius", config.robotRadius, 0., kInfinity);
    robot.readNumber("clearance_resolution", config.clearanceResolution, 1e-3, 10.);
    robot.finish();
}

void readCount(YamlMap& map, const std::string& key, unsigned& value, double least, double most) {
    double number = value;
    map.readNumber(key, number, least, most);
    if (number != std::floor(number)) map.fail(key, "not a whole number");
    value = static_cast<unsigned>(number);
}

void readCamera(YamlMap& root, Config& config) {
    YamlMap camera = root.map("camera");
    camera.read("mount", config.camera.mount);
    if (!mountDegrees(config.camera.mount)) {
        camera.fail("mount", "'" + config.camera.mount +
                                 "' is not down, front45, forward or degrees below the horizon");
    }
    readCount(camera, "width", config.camera.width, 8., 8192.);
    readCount(camera, "height", config.camera.height, 8., 8192.);
    camera.readNumber("hfov", config.camera.hfov, 1., 170.);
    camera.readNumber("sigma", config.photometric.sigma, kTiny, 1.);
    camera.readNumber("information_scale", config.photometric.scale, 0., kInfinity);
    unsigned stride = 1;
    readCount(camera, "stride", stride, 1., 64.);
    config.photometric.stride = static_cast<int>(stride);
    camera.finish();
}

Matrix6 readVariances(YamlMap& map, const std::string& key, const Vector6& standard) {
    Vector6 variances = standard;
    map.readVector<6>(key, variances);
    if ((variances.array() < 0.).any()) map.fail(key, "negative variance");
    return variances.asDiagonal();
}

void readNoise(YamlMap& root, Config& config) {
    YamlMap noise = root.map("noise");
    config.belief.initialCovariance = readVariances(
        noise, "initial", (Vector6() << 1e-2, 1e-2, 1e-2, 1e-5, 1e-5, 1e-4).finished());
    config.belief.motionNoise = readVariances(
        noise, "motion", (Vector6() << 1e-4, 1e-4, 1e-4, 4.5e-6, 4.5e-6, 1.35e-4).finished());
    std::string order = "fourth";
    noise.readChoice("propagation", order, kOrders);
    config.belief.order = order == "fourth" ? PropagationOrder::fourth : PropagationOrder::second;
    noise.finish();
}

void readFeatures(YamlMap& root, Config& config) {
    YamlMap features = root.map("features");
    features.readNumber("threshold", config.viewModel.features.threshold, 1. / 255., 1.);
    features.readNumber("pixel_sigma", config.viewModel.features.pixelSigma, kTiny, kInfinity);
    features.readNumber("reference_count", config.viewModel.features.referenceCount, kTiny,
                        kInfinity);
    features.finish();
}

void readPlanner(YamlMap& root, Config& config) {
    YamlMap planner = root.map("planner");
    planner.readChoice("name", config.planner, plannerNames());
    planner.readChoice("information", config.viewModel.name, viewModelNames());
    planner.readNumber("alpha", config.belief.alpha, 0., 1.);
    planner.readNumber("kappa", config.belief.kappa, 0., kInfinity);
    planner.readNumber("ds", config.belief.ds, 1e-3, kInfinity);
    std::string cost = "integral";
    planner.readChoice("cost", cost, kCosts);
    config.belief.cost = cost == "integral" ? CostRule::integral : CostRule::perVertex;
    planner.readNumber("characteristic_length", config.belief.characteristicLength, 0., kInfinity);
    readCount(planner, "vertices", config.vertices, 2., 1e8);
    readCount(planner, "labels", config.search.labels, 1., 1e6);
    planner.read("informed", config.search.informed);
    readCount(planner, "shortcut", config.search.shortcut, 0., 1e9);
    planner.readNumber("range", config.growth.range, 0., kInfinity);
    planner.readNumber("goal_bias", config.growth.goalBias, 1e-4, 1.);
    planner.readNumber("rewire_factor", config.growth.rewireFactor, kTiny, kInfinity);
    planner.readNumber("rotation_weight", config.rotationWeight, 0., kInfinity);
    planner.readNumber("penalty_kappa", config.viewModel.kappa, 0., kInfinity);
    planner.readNumber("map_prior_sigma", config.viewModel.mapPriorSigma, 0., kInfinity);
    planner.readNumber("view_pitch", config.field.positionPitch, kTiny, kInfinity);
    planner.readNumber("view_rotation_pitch", config.field.rotationPitch, kTiny, 3.2);
    planner.read("compare_with_rrt_star", config.compareWithRrtStar);
    planner.finish();
}

}  // namespace

Camera CameraConfig::camera() const { return makeCamera(width, height, hfov * kDegree); }

Pose CameraConfig::T_b_c() const { return cameraMount(mountDegrees(mount).value() * kDegree); }

const std::vector<std::string>& plannerNames() {
    static const std::vector<std::string> names{"belief_rrt_star", "pa_rrt_star", "rrbt",
                                                "rrt_star"};
    return names;
}

const std::vector<std::string>& viewModelNames() {
    static const std::vector<std::string> names{"photometric", "feature_reprojection", "none",
                                                "feature_count", "map_uncertainty"};
    return names;
}

Config loadConfig(const std::string& file, const std::vector<std::string>& overrides) {
    checkThatIsProblem(file);
    YAML::Node node = loadYaml(file);
    for (const auto& text : overrides) applyOverride(node, text);
    YamlMap root(file, node);
    Config config;
    config.file = file;
    readWorld(root, config);
    readFlight(root, config);
    readCamera(root, config);
    readNoise(root, config);
    readFeatures(root, config);
    readPlanner(root, config);
    config.sweep = readSweep(root, plannerNames());
    config.sweep.reference = resolve(config.sweep.reference, file);
    config.fly = readFly(root);
    config.fly.plan = resolve(config.fly.plan, file);
    config.fly.map = resolve(config.fly.map, file);
    readCount(root, "seed", config.seed, 1., 4294967295.);
    root.finish();
    return config;
}

std::string toYaml(const Config& c) {
    const auto place = [](const Place& p) {
        std::vector<double> numbers(p.position.data(), p.position.data() + 3);
        if (p.yaw) numbers.push_back(*p.yaw);
        return fmt::format("[{}]", fmt::join(numbers, ", "));
    };
    const auto corner = [](const Eigen::Vector3d& p) {
        return fmt::format("[{}, {}, {}]", p.x(), p.y(), p.z());
    };
    const auto variances = [](const Matrix6& m) {
        const Vector6 d = m.diagonal();
        return fmt::format("[{}]", fmt::join(d.data(), d.data() + 6, ", "));
    };
    const auto policy = [](UnknownPolicy p) { return kUnknown[p == UnknownPolicy::occupied]; };
    const auto quoted = [](const std::string& path) { return YAML::Dump(YAML::Node(path)); };
    std::string text;
    const auto line = [&](const std::string& s) { text += s + "\n"; };
    line(c.mapFile.empty() ? fmt::format("scene:\n  file: {}", quoted(c.sceneFile))
                           : fmt::format("map:\n  file: {}\n  unknown: {}\n  unknown_to_camera: {}",
                                         quoted(c.mapFile), policy(c.unknownToPlanner),
                                         policy(c.unknownToCamera)));
    if (!c.mapMadeBy.empty()) line("  made_by: " + quoted(c.mapMadeBy));
    line(fmt::format("bounds: [{}, {}]", corner(c.bounds.min()), corner(c.bounds.max())));
    line(fmt::format("space: {}", kSpaces[1 + static_cast<int>(c.space)]));
    line(fmt::format("start: {}\ngoal: {}", place(c.start), place(c.goal)));
    line(fmt::format("robot:\n  radius: {}\n  clearance_resolution: {}", c.robotRadius,
                     c.clearanceResolution));
    line(
        fmt::format("camera:\n  mount: {}\n  width: {}\n  height: {}\n  hfov: {}\n  sigma: {}\n"
                    "  information_scale: {}\n  stride: {}",
                    c.camera.mount, c.camera.width, c.camera.height, c.camera.hfov,
                    c.photometric.sigma, c.photometric.scale, c.photometric.stride));
    line(fmt::format("noise:\n  initial: {}\n  motion: {}\n  propagation: {}",
                     variances(c.belief.initialCovariance), variances(c.belief.motionNoise),
                     kOrders[c.belief.order == PropagationOrder::second]));
    line(fmt::format("features:\n  threshold: {}\n  pixel_sigma: {}\n  reference_count: {}",
                     c.viewModel.features.threshold, c.viewModel.features.pixelSigma,
                     c.viewModel.features.referenceCount));
    line(fmt::format(
        "planner:\n  name: {}\n  information: {}\n  alpha: {}\n  kappa: {}\n  ds: {}\n  cost: {}\n"
        "  characteristic_length: {}\n  vertices: {}\n  labels: {}\n  informed: {}\n"
        "  shortcut: {}",
        c.planner, c.viewModel.name, c.belief.alpha, c.belief.kappa, c.belief.ds,
        kCosts[c.belief.cost == CostRule::perVertex], c.belief.characteristicLength, c.vertices,
        c.search.labels, c.search.informed, c.search.shortcut));
    line(
        fmt::format("  range: {}\n  goal_bias: {}\n  rewire_factor: {}\n  rotation_weight: {}\n"
                    "  penalty_kappa: {}\n  map_prior_sigma: {}\n  view_pitch: {}\n  "
                    "view_rotation_pitch: {}\n  "
                    "compare_with_rrt_star: {}",
                    c.growth.range, c.growth.goalBias, c.growth.rewireFactor, c.rotationWeight,
                    c.viewModel.kappa, c.viewModel.mapPriorSigma, c.field.positionPitch,
                    c.field.rotationPitch, c.compareWithRrtStar));
    line(fmt::format("seed: {}", c.seed));
    return text + toYaml(c.sweep) + toYaml(c.fly);
}

}  // namespace photonav
