// SPDX-License-Identifier: BSD-3-Clause
// Our information of views beside the Fisher Information Field (FIF), at the same poses of a scene:
// time of a query, memory, the best heading, and plans, which our exact beliefs evaluate.
#include "fif_field.hpp"

#include <algorithm>
#include <map>
#include <random>

#include "../bench_arguments.hpp"
#include "geometry/se3.hpp"
#include "heading_agreement.hpp"
#include "peer_maps.hpp"
#include "planners/planner_table.hpp"
#include "problem/planning_problem.hpp"
#include "sweep/comparison.hpp"

using namespace photonav;
using namespace photonav::peers;

namespace {

constexpr double kLandmarkCell = 0.05;       // corners within are one landmark [m]
constexpr int kLandmarkViews = 3;            // that have to show a landmark
constexpr std::size_t kMappingViews = 4000;  // in which landmarks are detected
constexpr std::size_t kQueries = 2000;       // whose time is measured
/// Of the parameters that come with FIF: a cone of 40 degrees about the axis, nearly as far as the
/// corners of our image.
constexpr const char* kGaussianProcess = "fov40_fs50_lm1000_k10_fast";

/// A scene, its camera, and the information models of its views.
struct Setup {
    Config config;
    World world;
    Camera camera;
    Pose T_b_c;
    InformationModel ours, corners;

    explicit Setup(const std::string& file)
        : config(loadConfig(file)),
          world(config),
          camera(config.camera.camera()),
          T_b_c(config.camera.T_b_c()),
          ours(photometricModel(camera, config.photometric)),
          corners(featureReprojectionModel(camera, config.viewModel.features)) {}

    Pose cameraPose(const Eigen::Vector3d& p_w, double yaw) const {
        return (levelPose(p_w, yaw) * T_b_c).inverse();
    }
};

/// Positions in the bounds that are free for the robot.
std::vector<Eigen::Vector3d> freePositions(const Setup& setup, std::size_t count,
                                           std::uint32_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0., 1.);
    const Eigen::AlignedBox3d& bounds = setup.config.bounds;
    std::vector<Eigen::Vector3d> positions;
    while (positions.size() < count) {
        const Eigen::Vector3d share(uniform(random), uniform(random), uniform(random));
        const Eigen::Vector3d p_w = bounds.min() + share.cwiseProduct(bounds.sizes());
        if (setup.world.clearance(p_w) > setup.config.robotRadius) positions.push_back(p_w);
    }
    return positions;
}

/// Body poses at the positions with random headings.
std::vector<Pose> randomPoses(const std::vector<Eigen::Vector3d>& positions, std::uint32_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> yaw(-std::numbers::pi, std::numbers::pi);
    std::vector<Pose> poses;
    for (const Eigen::Vector3d& p_w : positions) poses.push_back(levelPose(p_w, yaw(random)));
    return poses;
}

/// The corners of views at random free poses. Corners within one cell are one landmark, at their
/// mean; landmarks that few views show are left out.
std::vector<Landmark> landmarksOf(const Setup& setup) {
    struct Sum {
        Eigen::Vector3d position = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
        int views = 0;
    };
    std::map<std::array<long, 3>, Sum> sums;
    View view;
    for (const Pose& T_w_b : randomPoses(freePositions(setup, kMappingViews, 11), 12)) {
        const Pose T_w_c = T_w_b * setup.T_b_c;
        setup.world.views().render(setup.camera, T_w_c.inverse(), view);
        for (const Feature& corner : visibleFeatures(view, setup.config.viewModel.features)) {
            const Eigen::Vector3d p_w =
                T_w_c * setup.camera.unproject(corner.u, corner.v, corner.depth);
            Sum& sum =
                sums[{std::lround(p_w.x() / kLandmarkCell), std::lround(p_w.y() / kLandmarkCell),
                      std::lround(p_w.z() / kLandmarkCell)}];
            sum.position += p_w;
            sum.direction += (T_w_c.translation() - p_w).normalized();
            ++sum.views;
        }
    }
    std::vector<Landmark> landmarks;
    for (const auto& [cell, sum] : sums) {
        if (sum.views < kLandmarkViews) continue;
        landmarks.push_back({sum.position / sum.views, sum.direction.normalized()});
    }
    return landmarks;
}

