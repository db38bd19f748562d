// SPDX-License-Identifier: BSD-3-Clause
// The information expected of surfaces that are not in the map yet.
#pragma once

#include <array>
#include <memory>

#include "belief/view_models.hpp"

namespace photonav {

/// Predicts the information of unknown space from what the flight has seen. In the paper, unknown
/// space has no information; its prediction is named as future work.
///
/// The rows of an image are divided into bands. As the robot is level and the camera's tilt is
/// fixed, a band shows the scene at some angle to the horizon: the floor, the feet of walls, walls
/// at the height of flight. A pixel without a surface is expected to inform as the pixels of its
/// band do that show one: those of the same view, which are in its neighbourhood, and the average
/// of about the last 20 views of the flight.
class UnseenInformation {
  public:
    static constexpr unsigned kBands = 4;

    /// Adds a view of the map from a pose of the flight. Bands in which less than half of the
    /// pixels show a surface are ignored.
    /// @param model information of a view, from its pixels with a surface, camera frame
    void observe(const View& shown, const InformationModel& model);

    /// A model that adds the expected information for the pixels of a view without a surface. The
    /// average of the flight is the one at the time at which the model is evaluated. The model may
    /// outlive this object.
    InformationModel complete(InformationModel model) const;

    /// Average information of a pixel of a band, camera frame; zero before the first observation.
    const Matrix6& average(unsigned band) const { return (*averages_)[band].perPixel; }

  private:
    struct Average {
        Matrix6 perPixel = Matrix6::Zero();
        int views = 0;
    };
    using Averages = std::array<Average, kBands>;

    std::shared_ptr<Averages> averages_ = std::make_shared<Averages>();
};

}  // namespace photonav
