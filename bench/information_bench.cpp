// SPDX-License-Identifier: BSD-3-Clause
// Fisher information of a 188x120 view: the fused kernel against ViSP's luminance feature, reused
// and fresh, and against the sum of J^T J in plain Eigen.
#include <fmt/format.h>
#include <visp3/visual_features/vpFeatureLuminance.h>

#include "bench_arguments.hpp"
#include "min_time.hpp"
#include "photometry/photometric.hpp"
#include "photometry/simd.hpp"

using namespace photonav;

namespace {

View wavyView(const Camera& camera) {
    View view;
    view.intensity.resize(camera.height, camera.width);
    view.depth.resize(camera.height, camera.width);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            view.intensity[v][u] = static_cast<float>(0.5 + 0.2 * std::sin(0.3 * v + 0.2 * u) +
                                                      0.2 * std::sin(0.5 * u - 0.1 * v));
            view.depth[v][u] = static_cast<float>(1. / (0.5 + 0.002 * v + 0.001 * u));
        }
    }
    return view;
}

/// ViSP's way: gradient, interaction matrix, normal matrix.
double visp(vpFeatureLuminance& feature, vpImage<unsigned char>& image) {
    static vpMatrix L, LtL;
    feature.buildFrom(image);
    feature.interaction(L);
    L.AtA(LtL);
    return LtL[0][0];
}

Matrix6 eigen(const View& view, const Camera& camera) {
    Matrix6 sum = Matrix6::Zero();
    for (unsigned v = 1; v + 1 < camera.height; ++v) {
        for (unsigned u = 1; u + 1 < camera.width; ++u) {
            const Vector6 J = pixelJacobian(view, camera, u, v);
            sum += J * J.transpose();
        }
    }
    return sum;
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "information_bench");
    const Camera camera = makeCamera(188, 120, 1.22);
    const View view = wavyView(camera);
    vpImage<unsigned char> bytes(camera.height, camera.width);
    for (unsigned i = 0; i < bytes.getSize(); ++i) {
        bytes.bitmap[i] = static_cast<unsigned char>(255.F * view.intensity.bitmap[i]);
    }
    const auto fresh = [&] {
        vpFeatureLuminance feature;
        feature.init(camera.height, camera.width, 2.);
        feature.cam = camera.intrinsics;
        return feature;
    };
    vpFeatureLuminance reused = fresh();

    double sink = 0.;
    const double kernelTime =
        minMicroseconds(50, 50, [&](int) { sink += photometricInformation(view, camera)(0, 0); });
    const double reusedTime = minMicroseconds(30, 5, [&](int) { sink += visp(reused, bytes); });
    const double freshTime = minMicroseconds(30, 5, [&](int) {
        vpFeatureLuminance feature = fresh();
        sink += visp(feature, bytes);
    });
    const double eigenTime =
        minMicroseconds(30, 5, [&](int) { sink += eigen(view, camera)(0, 0); });

    fmt::print("information of a {}x{} view, {} float lanes (checksum {:.6g})\n", camera.width,
               camera.height, simd::kWidth, sink);
    fmt::print("  fused kernel          {:8.1f} us\n", kernelTime);
    for (const auto& [name, time] : {std::pair{"ViSP feature, reused ", reusedTime},
                                     {"ViSP feature, fresh  ", freshTime},
                                     {"Eigen, pixel by pixel", eigenTime}}) {
        fmt::print("  {} {:8.1f} us   kernel is {:5.1f}x faster\n", name, time, time / kernelTime);
    }
}
