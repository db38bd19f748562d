// SPDX-License-Identifier: BSD-3-Clause
// Are covariances right where nothing was fitted? Images that no model here can make (pixels
// average over their area, without and with noise, with a lens, with another light) are localised
// in a mesh and in maps of cells, and aligned to images with depth, with one set of defaults. A
// table of docs/experiments/tracking.md.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "alignment/dense_aligner.hpp"
#include "alignment/keyframe_model.hpp"
#include "bench_arguments.hpp"
#include "dataset/trajectory.hpp"
#include "estimation/calibration.hpp"
#include "estimation/keyframe_chain.hpp"
#include "geometry/se3.hpp"
#include "image_noise.hpp"
#include "map/map_fusion.hpp"
#include "problem/tracking_map.hpp"
#include "render/area_sensor.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"
#include "scene/scene_yaml.hpp"
#include "simulation/camera_noise.hpp"
#include "tracking_scenes.hpp"

using namespace photonav;

namespace {

using Random = std::mt19937_64;
using Picture = std::function<ImageF(const ImageF&, Random&)>;

constexpr int kSamples = 6;  // along each side of a pixel

Camera cameraOf(unsigned width) {
    return makeCamera(width, width == 640 ? 480 : 120 * width / 188, 70. * std::numbers::pi / 180.);
}

/// A light from the side, that the model does not have.
ImageF otherLight(const ImageF& ideal, Random& random) {
    ImageF image = independentNoise(ideal, random);
    for (unsigned v = 0; v < image.getHeight(); ++v) {
        for (unsigned u = 0; u < image.getWidth(); ++u) {
            image[v][u] *= 0.95F + 0.1F * static_cast<float>(u) / image.getWidth();
        }
    }
    return image;
}

/// A lamp that was not there, and a lens that loses 14 % of the light at the sides and a fifth in
/// the corners: no polynomial of second order.
ImageF lampAndLens(const ImageF& ideal, Random& random) {
    ImageF image = independentNoise(ideal, random);
    const float width = image.getWidth(), height = image.getHeight();
    std::uniform_real_distribution<float> place(0.F, 1.F);
    const float lampU = place(random) * width, lampV = place(random) * height;
    for (unsigned v = 0; v < image.getHeight(); ++v) {
        for (unsigned u = 0; u < image.getWidth(); ++u) {
            const float lamp = std::hypot(u - lampU, v - lampV) / (0.3F * width);
            const float lens = 2.F * std::hypot(u - 0.5F * width, v - 0.5F * height) / width;
            const float slope = 1.F / (1.F + 0.08F * lens * lens);  // about cos^4 of the angle
            image[v][u] *= (0.95F + 0.1F * std::exp(-0.5F * lamp * lamp)) * slope * slope;
        }
    }
    return image;
}

ImageF realCamera(const ImageF& ideal, Random& random) {
    std::uniform_real_distribution<double> gain(0.8, 1.2);
    CameraNoiseOptions options;
    options.exposure.gain = gain(random);
    return takePicture(ideal, options, random);
}

const std::vector<std::pair<std::string, Picture>>& pictures() {
    static const std::vector<std::pair<std::string, Picture>> all = {
        {"no noise", [](const ImageF& ideal, Random&) { return ideal; }},
        {"noise", independentNoise},
        {"real camera", realCamera},
        {"other light", otherLight},
        {"lamp and lens", lampAndLens}};
    return all;
}

Vector6 priorSigmas() {
    Vector6 s;
    s << Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.01);
    return s;
}

Pose wrongBy(const Vector6& sigmas, const Pose& truth, Random& random) {
    return expSE3(randomTwist(sigmas, random)) * truth;
}

/// What is seen, and from where.
struct Place {
    std::string name;
    MeshRenderer world;
    std::vector<Pose> poses;  ///< T_c_w
    bool isFlight = false;    ///< the poses are in order of time, and close
};

Place hall() {
    Place place{"hall", MeshRenderer(furnishedHall()), {}, false};
    for (int i = 0; i < 60; ++i) {
        place.poses.push_back(onCircle(2. * std::numbers::pi * i / 60, 0.5 + 0.25 * (i % 5)));
    }
    return place;
}

Place sampleFlight(const std::string& scene, const std::string& flight) {
    const std::string root = PHOTONAV_SOURCE_DIR;
    Place place{
        scene, MeshRenderer(loadSceneYaml(root + "/config/scenes/" + scene + ".yaml")), {}, true};
    for (const StampedPose& pose : readTrajectory(root + "/data/" + flight + "/groundtruth.txt")) {
        place.poses.push_back(pose.T_w_c.inverse());
    }
    return place;
}

