// SPDX-License-Identifier: BSD-3-Clause
#include "replay/calibration_file.hpp"

#include <gtest/gtest.h>

#include "temporary_folder.hpp"
#include "tum_dataset.hpp"

namespace photonav::test {
namespace {

using Kind = std::optional<MapKind>;

const std::vector<Kind> kKinds{std::nullopt, MapKind::mesh, MapKind::cells, MapKind::surfaces};

class CalibrationFile : public testing::Test {
  protected:
    std::string written(const std::string& text) const {
        writeText(folder_.path() / "calibration.yaml", text);
        return (folder_.path() / "calibration.yaml").string();
    }

    TemporaryFolder folder_;
};

TEST_F(CalibrationFile, IsRefusedForEveryOtherKindOfMap) {
    const Calibration calibration{0.5, 0.01, 0.002};
    for (const Kind& of : kKinds) {
        const std::string file = written(toYaml(calibration, of));
        for (const Kind& wanted : kKinds) {
            if (of == wanted) {
                EXPECT_EQ(readCalibration(file, wanted).leastSigma, 0.01);
            } else {
                expectInputError([&] { readCalibration(file, wanted); },
                                 {"calibration.yaml: mode: is "});
            }
        }
    }
}

TEST_F(CalibrationFile, OfAnUnknownKindOfMapIsRefusedByAll) {
    const std::string numbers = "scale: 1\nleast_sigma: 0.01\nleast_sigma_rotation: 0\n";
    for (const Kind& wanted : kKinds) {
        EXPECT_NO_THROW(readCalibration(written(numbers), wanted));  // typed by hand
        expectInputError([&] { readCalibration(written(numbers + "mode: map\n"), wanted); },
                         {"calibration.yaml: mode: "});
    }
}

}  // namespace
}  // namespace photonav::test
