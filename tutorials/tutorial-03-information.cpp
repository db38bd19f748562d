// SPDX-License-Identifier: BSD-3-Clause
// The information of an image: from the Jacobian of one pixel to the Fisher information of a view,
// and to the question which pixels inform about which direction of motion.
#include <cstdio>
#include <numbers>

#include "exercises.hpp"
#include "figures/images.hpp"
#include "geometry/uncertain_pose.hpp"
#include "geometry/visp_bridge.hpp"
#include "photometry/luminance_feature.hpp"
#include "photometry/photometric.hpp"
#include "render/mesh_renderer.hpp"

using namespace photonav;

namespace {

View lookDownAt(const Texture& texture, const Camera& camera, double height = 2.) {
    Scene floor;
    addPlane(floor, {-5., 5., 0.}, {10., 0., 0.}, {0., -10., 0.}, addTexture(floor, texture));
    Pose T_w_c = cameraMount(std::numbers::pi / 2.);  // straight down: image up is world x
    T_w_c.translation() << 0., 0., height;
    View view;
    MeshRenderer(floor).render(camera, T_w_c.inverse(), view);
    return view;
}

//! [by-hand]
/// d intensity / d xi of pixel (u, v): image gradient times projection times motion of the point.
Vector6 jacobianByHand(const View& view, const Camera& camera, unsigned u, unsigned v) {
    const double gu = 0.5 * (view.intensity[v][u + 1] - view.intensity[v][u - 1]);
    const double gv = 0.5 * (view.intensity[v + 1][u] - view.intensity[v - 1][u]);
    const double x = (u - camera.cx()) / camera.fx();
    const double y = (v - camera.cy()) / camera.fy();
    const double Z = view.depth[v][u];
    Vector6 Ju, Jv;  // how the pixel moves with (rho, phi)
    Ju << 1. / Z, 0., -x / Z, -x * y, 1. + x * x, -y;
    Jv << 0., 1. / Z, -y / Z, -1. - y * y, x * y, x;
    return gu * camera.fx() * Ju + gv * camera.fy() * Jv;
}
//! [by-hand]

void compareOnePixel(const View& view, const Camera& camera) {
    //! [one-pixel]
    const unsigned u = 70;
    const unsigned v = 50;
    const Vector6 byHand = jacobianByHand(view, camera, u, v);
    const Vector6 byPhotonav = pixelJacobian(view, camera, u, v);
    PixelDepthLuminance feature;  // ViSP's luminance feature with every pixel's own depth
    feature.buildFrom(view, camera);
    const vpMatrix L = feature.interaction();
    const Eigen::Map<const Vector6> byVisp(L[(v - 1) * (camera.width - 2) + u - 1]);
    //! [one-pixel]
    std::printf("J of pixel (%u, %u)\n", u, v);
    for (const auto& [name, J] : {std::pair<const char*, Vector6>{"by hand ", byHand},
                                  {"photonav", byPhotonav},
                                  {"ViSP    ", byVisp}}) {
        std::printf("  %s", name);
        for (double j : J) std::printf(" %9.5f", j);
        std::puts("");
    }
}

void compareWholeImage(const View& view, const Camera& camera) {
    //! [whole-image]
    const double sigma = PhotometricOptions{}.sigma;
    PixelDepthLuminance feature;
    feature.buildFrom(view, camera);
    const Matrix6 byVisp = matrix6FromVisp(feature.interaction().AtA()) / (sigma * sigma);
    const Matrix6 byKernel = photometricInformation(view, camera);  // stores no Jacobian
    //! [whole-image]
    std::printf("Fisher information: ViSP's J^T J and the kernel differ by %.0e\n",
                (byVisp - byKernel).norm() / byVisp.norm());
}

//! [update]
/// Standard deviations (x, y, z [mm], about x, y, z [mrad]) after some images from one place.
Vector6 sigmaAfter(const View& view, const Camera& camera, int images = 1) {
    Matrix6 covariance = Matrix6::Zero();
    covariance.diagonal() << 1e-2, 1e-2, 1e-2, 1e-4, 1e-4, 1e-4;  // 0.1 m, 0.01 rad
    const Matrix6 information = photometricInformation(view, camera);
    for (int i = 0; i < images; ++i) covariance = updateCovariance(covariance, information);
    return 1e3 * covariance.diagonal().cwiseSqrt();
}
//! [update]

void report(const char* name, const View& view, const Camera& camera) {
    const Vector6 sigma = sigmaAfter(view, camera);
    std::printf("%s: after one image sigma is %6.2f %6.2f %6.2f mm and %5.2f %5.2f %5.2f mrad\n",
                name, sigma[0], sigma[1], sigma[2], sigma[3], sigma[4], sigma[5]);
}

/// The view, and which of its pixels inform about motion along image x, image y and the optical
/// axis.
std::vector<CaptionedImage> images(const std::string& name, const View& view,
                                   const Camera& camera) {
    std::vector<CaptionedImage> row{{name, greyPicture(view.intensity)}};
    //! [contribution]
    for (int axis = 0; axis < 3; ++axis) {
        const ImageF contribution = contributionImage(view, camera, Vector6::Unit(axis));
        row.push_back({std::string("information about ") + "xyz"[axis],
                       greyPicture(contribution, 1. / 5e4)});  // white: 5e4 / m^2 from one pixel
    }
    //! [contribution]
    return row;
}

std::vector<Exercise> exercises(const Camera& camera) {
    return {{[&] { return sigmaAfter(lookDownAt(valueNoise(), camera), camera, 4)[0]; }, 0.05},
            {[&] { return sigmaAfter(lookDownAt(valueNoise(), camera, 4.), camera)[0]; }, 0.05}};
}

}  // namespace

int main(int argc, char** argv) {
    const Camera camera = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    if (const auto code = checkAnswers(argc, argv, exercises(camera))) return *code;
    const View noise = lookDownAt(valueNoise(), camera);
    const View bars = lookDownAt(stripes({.alongV = true}), camera);  // along world x, image y

    compareOnePixel(noise, camera);
    compareWholeImage(noise, camera);
    report("noise  ", noise, camera);
    report("stripes", bars, camera);

    imagesFigure({images("noise", noise, camera), images("stripes", bars, camera)}, 376.)
        .save("information.png");
    std::puts("wrote information.png");
}
