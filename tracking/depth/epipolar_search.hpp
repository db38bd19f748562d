// SPDX-License-Identifier: BSD-3-Clause
// Where along its epipolar line a pixel's surroundings appear in another image.
#pragma once

#include <array>
#include <vector>

#include "geometry/camera.hpp"

namespace photonav {

struct EpipolarMatch {
    enum class Outcome {
        found,
        different,  ///< no patch on the line correlates
        undecided,  ///< no texture along the line, several candidates, too long, out of the image
    };
    Outcome outcome = Outcome::undecided;
    double w = 0.;      ///< inverse depth in the reference camera [1/m]
    double sigma = 0.;  ///< its standard deviation
};

struct EpipolarOptions {
    double sigma, matchSigma, minScore;  ///< see DepthFilterOptions
    int maxSteps;
};

/// Searches one image for pixels of another. Patches are 9 x 9 samples along and across the
/// epipolar lines of the two images, which compensates the rotation of the camera, at a spacing
/// that compensates the distance. They are compared by normalised correlation: gain and offset do
/// not matter.
class EpipolarSearch {
  public:
    /// @param reference, image must outlive the search
    EpipolarSearch(const ImageF& reference, const ImageF& image, const Camera& camera,
                   const Pose& T_c_r, const EpipolarOptions& options);

    /// @param w expected inverse depth of the reference's pixel (u, v), for the scale of its patch
    /// @param low, high where to search; both ends are searched one pixel beyond
    EpipolarMatch operator()(unsigned u, unsigned v, double low, double w, double high);

  private:
    static constexpr int kRadius = 4;
    static constexpr int kSide = 2 * kRadius + 1;
    struct Line;
    bool sampleReference(unsigned u, unsigned v, const Eigen::Vector2d& along);
    void sampleStrip(const Line& line);
    int bestStep(int steps, float& score);

    const ImageF& reference_;
    const ImageF& image_;
    const Camera& camera_;
    Pose T_c_r_;
    Eigen::Vector3d t_r_;  ///< centre of the other camera in the reference's frame
    EpipolarOptions options_;
    std::array<float, kSide* kSide> patch_ = {};  ///< zero mean, unit length
    float gradient_ = 0.F;               ///< sum of squared derivatives along the line before that
    std::vector<float> scores_;          ///< of every step
    std::vector<float> sums_, squares_;  ///< of every column of the strip
    std::array<std::vector<float>, kSide> strip_;
};

}  // namespace photonav
