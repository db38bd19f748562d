#include <iostream>
#include <photonav/belief_planner.hpp>
#include <photonav/uncertain_pose.hpp>

int main() {
    photonav::UncertainPose belief;
    belief.covariance.setIdentity();
    const auto moved = photonav::compound(belief, belief, photonav::PropagationOrder::second);
    std::cout << "trace after a step: " << moved.covariance.trace() << '\n';
    return moved.covariance.trace() == 12. ? 0 : 1;
}
