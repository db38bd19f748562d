// SPDX-License-Identifier: BSD-3-Clause
#include "check/given_trajectory.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/camera.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "reason_of.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

class GivenTrajectoryTest : public testing::Test {
  protected:
    GivenTrajectory read(const std::string& text, const GivenHeading& heading = {}) const {
        return readGivenTrajectory(folder_.write("given.txt", text), Pose::Identity(), heading);
    }
    std::string reasonFor(const std::string& text) const {
        return test::reasonOf([&] { read(text); });
    }

    test::TemporaryFolder folder_;
};

TEST_F(GivenTrajectoryTest, CameraPosesBecomeBodyPoses) {
    const Pose T_b_c = cameraMount(45. * kDegree);
    const Pose T_w_b = levelPose({1., 2., 3.}, 0.7);
    const Eigen::Quaterniond q((T_w_b * T_b_c).linear());
    const std::string row = fmt::format("1 2 3 {} {} {} {}\n", q.x(), q.y(), q.z(), q.w());
    const std::string file =
        folder_.write("path.tum", "# timestamp tx ty tz\n5 " + row + "5.5 0 0 0 0 0 0 1\n");
    const GivenTrajectory trajectory = readGivenTrajectory(file, T_b_c);
    EXPECT_EQ(trajectory.format, TrajectoryFormat::tum);
    EXPECT_TRUE(trajectory.hasHeading);
    ASSERT_EQ(trajectory.poses.size(), 2U);
    EXPECT_EQ(trajectory.poses[0].time, 5.);
    EXPECT_TRUE(trajectory.poses[0].T_w_b.isApprox(T_w_b, 1e-9));
}

TEST_F(GivenTrajectoryTest, AFileOfBlankRowsHasNoPoses) {
    for (const char* text : {",", " ,\n", ",\n,\n", "\v"}) {
        EXPECT_NE(reasonFor(text).find("given.txt: no poses"), std::string::npos)
            << text << ": " << reasonFor(text);
    }
}

TEST_F(GivenTrajectoryTest, IsNotLongerThanAnyFlight) {
    EXPECT_NE(reasonFor("-9e4,0,0\n9e4,0,0\n").find("1.8e+05 m long; at most 100000 m"),
              std::string::npos)
        << reasonFor("-9e4,0,0\n9e4,0,0\n");
    EXPECT_EQ(lengthOf(read("0,0,0\n0,3,4\n0,3,5\n")), 6.);
}

TEST_F(GivenTrajectoryTest, TwelveNumbersAreThePoseOfACameraWithoutTime) {
    const GivenTrajectory trajectory = read("0 -1 0 1 1 0 0 2 0 0 1 3\n1 0 0 4 0 1 0 5 0 0 1 6\n");
    EXPECT_EQ(trajectory.format, TrajectoryFormat::kitti);
    ASSERT_EQ(trajectory.poses.size(), 2U);
    EXPECT_FALSE(trajectory.poses[0].time);
    EXPECT_EQ(trajectory.poses[0].T_w_b.translation(), Eigen::Vector3d(1., 2., 3.));
    EXPECT_NEAR(yawOf(trajectory.poses[0].T_w_b), EIGEN_PI / 2., 1e-12);
    // Twelve names are those of a table.
    EXPECT_EQ(
        read("x y z a b c d e f g h i\n1 2 3 0 0 0 0 0 0 0 0 0\n2 2 3 0 0 0 0 0 0 0 0 0\n").format,
        TrajectoryFormat::table);
    EXPECT_NE(reasonFor("1 0 0 2e5 0 1 0 5 0 0 1 6\n1 0 0 4 0 1 0 5 0 0 1 6\n").find("pose 1"),
              std::string::npos);
}

TEST_F(GivenTrajectoryTest, TablesOfFiveColumnsHaveTimesAndHeadings) {
    const GivenTrajectory trajectory = read("0.5,1,2,3,0.25\n0.7,2,2,3,-0.5\n");
    ASSERT_EQ(trajectory.poses.size(), 2U);
    EXPECT_EQ(trajectory.format, TrajectoryFormat::table);
    EXPECT_EQ(trajectory.poses[1].time, 0.7);
    EXPECT_NEAR(yawOf(trajectory.poses[1].T_w_b), -0.5, 1e-12);
    EXPECT_EQ(trajectory.poses[1].T_w_b.translation(), Eigen::Vector3d(2., 2., 3.));
}

