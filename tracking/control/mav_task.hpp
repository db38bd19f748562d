// SPDX-License-Identifier: BSD-3-Clause
// ViSP's servo task for a body that moves in x, y, z and yaw. Included by .cpp files only.
#pragma once

#include <visp3/vs/vpServo.h>

#include "control/body_velocity.hpp"
#include "geometry/visp_bridge.hpp"

namespace photonav {

/// Rows: twist of the body (v, omega) in its own axes; columns: the four velocities of a MAV.
inline vpMatrix mavJacobian() {
    vpMatrix eJe(6, 4);
    for (unsigned i = 0; i < 3; ++i) eJe[i][i] = 1.;
    eJe[5][3] = 1.;
    return eJe;
}

/// The camera rides on the body ("end effector"), which takes velocities in its own frame.
inline void setUpMavTask(vpServo& task, const Pose& T_b_c, double gain) {
    task.setServo(vpServo::EYEINHAND_L_cVe_eJe);
    task.set_cVe(toVisp(Pose(T_b_c.inverse())));
    task.set_eJe(mavJacobian());
    task.setLambda(gain);
}

inline BodyVelocity bodyVelocityFrom(const vpColVector& v) { return {{v[0], v[1], v[2]}, v[3]}; }

}  // namespace photonav
