// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/trajectory.hpp"

#include <gtest/gtest.h>

#include <random>

#include "geometry/se3.hpp"
#include "tum_dataset.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;
using test::expectInputError;

TEST(Trajectory, SurvivesAFile) {
    const test::TemporaryFolder folder;
    const std::string file = (folder.path() / "trajectory.tum").string();
    std::srand(3);
    Trajectory written;
    for (int i = 0; i < 20; ++i) {
        Pose T = Pose::Identity();
        T.linear() = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
        T.translation().setRandom();
        written.push_back({1305031102.175304 + 0.033333 * i, T});
    }
    writeTrajectory(file, written);
    const Trajectory read = readTrajectory(file);
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_NEAR(read[i].timestamp, written[i].timestamp, 1e-6);
        EXPECT_TRUE(read[i].T_w_c.isApprox(written[i].T_w_c, 1e-8));
    }
}

TEST(Trajectory, OfKittiHasRowsOfTheMatrixAndNoTimes) {
    const test::TemporaryFolder folder;
    const std::string file =
        folder.write("00.txt", "0 -1 0 1  1 0 0 2  0 0 1 3\n\n1 0 0 4 0 1 0 5 0 0 1 6\n");
    const Trajectory read = readKittiTrajectory(file);
    ASSERT_EQ(read.size(), 2U);
    EXPECT_TRUE(read[0].T_w_c.isApprox(levelPose({1., 2., 3.}, EIGEN_PI / 2.), 1e-12));
    EXPECT_EQ(read[1].timestamp, 1.);
    const std::string copy = (folder.path() / "copy.txt").string();
    writeKittiTrajectory(copy, read);
    EXPECT_TRUE(readKittiTrajectory(copy)[0].T_w_c.isApprox(read[0].T_w_c, 1e-8));
    expectInputError([&] { readKittiTrajectory(folder.write("a", "2 0 0 4 0 2 0 5 0 0 2 6\n")); },
                     {"line 1", "no rotation"});
    expectInputError([&] { readKittiTrajectory(folder.write("b", "-1 0 0 4 0 1 0 5 0 0 1 6\n")); },
                     {"line 1", "no rotation"});
    expectInputError([&] { readKittiTrajectory(folder.write("c", "\n")); }, {"no poses"});
}

TEST(Trajectory, MayBeginWithAByteOrderMark) {
    const test::TemporaryFolder folder;
    const std::string text =
        "\xEF\xBB\xBF"
        "1 0 0 4 0 1 0 5 0 0 1 6\n";
    EXPECT_EQ(readKittiTrajectory(folder.write("a", text)).size(), 1U);
}

TEST(Trajectory, TimesThatCannotBeAreNamed) {
    const test::TemporaryFolder folder;
    for (const auto& [time, reason] :
         {std::pair("nan", "'nan' is not a finite number"), std::pair("-inf", "not a finite"),
          std::pair("1e308", "timestamp 1e+308 s is beyond 1e+10 s"),
          std::pair("-1e15", "timestamp -1e+15 s is beyond 1e+10 s")}) {
        const std::string file = folder.write(
            "trajectory.txt", "1 0 0 1 0 0 0 1\n" + std::string(time) + " 0 0 1 0 0 0 1\n");
        expectInputError([&] { readTrajectory(file); }, {"trajectory.txt", "line 2", reason});
    }
}

TEST(Trajectory, PosesAreInterpolatedAcrossShortGapsOnly) {
    const Trajectory trajectory = {{1., levelPose({0., 0., 0.}, 0.)},
                                   {1.1, levelPose({1., 2., 0.}, 0.4)},
                                   {2., levelPose({5., 5., 5.}, 1.)}};
    const auto between = poseAt(trajectory, 1.025, 0.02, 0.1 + 1e-9);
    ASSERT_TRUE(between);
    EXPECT_TRUE(between->isApprox(levelPose({0.25, 0.5, 0.}, 0.1), 1e-9));
    EXPECT_TRUE(poseAt(trajectory, 1.1, 0., 0.)->isApprox(trajectory[1].T_w_c));
    EXPECT_TRUE(poseAt(trajectory, 1.115, 0.02, 0.2)->isApprox(trajectory[1].T_w_c));
    EXPECT_TRUE(poseAt(trajectory, 1.985, 0.02, 0.2)->isApprox(trajectory[2].T_w_c));
    EXPECT_TRUE(poseAt(trajectory, 2.019, 0.02, 0.2)->isApprox(trajectory[2].T_w_c));
    EXPECT_TRUE(poseAt(trajectory, 0.981, 0.02, 0.2)->isApprox(trajectory[0].T_w_c));
    EXPECT_FALSE(poseAt(trajectory, 1.5, 0.02, 0.2));
    EXPECT_FALSE(poseAt(trajectory, 2.03, 0.02, 0.2));
    EXPECT_FALSE(poseAt({}, 1., 10., 10.));
}

