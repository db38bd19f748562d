// SPDX-License-Identifier: BSD-3-Clause
#include "io/image_decoder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <mutex>
#include <opencv2/imgcodecs.hpp>

namespace photonav {
namespace {

/// Closes standard error while there is one of it, in any thread: the libraries have no other way.
class QuietDecoding {
  public:
    QuietDecoding() {
        const std::lock_guard lock(mutex_);
        if (count_++ > 0 || !quietDecoders) return;
        const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (nowhere < 0) return;
        kept_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
        if (kept_ >= 0) dup2(nowhere, STDERR_FILENO);
        close(nowhere);
    }
    ~QuietDecoding() {
        const std::lock_guard lock(mutex_);
        if (--count_ > 0 || kept_ < 0) return;
        dup2(kept_, STDERR_FILENO);
        close(kept_);
        kept_ = -1;
    }
    QuietDecoding(const QuietDecoding&) = delete;
    QuietDecoding& operator=(const QuietDecoding&) = delete;

  private:
    static inline std::mutex mutex_;
    static inline int count_ = 0, kept_ = -1;
};

}  // namespace

cv::Mat decodedImage(std::span<const std::uint8_t> encoded, int flags,
                     const std::function<bool(const ImageSize&)>& wanted) {
    std::vector<std::uint8_t> rewritten;
    const auto bytes = soundImage(encoded, rewritten);
    const auto size = declaredSize(bytes);
    if (!size || !wanted(*size)) return {};
    const QuietDecoding quiet;
    try {
        const cv::_InputArray input(bytes.data(), static_cast<int>(bytes.size()));
        return cv::imdecode(input, flags);
    } catch (const cv::Exception&) {  // the decoder reads another size from a damaged header
        return {};
    }
}

}  // namespace photonav