/// The information of all landmarks that a view shows, by bearings with a standard deviation of
/// 1 rad: the sum that FIF's field approximates, with the exact field of view and occlusion.
Matrix6 landmarkInformation(const std::vector<Landmark>& landmarks, const View& view,
                            const Camera& camera, const Pose& T_c_w) {
    constexpr double kDepthTolerance = 0.05;  // [m]
    Matrix6 sum = Matrix6::Zero();
    for (const Landmark& landmark : landmarks) {
        const Eigen::Vector3d p_c = T_c_w * landmark.position;
        if (p_c.z() < 0.1) continue;
        const Eigen::Vector2d pixel = camera.project(p_c);
        const long u = std::lround(pixel.x()), v = std::lround(pixel.y());
        if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) continue;
        if (view.depth[static_cast<unsigned>(v)][static_cast<unsigned>(u)] <
            p_c.z() - kDepthTolerance)
            continue;
        Eigen::Matrix<double, 3, 6> J;
        J << Eigen::Matrix3d::Identity(), -hat(p_c);
        const Eigen::Vector3d bearing = p_c.normalized();
        J = (J - bearing * (bearing.transpose() * J)).eval() / p_c.norm();
        sum += J.transpose() * J;
    }
    return sum;
}

/// Processor time of one query [us]: the shortest mean over several passes.
template <typename Query>
double microseconds(const std::vector<Pose>& poses, int passes, const Query& query) {
    double least = kInfinity;
    for (int pass = 0; pass < passes; ++pass) {
        const double begun = threadTime();
        for (const Pose& pose : poses) query(pose);
        least = std::min(least, 1e3 * (threadTime() - begun) / static_cast<double>(poses.size()));
    }
    return least;
}

void printQueries(const Setup& setup, const std::vector<std::unique_ptr<FifField>>& fields,
                  const std::vector<Pose>& poses) {
    fmt::print("\n{:<24}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "us a query", "6x6", "trace",
               "log det", "kB an entry", "entries", "MB");
    double sink = 0.;
    const double before = heapMegabytes();
    InformationField field(setup.world.sharedViews(), setup.camera, setup.ours, setup.T_b_c,
                           setup.config.field);
    const auto ask = [&](const Pose& T_w_b) { sink += field.at(T_w_b).information(0, 0); };
    const double cold = microseconds(poses, 1, ask);
    const double megabytes = heapMegabytes() - before;
    const double cached = microseconds(poses, 20, ask);
    const auto entries = static_cast<double>(field.size());
    fmt::print("{:<24}{:>12.2f}\n", "ours, a new view", cold);
    fmt::print("{:<24}{:>12.2f}{:>12}{:>12}{:>12.2f}{:>12}{:>12.2f}\n", "ours, cached", cached, "",
               "", 1024. * megabytes / entries, field.size(), megabytes);
    for (const auto& fif : fields) {
        const auto time = [&](const auto& query) {
            return microseconds(poses, 5, [&](const Pose& T_w_b) {
                sink += query((T_w_b * setup.T_b_c).inverse());
            });
        };
        const double matrix = time([&](const Pose& T) { return fif->information(T)(0, 0); });
        const double trace = time([&](const Pose& T) { return fif->trace(T); });
        const double logDet = time([&](const Pose& T) { return fif->logDet(T); });
        const double kilobytes = static_cast<double>(fif->factorBytes()) / 1024.;
        const auto text = [&](double t) {
            return fif->hasMatrix() ? fmt::format("{:.2f}", t) : std::string("-");
        };
        fmt::print("{:<24}{:>12}{:>12.2f}{:>12}{:>12.2f}{:>12}{:>12.2f}   built in {:.1f} s\n",
                   fif->name(), text(matrix), trace, text(logDet), kilobytes, fif->voxels(),
                   kilobytes * static_cast<double>(fif->voxels()) / 1024., fif->buildSeconds());
    }
    if (sink == 1.) fmt::print(" ");  // so that no query is left out
}

/// Ours, the corners and landmarks of the view, and the fields at all headings of the positions.
struct Informations {
    HeadingInformation ours, corners, landmarks;
    std::vector<HeadingInformation> fif;
};

Informations informationsOf(const Setup& setup,
                            const std::vector<std::unique_ptr<FifField>>& fields,
                            const std::vector<Landmark>& landmarks,
                            const std::vector<Eigen::Vector3d>& positions) {
    Informations all;
    all.fif.resize(fields.size());
    View view;
    for (const Eigen::Vector3d& p_w : positions) {
        AtPosition ours, corners, seen;
        std::vector<AtPosition> fif(fields.size());
        for (int k = 0; k < kHeadings; ++k) {
            const Pose T_c_w = setup.cameraPose(p_w, headingOf(k));
            setup.world.views().render(setup.camera, T_c_w, view);
            ours[k] = setup.ours(view);
            corners[k] = setup.corners(view);
            seen[k] = landmarkInformation(landmarks, view, setup.camera, T_c_w);
            for (std::size_t i = 0; i < fields.size(); ++i) {
                fif[i][k] = fields[i]->information(T_c_w);
            }
        }
        all.ours.push_back(ours);
        all.corners.push_back(corners);
        all.landmarks.push_back(seen);
        for (std::size_t i = 0; i < fields.size(); ++i) all.fif[i].push_back(fif[i]);
    }
    return all;
}

