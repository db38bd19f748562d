// SPDX-License-Identifier: BSD-3-Clause
#include "replay/depth_registration.hpp"

#include <fmt/format.h>

#include <optional>

#include "alignment/keyframe_model.hpp"
#include "dataset/sequence_tum.hpp"
#include "io/error.hpp"

namespace photonav {
namespace {

constexpr double kApart = 0.05;         // translation between the images of a pair [mean depths]
constexpr std::size_t kMostPairs = 80;  // which bounds memory

/// The first image of a pair, and how far the camera has come since.
struct Open {
    std::size_t frame;
    ImageF image;
    KeyframeModel keyframe;
    Pose T_now_first = Pose::Identity();

    Open(std::size_t i, const View& view, const Camera& camera)
        : frame(i), image(view.intensity), keyframe(view, camera) {}
};

/// The frames that can be loaded are taken one after the other.
class Pairing {
  public:
    explicit Pairing(const Sequence& sequence)
        : sequence_(sequence), calibrator_(sequence.camera, *sequence.depthCamera) {}

    void add(std::size_t i) {
        View view;
        try {
            view = loadFrame(sequence_, i).view;
        } catch (const InputError& error) {
            if (unreadable_++ == 0) firstReason_ = error;
            return;
        }
        if (!open_) {
            open_.emplace(i, view, sequence_.camera);
            return;
        }
        const Alignment a = open_->keyframe.align(view.intensity, open_->T_now_first);
        if (a.verdict != Verdict::converged) {
            open_.emplace(i, view, sequence_.camera);
            return;
        }
        open_->T_now_first = a.T_c_w;
        if (a.T_c_w.translation().norm() < kApart * a.meanDepth) return;
        if (calibrator_.pairs() < kMostPairs) {
            calibrator_.add(open_->image, loadDepth(sequence_, open_->frame), view.intensity,
                            a.T_c_w);
        }
        open_.emplace(i, view, sequence_.camera);
    }

    DepthCalibrator& calibrator() { return calibrator_; }
    std::size_t unreadable() const { return unreadable_; }
    /// @throws InputError of the first frame that cannot be used, if more than half cannot
    void checkReadable() const {
        if (2 * unreadable_ > sequence_.frames.size()) throw InputError(*firstReason_);
    }

  private:
    const Sequence& sequence_;
    DepthCalibrator calibrator_;
    std::optional<Open> open_;
    std::size_t unreadable_ = 0;
    std::optional<InputError> firstReason_;
};

Sequence openSequence(const RecordingOptions& options) {
    RecordingOptions reading = options;
    reading.forgiving = true;
    reading.needsDepth = true;
    Sequence sequence = readRecording(reading).sequence;
    if (!sequence.hasDepth()) {
        throw InputError(options.dataset, "", "has no depth images to calibrate");
    }
    if (!sequence.depthCamera) sequence.depthCamera = DepthCamera{sequence.camera};
    return sequence;
}

}  // namespace

DepthRegistration registerDepth(
    const RecordingOptions& options, const IsStopped& isStopped,
    const std::function<void(std::size_t done, std::size_t all)>& progress) {
    DepthRegistration result;
    result.sequence = openSequence(options);
    Pairing pairing(result.sequence);
    const std::size_t count = result.sequence.frames.size();
    for (std::size_t i = 0; i < count; ++i) {
        result.isInterrupted = isStopped && isStopped();
        if (result.isInterrupted) return result;
        pairing.add(i);
        if (progress) progress(i + 1, count);
    }
    result.pairs = pairing.calibrator().pairs();
    result.unreadable = pairing.unreadable();
    pairing.checkReadable();
    if (result.pairs < DepthCalibrator::kLeastPairs) {
        throw InputError(
            options.dataset, "",
            fmt::format("the camera moves too little: {} pairs of images that are {:.0f} % of the "
                        "depth in view apart, {} are needed",
                        result.pairs, 100. * kApart, DepthCalibrator::kLeastPairs));
    }
    result.calibration = pairing.calibrator().solve();
    result.sequence.depthCamera->T_c_d = result.calibration.T_c_d;
    return result;
}

}  // namespace photonav
