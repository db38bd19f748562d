// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/monocular_fusion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace photonav {
namespace {

MonocularOptions optionsFor(const FusionOptions& fusion) {
    MonocularOptions options;
    options.filter.minDepth = fusion.minRange;
    return options;
}

}  // namespace

MonocularFusion::MonocularFusion(ExposedFusion& fusion, const Camera& camera,
                                 const FusionOptions& options,
                                 std::function<void(const Reference&)> onReference)
    : fusion_(fusion),
      options_(options),
      onReference_(std::move(onReference)),
      depth_(camera, optionsFor(options)) {
    options_.isStopped = {};  // the last reference is fused after the end
}

void MonocularFusion::add(const RecordedFrame& frame) {
    const auto finished = depth_.add(frame.view.intensity, frame.T_c_w);
    if (finished) fuseReference(*finished);
    if (!depth_.isAtReference()) return;
    recorded_ = frame.view.depth;
    timestamp_ = frame.timestamp;
}

void MonocularFusion::finish() {
    if (const auto last = depth_.finish()) fuseReference(*last);
}

void MonocularFusion::fuseReference(const DepthFilter& filter) {
    const View view = filter.view();
    count(filter, view.depth);
    if (onReference_) onReference_({filter, recorded_, timestamp_});
    ++references_;
    fusion_.add(view, filter.pose(), options_);
}

void MonocularFusion::count(const DepthFilter& filter, const ImageF& found) {
    for (unsigned v = 0; v < found.getHeight(); ++v) {
        for (unsigned u = 0; u < found.getWidth(); ++u) {
            ++states_[static_cast<std::size_t>(filter.state(v, u))];
            const float z = recorded_[v][u];
            if (!(z > 0.F)) continue;
            ++pixels_;
            if (found[v][u] > 0.F) errors_.push_back(std::abs(found[v][u] - z) / z);
        }
    }
}

nlohmann::json MonocularFusion::result() const {
    const auto shareOf = [&, all = states_[0] + states_[1] + states_[2]](DepthState state) {
        const auto n = static_cast<double>(states_[static_cast<std::size_t>(state)]);
        return all > 0 ? nlohmann::json(n / static_cast<double>(all)) : nlohmann::json(nullptr);
    };
    nlohmann::json result = {{"references", references_},
                             {"references_given_up", depth_.givenUp()},
                             {"converged", shareOf(DepthState::converged)},
                             {"given_up", shareOf(DepthState::givenUp)},
                             {"searching", shareOf(DepthState::searching)},
                             {"completeness", nullptr},
                             {"median_relative_error", nullptr},
                             {"p90_relative_error", nullptr},
                             {"share_above_10_percent", nullptr}};
    const auto count = static_cast<double>(errors_.size());
    if (pixels_ > 0) result["completeness"] = count / static_cast<double>(pixels_);
    if (errors_.empty()) return result;
    std::vector<float> sorted = errors_;
    std::sort(sorted.begin(), sorted.end());
    const auto quantile = [&](double q) { return sorted[std::size_t(q * (count - 1.))]; };
    result["median_relative_error"] = quantile(0.5);
    result["p90_relative_error"] = quantile(0.9);
    const auto wild = sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), 0.1F);
    result["share_above_10_percent"] = static_cast<double>(wild) / count;
    return result;
}

}  // namespace photonav
