// A robot of one's own flies to a goal in a room that it does not know.
//! [robot]
#include <iostream>
#include <photonav/exploration/explorer.hpp>
#include <photonav/geometry/se3.hpp>
#include <photonav/render/mesh_renderer.hpp>

/// Moves exactly as commanded; a camera with depth takes four images a second.
class MyRobot : public photonav::Robot {
  public:
    MyRobot(photonav::Scene room, const photonav::Config& config)
        : room_(std::move(room)), camera_(config.camera.camera()), T_b_c_(config.camera.T_b_c()) {
        T_w_b_.translation() = config.start.position;
    }
    photonav::Observation fly(const photonav::BodyVelocity& command, double seconds) override {
        photonav::Vector6 motion = photonav::Vector6::Zero();
        motion.head<3>() = seconds * command.linear;
        motion[5] = seconds * command.yawRate;
        const photonav::Pose T_now_next = photonav::expSE3(motion);
        T_w_b_ = T_w_b_ * T_now_next;
        time_ += seconds;
        const photonav::Matrix6 noise = 1e-6 * photonav::Matrix6::Identity();
        photonav::Observation measured{
            time_, photonav::UncertainPose{T_now_next.inverse(), noise}, {}};
        if (time_ < nextImage_) return measured;
        nextImage_ += 0.25;
        photonav::CameraFrame& image = measured.frames.emplace_back();
        image.time = time_;
        room_.render(camera_, (T_w_b_ * T_b_c_).inverse(), image.view);
        return measured;
    }
    const photonav::Camera& camera() const override { return camera_; }
    const photonav::Pose& T_b_c() const override { return T_b_c_; }
    /// Its images are rendered; without this line they count as images of a real camera in focus.
    double blur() const override { return photonav::kRenderedBlur; }

  private:
    photonav::MeshRenderer room_;
    photonav::Camera camera_;
    photonav::Pose T_b_c_, T_w_b_ = photonav::Pose::Identity();
    double time_ = 0., nextImage_ = 0.;
};
//! [robot]

photonav::Scene room() {
    photonav::Scene scene;
    const auto texture = addTexture(scene, photonav::valueNoise({.size = {8., 4.}, .seed = 1}));
    addBox(scene, {0., 0., 0.}, {8., 4., 3.}, texture, photonav::BoxInside::hollow);
    addBox(scene, {2.5, 1.6, 0.}, {2.8, 2.2, 3.}, texture);
    return scene;
}

//! [main]
int main() {
    photonav::Config config;  // of the robot and its flight: the room is not in it
    config.bounds = {Eigen::Vector3d(0.4, 0.4, 0.8), Eigen::Vector3d(7.6, 3.6, 1.4)};
    config.start.position = {1., 2., 1.1};
    config.start.yaw = 0.;
    config.goal.position = {4., 2., 1.1};
    config.space = photonav::StateKind::positionYaw;
    config.robotRadius = 0.25;
    config.camera.mount = "front45";
    config.camera.width = 94;
    config.camera.height = 60;
    config.explore.range = 3.;
    config.explore.vertices = 100;
    MyRobot robot(room(), config);
    photonav::ExplorerOptions options = photonav::explorerOptions(config);
    options.timeStep = 0.05;
    options.pilot.route.responseTime = 0.;  // it follows commands at once
    const auto onUpdate = [](const photonav::ExplorationRecord& soFar) {
        const photonav::PlanUpdate& update = soFar.updates.back();
        std::cout << update.time << " s: " << update.length << " m to go\n";
    };
    const photonav::ExplorationOutcome flight = photonav::explore(
        robot, options, "rrt_star", 1, photonav::kNotInterrupted, {.update = onUpdate});
    std::cout << nameOf(flight.end) << " after " << flight.duration << " s " << flight.reason
              << '\n';
    return flight.end == photonav::FlightEnd::arrived ? 0 : 1;
}
//! [main]
