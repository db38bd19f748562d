// SPDX-License-Identifier: BSD-3-Clause
// Cost per keyframe of updating everything after a change of the map, compared with computing it
// from scratch: fusion, clearance, the snapshot for views, and finding the views that have changed.
// One thread, cells of 5 cm.
#include <fmt/format.h>

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "belief/information_field.hpp"
#include "bench_arguments.hpp"
#include "geometry/se3.hpp"
#include "image_noise.hpp"
#include "map/distance_map.hpp"
#include "map/map_fusion.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_snapshots.hpp"
#include "scene/scene.hpp"
#include "statistics.hpp"
#include "thread_time.hpp"

using namespace photonav;

namespace {

constexpr double kCell = 0.05;
constexpr int kViews = 400;  // that a planner has rendered when a keyframe arrives

struct World {
    const char* name;
    Eigen::Vector3d size;  // of the space inside the walls [m]; it begins at the origin
    Scene scene;
    std::vector<Eigen::Vector2d> corners;  // of a closed route [m]
};

void addWall(Scene& scene, const Eigen::Vector3d& corner, const Eigen::Vector3d& along,
             double height, std::size_t texture) {
    addPlane(scene, corner, along, {0., 0., height}, texture);
}

/// Floor, ceiling and the four outer walls, all textured.
World emptyWorld(const char* name, const Eigen::Vector3d& size) {
    World world{name, size, {}, {}};
    const auto carpet = addTexture(world.scene, valueNoise({.size = {8., 8.}, .seed = 4}));
    const double x = size.x(), y = size.y(), z = size.z();
    addPlane(world.scene, {0., 0., 0.}, {x, 0., 0.}, {0., y, 0.}, carpet);
    addPlane(world.scene, {0., 0., z}, {x, 0., 0.}, {0., y, 0.}, carpet);
    addWall(world.scene, {0., 0., 0.}, {x, 0., 0.}, z, carpet);
    addWall(world.scene, {0., y, 0.}, {x, 0., 0.}, z, carpet);
    addWall(world.scene, {0., 0., 0.}, {0., y, 0.}, z, carpet);
    addWall(world.scene, {x, 0., 0.}, {0., y, 0.}, z, carpet);
    return world;
}

/// A room with two free-standing walls.
World makeRoom() {
    World world = emptyWorld("room 8 x 8 x 3 m", {8., 8., 3.});
    addWall(world.scene, {4., 2.5, 0.}, {0., 3., 0.}, 2., 0);
    addWall(world.scene, {2.5, 4., 0.}, {3., 0., 0.}, 1.2, 0);
    world.corners = {{1.5, 1.5}, {6.5, 1.5}, {6.5, 6.5}, {1.5, 6.5}};
    return world;
}

/// Walls across a hall that leave a door alternately on either side.
World makeLabyrinth() {
    World world = emptyWorld("labyrinth 27 x 10 x 2.5 m", {27., 10., 2.5});
    for (int i = 1; i < 9; ++i) {
        const double y = i % 2 == 0 ? 2. : 0.;
        addWall(world.scene, {3. * i, y, 0.}, {0., 8., 0.}, 2.5, 0);
    }
    for (int i = 0; i < 9; ++i) {
        world.corners.emplace_back(3. * i + 1.5, i % 2 == 0 ? 1. : 9.);
        world.corners.emplace_back(3. * i + 1.5, i % 2 == 0 ? 9. : 1.);
    }
    return world;
}

/// Poses every 0.25 m along the route, once forth and once back; the camera looks ahead, somewhat
/// down, with random deviations.
std::vector<Pose> posesOf(const World& world) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    std::vector<Eigen::Vector2d> route = world.corners;
    route.insert(route.end(), world.corners.rbegin() + 1, world.corners.rend());
    std::vector<Pose> poses;
    for (std::size_t i = 1; i < route.size(); ++i) {
        const Eigen::Vector2d leg = route[i] - route[i - 1];
        const double yaw = std::atan2(leg.y(), leg.x());
        for (double s = 0.; s < leg.norm(); s += 0.25) {
            const Eigen::Vector2d at = route[i - 1] + s * leg.normalized();
            const Eigen::Vector3d p_w(at.x() + 0.2 * uniform(random),
                                      at.y() + 0.2 * uniform(random), 1.2 + 0.3 * uniform(random));
            const double heading = yaw + 0.6 * uniform(random);
            poses.push_back(lookFrom(p_w, 0.4 + 0.3 * uniform(random), heading));
        }
    }
    return poses;
}

