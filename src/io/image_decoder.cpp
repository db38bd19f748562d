// SPDX-License-Identifier: BSD-3-Clause
#include "io/image_decoder.hpp"

#include <opencv2/imgcodecs.hpp>

namespace photonav {

cv::Mat decodedImage(std::span<const std::uint8_t> encoded, int flags,
                     const std::function<bool(const ImageSize&)>& wanted) {
    const auto bytes = soundImage(encoded);
    const auto size = declaredSize(bytes);
    if (!size || !wanted(*size)) return {};
    try {
        return cv::imdecode(bytes, flags);
    } catch (const cv::Exception&) {  // the decoder reads another size from a damaged header
        return {};
    }
}

}  // namespace photonav
