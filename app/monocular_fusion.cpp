// SPDX-License-Identifier: BSD-3-Clause
#include "monocular_fusion.hpp"

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

MonocularOptions optionsFor(const FusionOptions& fusion) {
    MonocularOptions options;
    options.filter.minDepth = std::max(fusion.minRange, 0.01);
    return options;
}

}  // namespace

MonocularFusion::MonocularFusion(TexturedOcTree& map, const Camera& camera,
                                 const FusionOptions& options)
    : map_(map), camera_(camera), options_(options), depth_(camera, optionsFor(options)) {}

void MonocularFusion::add(const RecordedFrame& frame) {
    const auto finished = depth_.add(frame.view.intensity, frame.T_c_w);
    if (finished) fuseReference(*finished);
    if (finished || recorded_.getSize() == 0) recorded_ = frame.view.depth;
}

void MonocularFusion::finish() {
    if (const auto last = depth_.finish()) fuseReference(*last);
}

void MonocularFusion::fuseReference(const DepthFilter& filter) {
    const View view = filter.view();
    ++references_;
    for (unsigned i = 0; i < recorded_.getSize(); ++i) {
        const float z = recorded_.bitmap[i];
        if (!(z > 0.F)) continue;
        ++pixels_;
        const float found = view.depth.bitmap[i];
        if (found > 0.F) errors_.push_back(std::abs(found - z) / z);
    }
    fuse(map_, view, camera_, filter.pose(), options_);
}

nlohmann::json MonocularFusion::result() const {
    nlohmann::json result = {{"references", references_},
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