double median(std::vector<double> values) {
    if (values.empty()) return std::nan("");
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double mean(const std::vector<double>& values) {
    double sum = 0.;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

/// A row of the table.
class Row {
  public:
    void add(const Pose& truth, const Pose& estimate, const Matrix6& covariance) {
        const Vector6 xi = logSE3(truth * estimate.inverse());
        const Eigen::Vector3d rho = xi.head<3>(), phi = xi.tail<3>();
        millimetres_.push_back(1e3 * rho.norm());
        degrees_.push_back(phi.norm() * 180. / std::numbers::pi);
        position_.push_back(rho.dot(covariance.topLeftCorner<3, 3>().ldlt().solve(rho)) / 3.);
        rotation_.push_back(phi.dot(covariance.bottomRightCorner<3, 3>().ldlt().solve(phi)) / 3.);
        const Vector6 sigmas = covariance.diagonal().cwiseSqrt();
        beyond_ += (xi.cwiseAbs().array() > 5. * sigmas.array()).any() ? 1 : 0;
    }
    void add(const Pose& truth, const Alignment& a) {
        degenerate_ += a.verdict == Verdict::degenerate ? 1 : 0;
        lost_ += isLost(a.verdict) ? 1 : 0;
        if (a.verdict == Verdict::converged) add(truth, a.T_c_w, a.covariance);
    }
    void print(const std::string& name) const {
        fmt::print(
            "{:<44} {:6.2f} mm {:6.3f} deg | {:6.2f} {:7.2f} | {:6.2f} {:7.2f} | "
            "{:3} of {:3} beyond 5 sigma, {} lost, {} degenerate\n",
            name, median(millimetres_), median(degrees_), median(position_), mean(position_),
            median(rotation_), mean(rotation_), beyond_, millimetres_.size(), lost_, degenerate_);
        std::fflush(stdout);
    }

  private:
    std::vector<double> millimetres_, degrees_, position_, rotation_;
    int beyond_ = 0, lost_ = 0, degenerate_ = 0;
};

/// A map of every image, with the noise of a camera and of a depth camera.
std::shared_ptr<TexturedOcTree> mapOf(const Place& place, double resolution) {
    auto map = std::make_shared<TexturedOcTree>(resolution);
    const Camera camera = cameraOf(376);
    Random random(3);
    View view;
    for (const Pose& T_c_w : place.poses) {
        place.world.render(camera, T_c_w, view);
        addDepthNoise(view.depth, {}, random);
        view.intensity = independentNoise(view.intensity, random);
        fuse(*map, view, camera, T_c_w);
    }
    return map;
}

/// As `photonav replay --map`.
AlignmentOptions optionsIn(MapKind kind, double cellSize) {
    AlignmentOptions options = realCameraOptions(kAreaBlur);
    options.modelErrors.surface = surfaceError(kind, cellSize);
    options.cellSize = kind == MapKind::mesh ? 0. : cellSize;
    if (kind != MapKind::mesh) options.modelNoise = ModelNoise::inCovariance;
    options.robust = RobustWeight::huber;
    return options;
}

/// As `photonav replay --odometry`.
KeyframeOptions keyframeOptions() {
    KeyframeOptions options;
    options.alignment.exposure.emplace();
    options.alignment.robust = RobustWeight::huber;
    return options;
}

void localise(const std::string& name, const Place& place, const ViewSource& model,
              const AlignmentOptions& options, unsigned width, int count) {
    const Camera camera = cameraOf(width);
    const AreaSensor sensor(place.world, kSamples);
    DenseAligner aligner(model, camera, options);
    std::vector<Row> rows(pictures().size());
    Random random(11);
    View view;
    for (int i = 0; i < count; ++i) {
        // Between the poses of the map's images.
        const Pose& near = place.poses[std::size_t(i) * place.poses.size() / std::size_t(count)];
        const Pose truth = wrongBy(priorSigmas(), near, random);
        sensor.render(camera, truth, view);
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const UncertainPose prior{wrongBy(priorSigmas(), truth, random),
                                      priorSigmas().cwiseAbs2().asDiagonal()};
            rows[k].add(truth, aligner.align(pictures()[k].second(view.intensity, random), prior));
        }
    }
    for (std::size_t k = 0; k < rows.size(); ++k) {
        rows[k].print(fmt::format("{} {}, {}", name, width, pictures()[k].first));
    }
}

/// An image with depth as a depth camera measures it.
View recorded(const ViewSource& sensor, const Camera& camera, const Pose& T_c_w,
              const Picture& picture, Random& random) {
    View view;
    sensor.render(camera, T_c_w, view);
    addDepthNoise(view.depth, {}, random);
    view.intensity = picture(view.intensity, random);
    return view;
}

void odometry(const Place& place, unsigned width, int count) {
    const Camera camera = cameraOf(width);
    const AreaSensor sensor(place.world, kSamples);
    for (const auto& [name, picture] : pictures()) {
        Row row;
        Random random(5);
        for (int i = 0; i < count; ++i) {
            const Pose& T_k_w =
                place.poses[std::size_t(i) * place.poses.size() / std::size_t(count)];
            const Pose truth = wrongBy(priorSigmas(), T_k_w, random);
            KeyframeModel model(recorded(sensor, camera, T_k_w, picture, random), camera, T_k_w,
                                keyframeOptions());
            const ImageF image = recorded(sensor, camera, truth, picture, random).intensity;
            row.add(truth, model.align(image, T_k_w));
        }
        row.print(fmt::format("{}, odometry {}, {}", place.name, width, name));
    }
}

/// Position and covariance after `kLength` images, each aligned to a keyframe before.
void chains(const Place& place, unsigned width, int count) {
    constexpr std::size_t kLength = 40;
    const Camera camera = cameraOf(width);
    const AreaSensor sensor(place.world, kSamples);
    const Matrix6 motion = (25. * priorSigmas().cwiseAbs2()).asDiagonal();
    Row row;
    Random random(6);
    for (int c = 0; c < count; ++c) {
        const std::size_t begin =
            std::size_t(c) * (place.poses.size() - kLength) / std::size_t(count);
        KeyframeChain chain(camera, {.keyframe = keyframeOptions()});
        Pose truth = place.poses[begin];
        chain.begin(recorded(sensor, camera, truth, realCamera, random),
                    {truth, 1e-12 * Matrix6::Identity()}, 0.);
        UncertainPose belief{truth, Matrix6::Zero()};
        bool isLostNow = false;
        for (std::size_t i = 1; i < kLength && !isLostNow; ++i) {
            truth = place.poses[begin + i];
            const View view = recorded(sensor, camera, truth, realCamera, random);
            const Alignment a = chain.align(view.intensity, {belief.mean, motion});
            isLostNow = isLost(a.verdict);
            belief = chain.beliefOf(a);
            chain.add(view, belief, double(i), a.overlap, a.meanDepth);
        }
        if (!isLostNow) row.add(truth, belief.mean, belief.covariance);
    }
    row.print(fmt::format("{}, {} chains {}, real camera", place.name, count, width));
}

void table(const Place& place, int count, unsigned widest, double smallest) {
    const std::vector<unsigned> widths = {188, 376, 640};
    const auto everyWidth = [&](const auto& rows) {
        for (const unsigned width : widths) {
            if (width <= widest) rows(width);
        }
    };
    everyWidth([&](unsigned width) {
        localise(place.name + ", mesh", place, place.world, optionsIn(MapKind::mesh, 0.), width,
                 count);
    });
    for (const double cell : {0.05, 0.025, 0.01}) {
        if (cell < smallest) continue;
        const auto map = mapOf(place, cell);
        const VoxelRenderer views(*map, UnknownPolicy::free);
        everyWidth([&](unsigned width) {
            localise(fmt::format("{}, {:g} cm", place.name, 100. * cell), place, views,
                     optionsIn(MapKind::surfaces, cell), width, count);
        });
    }
    everyWidth([&](unsigned width) { odometry(place, width, count); });
    if (!place.isFlight) return;
    everyWidth([&](unsigned width) { chains(place, width, count); });
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv,
                                   "residual_covariance_bench [ALIGNMENTS_PER_ROW=40] "
                                   "[LARGEST_WIDTH=640] [SMALLEST_CELL=0.01]");
    const int count = arguments.number(1, 40, 5);
    const auto widest = arguments.number(2, 640U, 188U);
    const double smallest = arguments.number(3, 0.01);
    fmt::print(
        "{} alignments a row: median errors | median and mean NEES / 3 of position | of "
        "rotation, of those that converged\n",
        count);
    table(hall(), count, widest, smallest);
    table(sampleFlight("two_textures", "flight_down"), count, widest, smallest);
    table(sampleFlight("room", "flight_front45"), count, widest, smallest);
}