TEST(Trajectory, EqualTimestampsAreNoDivisionByZero) {
    const Trajectory trajectory = {{1., levelPose({1., 0., 0.}, 0.)},
                                   {1., levelPose({2., 0., 0.}, 0.)}};
    EXPECT_TRUE(poseAt(trajectory, 1., 0.02, 0.1)->matrix().allFinite());
}

TEST(Trajectory, RejectsDamagedFilesByLine) {
    const test::TemporaryFolder folder;
    const std::string file = (folder.path() / "groundtruth.txt").string();
    const auto expectRejected = [&](const std::string& text, const std::string& line,
                                    const std::string& reason) {
        test::writeText(file, text);
        expectInputError([&] { readTrajectory(file); }, {file, line, reason});
    };
    const std::string good = "# comment\n\n1 0 0 0 0 0 0 1\n";
    expectRejected(good + "2 0 nan 0 0 0 0 1\n", "line 4", "not a finite number");
    expectRejected(good + "2 0 inf 0 0 0 0 1\n", "line 4", "not a finite number");
    expectRejected(good + "2 0 1e30 0 0 0 0 1\n", "line 4", "1e+30 m from the origin");
    expectRejected(good + "2 0 x 0 0 0 0 1\n", "line 4", "'x' is not a number");
    expectRejected(good + "2 0 1,5 0 0 0 0 1\n", "line 4", "'1,5' is not a number");
    expectRejected(good + "2 0 0 0 0 0 0 0\n", "line 4", "quaternion of norm 0");
    expectRejected(good + "2 0 0 0 0 0 3 1\n", "line 4", "norm 3.16");
    expectRejected(good + "2 0 0 0 0 0 1\n", "line 4", "expected 8 fields, found 7");
    expectRejected(good + "0.5 0 0 0 0 0 0 1\n", "line 4", "smaller than the one before");
    expectRejected("# nothing\n", "", "no poses");
    expectInputError([&] { readTrajectory(file + "x"); }, {"no such file"});
    expectInputError([&] { writeTrajectory("/nowhere/t.tum", {}); }, {"cannot be written"});
}

TEST(Trajectory, EveryAxisCanBeTurnedUp) {
    for (const std::string& name : axisNames()) {
        const Eigen::Matrix3d R = worldUpRotation(name);
        EXPECT_TRUE(R.isUnitary()) << name;
        EXPECT_NEAR(R.determinant(), 1., 1e-12) << name;
        const int axis = name.back() - 'x';
        const Vector3d up = (name.size() == 2 ? -1. : 1.) * Vector3d::Unit(axis);
        EXPECT_TRUE((R * up).isApprox(Vector3d::UnitZ())) << name;
    }
    // A world that is a camera's optical frame becomes x forward, y left, z up.
    EXPECT_TRUE((worldUpRotation("-y") * Vector3d::UnitZ()).isApprox(Vector3d::UnitX()));
    EXPECT_TRUE((worldUpRotation("y") * -Vector3d::UnitZ()).isApprox(Vector3d::UnitX()));
    EXPECT_THROW(worldUpRotation("up"), std::invalid_argument);
}

TEST(Trajectory, AnyDirectionCanBeTurnedUp) {
    for (const std::string& name : axisNames()) {
        const Eigen::Matrix3d R = worldUpRotation(name);
        EXPECT_TRUE(worldUpRotation(Vector3d(R.transpose() * Vector3d::UnitZ())).isApprox(R))
            << name;
    }
    const Vector3d up = Vector3d(0.1, -0.9, -0.35).normalized();
    const Eigen::Matrix3d R = worldUpRotation(up);
    EXPECT_TRUE(R.isUnitary());
    EXPECT_TRUE((R * up).isApprox(Vector3d::UnitZ()));
    // no more turned against the axis' own rotation than need be
    const Eigen::AngleAxisd rest(R * worldUpRotation("-y").transpose());
    EXPECT_NEAR(rest.angle(), std::acos(-up.y()), 1e-12);
}

}  // namespace
}  // namespace photonav
