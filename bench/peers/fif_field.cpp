// SPDX-License-Identifier: BSD-3-Clause
#include "fif_field.hpp"

#include <act_map/act_map.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "../thread_time.hpp"
#include "geometry/camera.hpp"
#include "geometry/se3.hpp"

namespace photonav::peers {

struct FifField::Block {
    act_map::voxblox::BlockIndex index;
    const act_map::Vec3dVec& landmarks;
    const act_map::Vec3dVec& viewDirections;
    const act_map::VisibilityCheckerPtr& checker;
};

namespace {

constexpr double kDegree = std::numbers::pi / 180.;

rpg::Pose toFif(const Pose& T_c_w) {
    const Pose T_w_c = T_c_w.inverse();
    return rpg::Pose(rpg::Rotation(Eigen::Quaterniond(T_w_c.linear()).normalized()),
                     T_w_c.translation());
}

/// FIF's information is about eps of T_w_c = exp(eps^) mean, in world axes about the world's
/// origin: xi of T_c_w = exp(xi^) mean is -Ad(T_c_w) eps.
Matrix6 aboutCamera(const Matrix6& information, const Pose& T_c_w) {
    const Matrix6 toWorld = adjoint(T_c_w.inverse());
    const Matrix6 camera = toWorld.transpose() * information * toWorld;
    return 0.5 * (camera + camera.transpose());
}

template <typename Voxel>
class FieldOf final : public FifField {
  public:
    FieldOf(std::string name, const FifOptions& options)
        : name_(std::move(name)),
          layer_(std::make_shared<act_map::voxblox::Layer<Voxel>>(options.voxel,
                                                                  options.voxelsPerSide)),
          evaluator_(layer_.get()) {}

    std::string name() const override { return name_; }
    bool hasMatrix() const override { return kIsInformation; }
    double trace(const Pose& T_c_w) const override {
        return metric(T_c_w, act_map::InfoMetricType::kTrace);
    }
    double logDet(const Pose& T_c_w) const override {
        return kIsInformation ? metric(T_c_w, act_map::InfoMetricType::kDet) : 0.;
    }

    Matrix6 information(const Pose& T_c_w) const override {
        if constexpr (!kIsInformation) return Matrix6::Zero();
        typename Voxel::FactorType factor;
        if (!interpolate(T_c_w.inverse().translation(), factor)) return Matrix6::Zero();
        typename Voxel::OutMatType out;
        Voxel::queryAtRotation(T_c_w.linear().transpose(), factor, &out);
        if constexpr (kIsInformation) return aboutCamera(out, T_c_w);
    }

    std::size_t voxels() const override { return layer_->getNumberOfAllocatedVoxels(); }
    std::size_t factorBytes() const override {
        return Voxel().getFactorConstRef().size() * sizeof(double);
    }
    double buildSeconds() const override { return buildSeconds_; }

    void integrate(const Block& block) override {
        const double begun = processSeconds();
        layer_->allocateBlockPtrByIndex(block.index);
        act_map::PositionalFactorLayerIntegrator<Voxel> integrator(
            {}, std::make_shared<act_map::OccupancyLayer>(0.01, 16), layer_, block.checker);
        integrator.recomputeFactorLayer(block.landmarks, block.viewDirections,
                                        act_map::voxblox::BlockIndexList{block.index});
        buildSeconds_ += processSeconds() - begun;
    }

  private:
    static constexpr bool kIsInformation = Voxel::kNumOut == 6;

    double metric(const Pose& T_c_w, act_map::InfoMetricType type) const {
        double value = 0.;
        evaluator_.getValueInterpolation(toFif(T_c_w), type, &value);
        return value;
    }

    bool interpolate(const Eigen::Vector3d& p_w, typename Voxel::FactorType& factor) const {
        act_map::InterpVoxels<Voxel> voxels{};
        act_map::InterpVoxCenters centres;
        const auto found = act_map::getSurroundVoxels(*layer_, p_w, &voxels, &centres);
        if (found == act_map::QueryVoxelsRes::kNearest) factor = voxels[0]->getFactorConstRef();
        if (found != act_map::QueryVoxelsRes::kSurround) {
            return found == act_map::QueryVoxelsRes::kNearest;
        }
        act_map::InterpValues<typename Voxel::FactorType> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = &voxels[i]->getFactorConstRef();
        }
        act_map::trilinearInterpolation(p_w, centres.col(0), layer_->voxel_size(), values, &factor);
        return true;
    }

