// SPDX-License-Identifier: BSD-3-Clause
// Encoded images: textures, and grey and depth images of a recording.
#include "dataset/image_file.hpp"
#include "fuzz_input.hpp"
#include "geometry/camera.hpp"
#include "io/image_bytes.hpp"
#include "scene/texture.hpp"

namespace {

/// Only the size of larger ones is read: a decoder takes its time for 100 million pixels.
constexpr std::uint64_t kMostPixels = 1U << 16U;

}  // namespace

void photonav::fuzz::run(std::string_view input) {
    const unsigned choice = takeChoice(input, 3);
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    const auto size = declaredSize(bytes);
    if (size && size->width * size->height > kMostPixels) return;
    const Camera camera = makeCamera(8, 8, 1.);
    check([&] {
        if (choice == 0) {
            decodeGrey(bytes, "texture");
        } else if (choice == 1) {
            require(readGrey8(write("grey", input), camera, "camera").getWidth() == 8, "8 columns");
        } else {
            readDepth16(write("depth", input), camera, "camera", 1e-3);
        }
    });
}
