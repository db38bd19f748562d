// SPDX-License-Identifier: BSD-3-Clause
// Replanning on a second thread, for flights in real time.
#pragma once

#include <future>

#include "replanning/replanner.hpp"

namespace photonav {

/// Replans one request at a time on a second thread, while the caller flies on. Requests that come
/// while the thread is busy wait, and are joined to one.
///
/// There is no shared state to protect: the thread lives for one task only. It begins with copies
/// (ReplanRequest), and its result is read when it has ended (std::future). In between the caller
/// uses nothing of the Replanner but clearanceBeside(). All functions are called by one thread.
class BackgroundReplanner {
  public:
    /// @param replanner must outlive this object
    /// @param seconds PlanningLimits::seconds of every update [s]
    BackgroundReplanner(Replanner& replanner, double seconds)
        : replanner_(replanner), seconds_(seconds) {}
    BackgroundReplanner(const BackgroundReplanner&) = delete;
    BackgroundReplanner& operator=(const BackgroundReplanner&) = delete;
    ~BackgroundReplanner();

    /// Adds a request, to be begun by goOn().
    void add(ReplanRequest request);
    /// Begins what waits, if the thread is idle. @param T_c_w the present belief
    void goOn(const UncertainPose& T_c_w);
    /// The result, once, when the thread has ended. Never waits.
    /// @throws the exception that has ended the thread
    std::optional<Replanned> poll();
    /// Runs a task before the next request. To be called only right after poll() returned a result.
    void run(std::function<void()> task);
    /// Ends the thread as soon as possible and drops what waits.
    /// @throws the exception that has ended the thread, unless that was the stop
    void stop();

    /// Whether a request is being worked on or waits.
    bool isBusy() const { return running_.valid() || waiting_.has_value(); }
    std::size_t waited() const { return waited_; }  ///< number of requests that had to wait
    std::size_t joined() const { return joined_; }  ///< of these, joined to an earlier one

  private:
    Replanner& replanner_;
    double seconds_;
    std::atomic<bool> isStopped_ = false;
    std::optional<ReplanRequest> waiting_;
    std::size_t waited_ = 0, joined_ = 0;
    std::future<std::optional<Replanned>> running_;  // last: its destructor waits for the thread
};

}  // namespace photonav