    std::string name_;
    typename act_map::voxblox::Layer<Voxel>::Ptr layer_;
    act_map::PosFactorLayerEvaluator<Voxel> evaluator_;
    double buildSeconds_ = 0.;
};

/// Sets the depth in all directions by the views on the six faces of a cube.
void setDepth(const ViewSource& views, const Eigen::Vector3d& p_w, act_map::DepthVoxel& voxel) {
    Camera camera = makeCamera(64, 64, std::numbers::pi / 2.);
    camera.hasPointSpread = false;
    View view;
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
        for (const double sign : {-1., 1.}) {
            Pose T_w_c = Pose::Identity();
            T_w_c.linear() =
                Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), sign * axis)
                    .toRotationMatrix();
            T_w_c.translation() = p_w;
            views.render(camera, T_w_c.inverse(), view);
            for (unsigned v = 0; v < camera.height; ++v) {
                for (unsigned u = 0; u < camera.width; ++u) {
                    if (!(view.depth[v][u] > 0.F)) continue;
                    const Eigen::Vector3d ray =
                        T_w_c.linear() * camera.unproject(u, v, view.depth[v][u]);
                    voxel.setDepthFromWorldVector(ray.cast<float>());
                }
            }
        }
    }
}

/// Keeps the depth of one block of voxels at a time: that of all does not fit into memory.
act_map::VisibilityCheckerPtr checkerOf(const FifOptions& options) {
    act_map::VisibilityCheckerOptions checker;
    checker.min_dist = options.leastDistance;
    checker.max_dist = options.largestDistance;
    checker.use_view_filtering = true;
    checker.min_view_angle_cos = std::cos(options.largestViewAngle * kDegree);
    act_map::DepthMapOptions depth;
    depth.depth_layer_opts_ = {options.voxel, static_cast<std::size_t>(options.voxelsPerSide)};
    depth.depth_voxel_step_deg_ = options.depthStep;
    return std::make_shared<act_map::VisibilityChecker>(checker,
                                                        std::make_shared<act_map::DepthMap>(depth));
}

void setDepthOfBlock(const ViewSource& views, const act_map::voxblox::BlockIndex& index,
                     const FifOptions& options, act_map::DepthMap& depth) {
    depth.reset();
    const double edge = options.voxel * options.voxelsPerSide;
    depth.allocateByPoints({edge * (index.cast<double>().array() + 0.5).matrix()});
    const auto block = depth.getDepthBlockPtr(index);
    for (std::size_t i = 0; i < block->num_voxels(); ++i) {
        setDepth(views, block->computeCoordinatesFromLinearIndex(i),
                 block->getVoxelByLinearIndex(i));
    }
}

/// The blocks of all voxels between which positions within the bounds are interpolated.
std::vector<act_map::voxblox::BlockIndex> blocksOf(const FifOptions& options) {
    const double edge = options.voxel * options.voxelsPerSide;
    const auto indexOf = [&](const Eigen::Vector3d& p) -> Eigen::Vector3i {
        return (p / edge).array().floor().cast<int>();
    };
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(0.51 * options.voxel);
    const Eigen::Vector3i first = indexOf(options.bounds.min() - margin);
    const Eigen::Vector3i last = indexOf(options.bounds.max() + margin);
    std::vector<act_map::voxblox::BlockIndex> blocks;
    for (int x = first.x(); x <= last.x(); ++x) {
        for (int y = first.y(); y <= last.y(); ++y) {
            for (int z = first.z(); z <= last.z(); ++z) blocks.emplace_back(x, y, z);
        }
    }
    return blocks;
}

}  // namespace

std::vector<std::unique_ptr<FifField>> makeFifFields(const FifOptions& options,
                                                     const std::string& gaussianProcess,
                                                     const ViewSource& views,
                                                     const std::vector<Landmark>& landmarks) {
    act_map::setQuadPolyVisiblity({});
    act_map::setGPVisiblityFromFolder(gaussianProcess);
    std::vector<std::unique_ptr<FifField>> fields;
    fields.push_back(std::make_unique<FieldOf<act_map::GPInfoVoxel>>("FIF, GP", options));
    fields.push_back(
        std::make_unique<FieldOf<act_map::QuadPolyInfoVoxel>>("FIF, quadratic", options));
    fields.push_back(
        std::make_unique<FieldOf<act_map::GPTraceVoxel>>("FIF, GP, trace only", options));

    act_map::Vec3dVec points, directions;
    for (const Landmark& landmark : landmarks) {
        points.push_back(landmark.position);
        directions.push_back(landmark.viewDirection);
    }
    const act_map::VisibilityCheckerPtr checker = checkerOf(options);
    for (const act_map::voxblox::BlockIndex& index : blocksOf(options)) {
        setDepthOfBlock(views, index, options, *checker->depthMapPtr());
        for (const auto& field : fields) field->integrate({index, points, directions, checker});
    }
    return fields;
}

}  // namespace photonav::peers