TEST_F(GivenTrajectoryTest, NamesOfColumnsGiveTheirOrder) {
    const GivenTrajectory trajectory =
        read("battery, yaw, z, y, x\n0.9, 1.5, 3, 2, 1\n0.8, 1.6, 3, 2, 2\n");
    EXPECT_EQ(trajectory.poses[0].T_w_b.translation(), Eigen::Vector3d(1., 2., 3.));
    EXPECT_NEAR(yawOf(trajectory.poses[1].T_w_b), 1.6, 1e-12);
    EXPECT_FALSE(trajectory.poses[0].time);
    EXPECT_EQ(read("t x y z\n0 1 2 3\n1 2 2 3\n").poses[1].time, 1.);
}

TEST_F(GivenTrajectoryTest, QuaternionsInACsvAreOfTheCamera) {
    const Pose T_b_c = cameraMount(45. * kDegree);
    const Pose T_w_c = levelPose({1., 2., 3.}, 0.7) * T_b_c;
    const Eigen::Quaterniond q(T_w_c.linear());
    const std::string tum =
        fmt::format("timestamp,tx,ty,tz,qx,qy,qz,qw\n5,1,2,3,{},{},{},{}\n5.5,0,0,0,0,0,0,1\n",
                    q.x(), q.y(), q.z(), q.w());
    const std::string euroc = fmt::format(
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
        "q_RS_z [], v_RS_R_x [m s^-1]\n1403636580838555648,1,2,3,{},{},{},{},0.1\n"
        "1403636581338555648,0,0,0,1,0,0,0,0.1\n",
        q.w(), q.x(), q.y(), q.z());
    const std::string small =
        "t [ns],px,py,pz,qw,qx,qy,qz\n5000000000,1,2,3,1,0,0,0\n5500000000,0,0,0,1,0,0,0\n";
    for (const std::string& text : {tum, euroc, small}) {
        const auto trajectory = readGivenTrajectory(folder_.write("poses.csv", text), T_b_c);
        EXPECT_EQ(trajectory.format, TrajectoryFormat::csv);
        EXPECT_TRUE(trajectory.hasHeading);
        ASSERT_EQ(trajectory.poses.size(), 2U);
        EXPECT_NEAR(*trajectory.poses[1].time - *trajectory.poses[0].time, 0.5, 1e-6);
        const Pose T_w_b = trajectory.poses[0].T_w_b;
        EXPECT_NEAR((T_w_b * T_b_c).translation().norm(), std::sqrt(14.), 1e-9);
        EXPECT_TRUE(text == small || (T_w_b * T_b_c).isApprox(T_w_c, 1e-9)) << text;
    }
}

TEST_F(GivenTrajectoryTest, ACsvWithQuaternionsNamesItsColumns) {
    EXPECT_NE(reasonFor("1,0,0,0,0,0,0,1\n2,1,0,0,0,0,0,1\n")
                  .find("line 1: 8 columns; expected x,y,z, t,x,y,z,yaw or a first line with their "
                        "names, such as t,tx,ty,tz,qx,qy,qz,qw"),
              std::string::npos);
    EXPECT_NE(reasonFor("x,y,z,qx,qy,qz\n1,0,0,0,0,0\n").find("must include qx, qy, qz and qw"),
              std::string::npos);
    EXPECT_NE(reasonFor("x,y,z,qx,qy,qz,qw\n1,0,0,0,0,0,2\n").find("line 2: quaternion of norm 2"),
              std::string::npos);
    EXPECT_EQ(read("# recorded in x, y, z\n1,2,3\n2,2,3\n").poses[0].T_w_b.translation(),
              Eigen::Vector3d(1., 2., 3.));  // prose
}

TEST_F(GivenTrajectoryTest, ABinaryFileIsNoText) {
    EXPECT_NE(reasonFor(std::string("PK\0\1 a b\n", 9)).find("given.txt: binary or UTF-16"),
              std::string::npos);
}