View noisyView(const MeshRenderer& scene, const Camera& camera, const Pose& T_c_w, unsigned seed) {
    View view;
    scene.render(camera, T_c_w, view);
    std::mt19937 random(seed);
    addNoise(view, random);
    return view;
}

void print(const char* what, const std::vector<double>& times) {
    fmt::print("  {:22} median {:7.2f}   90 % {:7.2f}   most {:7.2f} ms\n", what,
               quantile(times, 0.5), quantile(times, 0.9), quantile(times, 1.));
}

/// Times of keyframes [first, last) of a route.
struct Times {
    std::vector<double> fuse, distance, snapshot, mark, sum;

    void print(const char* name) const {
        fmt::print(" {} ({} keyframes)\n", name, sum.size());
        ::print("fuse", fuse);
        ::print("clearance", distance);
        ::print("snapshot", snapshot);
        ::print("marking", mark);
        ::print("sum of all four", sum);
    }
};

/// Views that a planner has asked for, from poses where the camera may be.
class PlannedViews {
  public:
    PlannedViews(const World& world, const Camera& camera, std::shared_ptr<const ViewSource> views)
        : field_(std::move(views), camera, photometricModel(camera, {}), cameraMount(0.4), {}) {
        std::mt19937 random(2);
        std::uniform_real_distribution<double> uniform(0., 1.);
        for (int i = 0; i < kViews; ++i) {
            Eigen::Vector3d p_w;
            for (int a = 0; a < 3; ++a) p_w[a] = 0.3 + uniform(random) * (world.size[a] - 0.6);
            poses_.push_back(levelPose(p_w, 2. * std::numbers::pi * uniform(random)));
        }
        for (const Pose& pose : poses_) entries_.push_back(&field_.at(pose));
    }

    void update(std::shared_ptr<const ViewSource> views, const MapChange& change) {
        field_.update(std::move(views), change);
    }

    /// Renders again what was marked, so that all views are as the map is when the next keyframe
    /// arrives, and counts for how many that was in vain.
    void renew() {
        for (const InformationField::Entry* entry : entries_) {
            const Matrix6 before = entry->information;
            const bool isMarked = entry->isStale;
            field_.current(*entry);
            ++all_;
            marked_ += isMarked ? 1 : 0;
            needless_ += isMarked && entry->information == before ? 1 : 0;
        }
    }

    void printMarks() const {
        fmt::print(" of {} views a keyframe marks {:.1f} %, of which {:.0f} % had not changed\n",
                   kViews, 100. * marked_ / all_, 100. * needless_ / marked_);
    }

  private:
    InformationField field_;
    std::vector<Pose> poses_;
    std::vector<const InformationField::Entry*> entries_;
    double all_ = 0., marked_ = 0., needless_ = 0.;
};

