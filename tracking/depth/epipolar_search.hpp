// SPDX-License-Identifier: BSD-3-Clause
// The search for a pixel's match along its epipolar line in another image.
#pragma once

#include <array>
#include <vector>

#include "geometry/camera.hpp"

namespace photonav {

struct EpipolarMatch {
    enum class Outcome {
        found,
        different,  ///< no patch on the line correlates
        undecided,  ///< no texture along the line, several candidates, the line is too long, or out
                    ///< of the image
    };
    Outcome outcome = Outcome::undecided;
    double w = 0.;      ///< inverse depth in the reference camera [1/m]
    double sigma = 0.;  ///< standard deviation of w [1/m]
};

struct EpipolarOptions {
    double sigma, matchSigma, minScore;  ///< see DepthFilterOptions
    int maxSteps;
};

/// Searches an image for pixels of a reference image. Patches are 9 x 9 samples along and across
/// the epipolar lines of the two images, which compensates the rotation of the camera, at a spacing
/// that compensates the distance. They are compared by normalised correlation, which gain and
/// offset do not change.
class EpipolarSearch {
  public:
    /// @param reference,image,camera must outlive the search
    /// @param T_c_r transforms from the reference camera to the camera of `image`
    EpipolarSearch(const ImageF& reference, const ImageF& image, const Camera& camera,
                   const Pose& T_c_r, const EpipolarOptions& options);

    /// Searches for the pixel (u, v) of the reference image.
    /// @param low,high interval of inverse depth that is searched [1/m], and one pixel beyond both
    ///        ends
    /// @param w expected inverse depth [1/m], for the scale of the patch
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
