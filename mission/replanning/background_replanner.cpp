// SPDX-License-Identifier: BSD-3-Clause
#include "replanning/background_replanner.hpp"

#include <chrono>
#include <iterator>
#include <utility>

#include "io/interrupted.hpp"

namespace photonav {

BackgroundReplanner::~BackgroundReplanner() { isStopped_ = true; }

void BackgroundReplanner::add(ReplanRequest request) {
    waited_ += running_.valid() ? 1 : 0;
    if (!waiting_) {
        waiting_ = std::move(request);
        return;
    }
    joined_ += running_.valid() ? 1 : 0;
    std::vector<MapInput> images = std::move(waiting_->images);
    std::move(request.images.begin(), request.images.end(), std::back_inserter(images));
    waiting_ = std::move(request);
    waiting_->images = std::move(images);
}

void BackgroundReplanner::goOn(const UncertainPose& T_c_w) {
    if (!waiting_ || running_.valid()) return;
    waiting_->T_c_w = T_c_w;
    running_ = std::async(std::launch::async, [this, request = std::move(*waiting_)]() mutable {
        return std::optional(replanner_.replan(std::move(request), {isStopped_, seconds_}));
    });
    waiting_.reset();
}

std::optional<Replanned> BackgroundReplanner::poll() {
    const bool isDone =
        running_.valid() && running_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    return isDone ? running_.get() : std::nullopt;
}

void BackgroundReplanner::run(std::function<void()> task) {
    running_ = std::async(std::launch::async, [task = std::move(task)] {
        task();
        return std::optional<Replanned>();
    });
}

void BackgroundReplanner::stop() {
    waiting_.reset();
    if (!running_.valid()) return;
    isStopped_ = true;
    try {
        running_.get();
    } catch (const Interrupted&) {  // by isStopped_
    }
}

}  // namespace photonav