void run(const World& world, const Camera& camera, UnknownPolicy unknown) {
    const MeshRenderer scene(world.scene);
    const std::vector<Pose> poses = posesOf(world);
    const Eigen::AlignedBox3d bounds(Eigen::Vector3d::Zero(), world.size);
    TexturedOcTree map(kCell);
    DistanceMap distances(map, bounds, {});
    VoxelSnapshots snapshots(map, unknown);
    PlannedViews planned(world, camera, snapshots.current());
    Times forth, back;
    double bricks = 0.;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const View view = noisyView(scene, camera, poses[i], static_cast<unsigned>(i));
        Times& times = i < poses.size() / 2 ? forth : back;
        MapChange change;
        times.fuse.push_back(milliseconds([&] { change = fuse(map, view, camera, poses[i]); }));
        times.distance.push_back(milliseconds([&] { distances.update(map, change); }));
        times.snapshot.push_back(milliseconds([&] { snapshots.update(map, change); }));
        times.mark.push_back(milliseconds([&] { planned.update(snapshots.current(), change); }));
        times.sum.push_back(times.fuse.back() + times.distance.back() + times.snapshot.back() +
                            times.mark.back());
        planned.renew();
        bricks += static_cast<double>(change.bricks().size()) / static_cast<double>(poses.size());
    }
    fmt::print("\n{}, {} x {} images, unknown cells {}; {:.0f} bricks change per keyframe\n",
               world.name, camera.width, camera.height,
               unknown == UnknownPolicy::free ? "free" : "occupied", bricks);
    forth.print("unknown space, first half");
    back.print("space seen before, second half");
    planned.printMarks();
    const double distance = milliseconds([&] { DistanceMap(map, bounds, {}); });
    const double snapshot = milliseconds([&] { VoxelRenderer(map, unknown); });
    const double views = milliseconds([&] { PlannedViews(world, camera, snapshots.current()); });
    const auto ratio = [](double scratch, const std::vector<double>& update) {
        return scratch / quantile(update, 0.5);
    };
    fmt::print(
        " from scratch: clearance {:.1f} ms, {:.0f} times the update's; snapshot {:.1f} ms, {:.0f} "
        "times; all {} views {:.0f} ms\n with fusion {:.0f} ms, {:.0f} times the update's\n",
        distance, ratio(distance, back.distance), snapshot, ratio(snapshot, back.snapshot), kViews,
        views, quantile(back.fuse, 0.5) + distance + snapshot + views,
        ratio(quantile(back.fuse, 0.5) + distance + snapshot + views, back.sum));
    std::fflush(stdout);
}

/// The costliest change for its size: a cell in open space, which divides the box that rays cross
/// in one step. It becomes an obstacle and free again.
void runInOpenSpace(const Eigen::Vector3d& size) {
    constexpr int kTimes = 9;
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(0.5 * kCell);
    TexturedOcTree map(kCell);
    const auto set = [&](const Eigen::Vector3d& p, bool isOccupied) {
        const auto node = map.coordToKey(p.x(), p.y(), p.z());
        map.setNodeValue(node, isOccupied ? 1.F : -1.F);
    };
    set(margin, true);
    set(size - margin, true);
    const Eigen::Vector3d middle = 0.5 * size + margin;
    DistanceMap distances(map, {Eigen::Vector3d::Zero(), size}, {.unknown = UnknownPolicy::free});
    VoxelSnapshots snapshots(map, UnknownPolicy::free);
    std::vector<double> snapshot, distance;
    for (int i = 0; i < kTimes; ++i) {
        set(middle, i % 2 == 0);
        MapChange change{.resolution = kCell};
        const double brick = MapChange::kBrickEdge * kCell;
        change.occupancy.emplace_back((middle / brick).array().floor().cast<int>());
        snapshot.push_back(milliseconds([&] { snapshots.update(map, change); }));
        distance.push_back(milliseconds([&] { distances.update(map, change); }));
    }
    const double scratch = milliseconds([&] { VoxelRenderer(map, UnknownPolicy::free); });
    fmt::print(
        "{:>5g} x {:g} x {:g} m: snapshot {:6.2f} ms, clearance {:5.2f} ms; a new snapshot {:6.1f} "
        "ms\n",
        size.x(), size.y(), size.z(), quantile(snapshot, 0.5), quantile(distance, 0.5), scratch);
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "map_update_bench");
    fmt::print("one cell in open space\n");
    runInOpenSpace({8., 8., 3.});
    runInOpenSpace({27., 10., 2.5});
    runInOpenSpace({50., 50., 5.});
    for (const World& world : {makeRoom(), makeLabyrinth()}) {
        run(world, makeCamera(188, 120, 1.2), UnknownPolicy::occupied);
        run(world, makeCamera(188, 120, 1.2), UnknownPolicy::free);
        run(world, makeCamera(376, 240, 1.2), UnknownPolicy::occupied);
    }
}