/// The factor by which FIF's information has the median trace of ours.
double scaleOf(const Setup& setup, const HeadingInformation& ours, const HeadingInformation& fif) {
    const double trace = medianTrace(fif);
    if (trace > 0.) return medianTrace(ours) / trace;
    throw InputError(setup.config.file, "scene.file", "most views have no landmark for FIF");
}

HeadingInformation scaled(HeadingInformation informations, double factor) {
    for (AtPosition& at : informations) {
        for (Matrix6& information : at) information *= factor;
    }
    return informations;
}

/// Scores of FIF's own queries.
HeadingScores scoresOf(const Setup& setup, const std::vector<Eigen::Vector3d>& positions,
                       const std::function<double(const Pose& T_c_w)>& query) {
    HeadingScores scores;
    for (const Eigen::Vector3d& p_w : positions) {
        auto& at = scores.emplace_back();
        for (int k = 0; k < kHeadings; ++k) at[k] = query(setup.cameraPose(p_w, headingOf(k)));
    }
    return scores;
}

/// @param scales factors on the information of the fields
void printHeadings(const Setup& setup, const std::vector<std::unique_ptr<FifField>>& fields,
                   const std::vector<Eigen::Vector3d>& positions, const Informations& all,
                   const std::vector<double>& scales, const Matrix6& prior) {
    for (const Criterion& criterion : criteriaOf(prior)) {
        const HeadingScores ours = scoresOf(all.ours, criterion);
        printAgreementHeading(criterion);
        printAgreement("random heading", ours, randomScores(positions.size()), criterion);
        printAgreement("corners of the view", ours, scoresOf(all.corners, criterion), criterion);
        printAgreement("landmarks of the view", ours, scoresOf(all.landmarks, criterion),
                       criterion);
        for (std::size_t i = 0; i < fields.size(); ++i) {
            if (!fields[i]->hasMatrix()) continue;
            printAgreement(fields[i]->name(), ours,
                           scoresOf(scaled(all.fif[i], scales[i]), criterion), criterion);
            if (criterion.name == "trace") {
                const auto own = [&](const Pose& T) { return fields[i]->trace(T); };
                printAgreement(fields[i]->name() + ", its own trace", ours,
                               scoresOf(setup, positions, own), criterion);
            }
        }
    }
}

/// A plan by our planner on the information of a formula; its path is evaluated by our beliefs.
PlanOutcome planOn(const Setup& setup, const InformationFormula& formula, std::uint32_t seed) {
    Config config = setup.config;
    config.seed = seed;
    PlanningProblem problem(config, setup.world);
    BeliefOptions belief = config.belief;
    belief.kappa = problem.kappa();
    const auto field = std::make_shared<InformationField>(formula, setup.T_b_c, config.field);
    const auto model = std::make_shared<BeliefModel>(problem.space(), field, belief);
    GrowthOptions growth = config.growth;  // as of a planner of the problem
    growth.seed = seed;
    growth.obstacleReach = config.robotRadius;
    growth.maxVertices = config.vertices;
    growth.maxIterations = 200 * static_cast<std::size_t>(config.vertices);
    const auto planner =
        makePlanner(config.planner, problem.spaceInformation(), model, config.search, growth);
    planner->setProblemDefinition(problem.definition());
    planner->setup();
    return problem.solve(planner);
}

/// Mean and standard deviation over the seeds that found a path.
void printPlans(const std::string& name, const std::vector<PlanOutcome>& outcomes) {
    const auto text = [&](const std::function<double(const PlanOutcome&)>& value, int decimals) {
        double sum = 0., squares = 0., n = 0.;
        for (const PlanOutcome& outcome : outcomes) {
            if (!outcome.isSolved()) continue;
            const double x = value(outcome);
            sum += x, squares += x * x, ++n;
        }
        const double variance = n > 1. ? (squares - sum * sum / n) / (n - 1.) : 0.;
        return fmt::format("{:.{}f} ± {:.{}f}", sum / n, decimals,
                           std::sqrt(std::max(0., variance)), decimals);
    };
    const auto solved =
        std::count_if(outcomes.begin(), outcomes.end(),
                      [](const PlanOutcome& outcome) { return outcome.isSolved(); });
    fmt::print("{:<32}{:>8}{:>18}{:>18}{:>20}{:>20}{:>16}{:>16}\n", name, solved,
               text([](const auto& o) { return o.path->cost; }, 3),
               text([](const auto& o) { return o.path->length; }, 2),
               text([](const auto& o) { return 1e3 * o.path->meanTrace; }, 3),
               text([](const auto& o) { return 1e3 * o.path->goalTrace; }, 3),
               text([](const auto& o) { return static_cast<double>(o.views); }, 0),
               text([](const auto& o) { return o.planSeconds; }, 1));
}

