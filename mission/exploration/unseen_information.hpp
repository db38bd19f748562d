// SPDX-License-Identifier: BSD-3-Clause
// Information that is expected of what the map does not show yet.
#pragma once

#include <memory>

#include "belief/view_models.hpp"

namespace photonav {

/// Information expected behind the edge of the map: that of the last views flown through, on
/// average. The paper counts unknown space as without information, and names its prediction as
/// future work.
class UnseenInformation {
  public:
    /// A view of the map from a pose that was flown through, if it shows enough of the map.
    /// @param information of the pixels with a surface, camera frame
    void observe(const View& shown, const Matrix6& information);

    /// A model whose information of a view has that of its pixels without a surface added, as it
    /// is expected when the view is asked for. May be used as long as any of its copies is.
    InformationModel complete(InformationModel model) const;

    /// Of a view that shows only surfaces, camera frame; zero before anything was observed.
    const Matrix6& expected() const { return *expected_; }

  private:
    std::shared_ptr<Matrix6> expected_ = std::make_shared<Matrix6>(Matrix6::Zero());
    int views_ = 0;
};

}  // namespace photonav