TEST_F(GivenTrajectoryTest, WithoutHeadingsTheRobotLooksWhereItFlies) {
    const std::string waypoints = "0 0 1\n0 2 1\n0 2 3\n-1 2 3\n";
    const GivenTrajectory forward = read(waypoints);
    EXPECT_FALSE(forward.hasHeading);
    const double up = 0.5 * M_PI;  // vertical motions keep the heading before
    const std::vector<double> expected{up, up, M_PI, M_PI};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(yawOf(forward.poses[i].T_w_b), expected[i], 1e-12) << i;
    }
    for (const GivenPose& pose : read(waypoints, 0.3).poses) {
        EXPECT_NEAR(yawOf(pose.T_w_b), 0.3, 1e-12);
    }
}

TEST_F(GivenTrajectoryTest, MayBeginWithAByteOrderMark) {
    const std::string mark = "\xEF\xBB\xBF";
    for (const char* rows : {"0 1 2 3 0\n1 2 2 3 0\n", "x,y,z\n1,2,3\n2,2,3\n",
                             "1 1 2 3 0 0 0 1\n2 2 2 3 0 0 0 1\n"}) {
        const GivenTrajectory with = read(mark + rows), without = read(rows);
        EXPECT_EQ(with.format, without.format);
        ASSERT_EQ(with.poses.size(), without.poses.size());
        EXPECT_TRUE(with.poses[0].T_w_b.isApprox(without.poses[0].T_w_b, 0.));
    }
}

TEST_F(GivenTrajectoryTest, BadRowsAreNamed) {
    EXPECT_NE(reasonFor("0,1,2,3\n1,1,2,4\n").find("line 1: four columns"), std::string::npos);
    EXPECT_NE(reasonFor("0,1,2,3,0\n-1,1,2,4,0\n").find("line 2: time -1 after 0"),
              std::string::npos);
    EXPECT_NE(reasonFor("0 0 0\n0 nan 0\n").find("line 2: 'nan' is not a finite number"),
              std::string::npos);
    EXPECT_NE(reasonFor("0 0 0\n0 0\n").find("line 2: expected 3 fields, found 2"),
              std::string::npos);
    EXPECT_NE(reasonFor("0 0 0\n0 1e7 0\n").find("line 2: farther than 100000 m"),
              std::string::npos);
    EXPECT_NE(reasonFor("x,y,yaw\n0,0,0\n").find("must include x, y and z"), std::string::npos);
    EXPECT_NE(reasonFor("x,y,z,X\n0,0,0,1\n").find("two columns 'X'"), std::string::npos);
    EXPECT_NE(reasonFor("1 2\n3 4\n").find("2 columns"), std::string::npos);
    EXPECT_NE(reasonFor("0 0 0 0 0 0 0 2\n1 0 0 0 0 0 0 1\n").find("quaternion of norm 2"),
              std::string::npos);
    EXPECT_NE(reasonFor("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n").find("line 2"), std::string::npos);
}

TEST_F(GivenTrajectoryTest, OnePlaceIsNoTrajectory) {
    EXPECT_NE(reasonFor("").find("no poses"), std::string::npos);
    EXPECT_NE(reasonFor("# x y z\n").find("no poses"), std::string::npos);
    EXPECT_NE(reasonFor("x,y,z\n").find("0 pose"), std::string::npos);
    EXPECT_NE(reasonFor("0 0 1\n").find("at least two"), std::string::npos);
    EXPECT_NE(reasonFor("0 0 1\n0 0 1\n").find("all poses are the same"), std::string::npos);
    EXPECT_NE(reasonFor("0 0 1\n1e-9 0 1\n").find("all poses are the same"), std::string::npos);
    EXPECT_NE(reasonFor("0 0 0 1 1e308\n1 1 1 1 0\n").find("a heading beyond 1000 rad"),
              std::string::npos);
    EXPECT_NE(test::reasonOf([] {
                  readGivenTrajectory("/no/such", Pose::Identity());
              }).find("no such file"),
              std::string::npos);
}

}  // namespace
}  // namespace photonav