void printPlans(const Setup& setup, const std::vector<std::unique_ptr<FifField>>& fields,
                const std::vector<double>& scales, std::uint32_t seeds) {
    fmt::print("\n{:<32}{:>8}{:>18}{:>18}{:>20}{:>20}{:>16}{:>16}\n", "plans on", "paths", "J [m]",
               "length [m]", "mean trace [1e-3 m2]", "goal trace", "evaluations", "seconds");
    const auto run = [&](const std::string& name, const auto& plan) {
        std::vector<PlanOutcome> outcomes;
        for (std::uint32_t seed = 1; seed <= seeds; ++seed) outcomes.push_back(plan(seed));
        printPlans(name, outcomes);
    };
    for (const char* model : {"photometric", "feature_reprojection", "none"}) {
        run(std::string("ours, ") + model, [&](std::uint32_t seed) {
            return runMethod(setup.config, setup.world, {setup.config.planner, model}, seed,
                             kNotInterrupted)
                .outcome;
        });
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (!fields[i]->hasMatrix()) continue;
        const double pixel = setup.camera.fx() * setup.camera.fy();
        for (const auto& [suffix, scale] :
             {std::pair{"", scales[i]}, std::pair{", corners of 1 px", pixel}}) {
            run(fields[i]->name() + suffix, [&, factor = scale](std::uint32_t seed) {
                return planOn(
                    setup,
                    [&](const Pose& T_c_w) -> Matrix6 {
                        return factor * fields[i]->information(T_c_w);
                    },
                    seed);
            });
        }
    }
}

void compareWithFif(const std::string& file, std::size_t count, std::uint32_t seeds,
                    const std::string& gaussianProcess) {
    const Setup setup(file);
    const std::vector<Landmark> landmarks = landmarksOf(setup);
    FifOptions options;
    options.bounds = setup.config.bounds;
    options.voxel = setup.config.field.positionPitch;
    fmt::print("{}: {} landmarks, voxels of {} m, GP {}\n", file, landmarks.size(), options.voxel,
               gaussianProcess);
    const double begun = processSeconds();
    const auto fields = makeFifFields(
        options, PHOTONAV_FIF_DIR "/act_map/params/fov_approximator_gp/" + gaussianProcess,
        setup.world.views(), landmarks);
    double depthSeconds = processSeconds() - begun;
    for (const auto& field : fields) depthSeconds -= field->buildSeconds();
    fmt::print("depth of all voxels: {:.1f} s\n", depthSeconds);
    const auto positions = freePositions(setup, count, 1);
    printQueries(setup, fields, randomPoses(freePositions(setup, kQueries, 21), 22));

    Informations all = informationsOf(setup, fields, landmarks, positions);
    std::vector<double> scales;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        scales.push_back(fields[i]->hasMatrix() ? scaleOf(setup, all.ours, all.fif[i]) : 0.);
        if (!fields[i]->hasMatrix()) continue;
        fmt::print(
            "{}: its information times {:.0f} has the median trace of ours; corners of 1 px "
            "would be {:.0f}\n",
            fields[i]->name(), scales[i], setup.camera.fx() * setup.camera.fy());
    }
    all.landmarks = scaled(all.landmarks, scaleOf(setup, all.ours, all.landmarks));
    const Matrix6 prior = PlanningProblem(setup.config, setup.world).initialCovariance();
    printHeadings(setup, fields, positions, all, scales, prior);
    if (seeds > 0) printPlans(setup, fields, scales, seeds);
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv,
                                   "fif_bench [CONFIG] [POSITIONS=200] [SEEDS=3] [GP_FOLDER]");
    try {
        compareWithFif(arguments.text(1, PHOTONAV_SOURCE_DIR "/config/room.yaml"),
                       arguments.number(2, std::size_t(200)), arguments.number(3, 3U),
                       arguments.text(4, kGaussianProcess));
        return 0;
    } catch (const InputError& error) {
        fmt::print(stderr, "fif_bench: {}\n", error.what());
        return 2;
    }
}
