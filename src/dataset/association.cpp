// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/association.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace photonav {
namespace {

/// Of the timestamps that have no partner yet, the closest pair is always next to each other in
/// time: only neighbours wait in the queue, and those of a pair become neighbours when it is made.
class Association {
  public:
    Association(const std::vector<double>& a, const std::vector<double>& b, double tolerance)
        : tolerance_(tolerance), partner_(a.size(), -1) {
        for (std::size_t i = 0; i < a.size(); ++i) stamps_.push_back({a[i], int(i), true});
        for (std::size_t i = 0; i < b.size(); ++i) stamps_.push_back({b[i], int(i), false});
        // The n-th of equal timestamps in one list meets the n-th in the other.
        std::stable_sort(stamps_.begin(), stamps_.end(), [](const Stamp& x, const Stamp& y) {
            return std::tie(x.time, x.index) < std::tie(y.time, y.index);
        });
        for (std::size_t i = 0; i < stamps_.size(); ++i) {
            stamps_[i].before = int(i) - 1;
            stamps_[i].after = i + 1 < stamps_.size() ? int(i) + 1 : -1;
            offer(stamps_[i].before, int(i));
        }
    }

    std::vector<int> run() {
        while (!pairs_.empty()) {
            const auto [difference, first, second, i, j] = pairs_.top();
            pairs_.pop();
            if (stamps_[i].isTaken || stamps_[j].isTaken) continue;
            partner_[first] = second;
            stamps_[i].isTaken = stamps_[j].isTaken = true;
            const int before = stamps_[i].before;
            const int after = stamps_[j].after;
            if (before >= 0) stamps_[before].after = after;
            if (after >= 0) stamps_[after].before = before;
            offer(before, after);
        }
        return std::move(partner_);
    }

  private:
    struct Stamp {
        double time;
        int index;
        bool isOfA;
        int before = -1, after = -1;  // among those that are not taken
        bool isTaken = false;
    };
    /// Difference, index in a, index in b: the order in which pairs are made; the two stamps.
    using Pair = std::tuple<double, int, int, int, int>;

    void offer(int i, int j) {
        if (i < 0 || j < 0 || stamps_[i].isOfA == stamps_[j].isOfA) return;
        const double difference = stamps_[j].time - stamps_[i].time;
        if (!(difference <= tolerance_)) return;
        const Stamp& first = stamps_[i].isOfA ? stamps_[i] : stamps_[j];
        const Stamp& second = stamps_[i].isOfA ? stamps_[j] : stamps_[i];
        pairs_.push({difference, first.index, second.index, i, j});
    }

    double tolerance_;
    std::vector<Stamp> stamps_;  // in order of time
    std::priority_queue<Pair, std::vector<Pair>, std::greater<>> pairs_;
    std::vector<int> partner_;
};

}  // namespace

std::vector<int> associate(const std::vector<double>& a, const std::vector<double>& b,
                           double tolerance) {
    return Association(a, b, tolerance).run();
}

}  // namespace photonav
