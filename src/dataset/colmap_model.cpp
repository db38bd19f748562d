// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/colmap_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>

#include "dataset/trajectory.hpp"
#include "io/atomic_file.hpp"
#include "io/reading.hpp"
#include "io/text_table.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

constexpr double kPixelCentre = 0.5;  // of the first pixel; ours is at 0
constexpr std::size_t kImageFields = 10;

/// A binary model is found as well, to say what to do with it.
std::optional<fs::path> modelIn(const fs::path& folder) {
    for (const char* file : {"cameras.txt", "images.txt", "cameras.bin"}) {
        for (const char* name : {"", "sparse", "sparse/0"}) {
            if (fs::exists(folder / name / file)) return folder / name;
        }
    }
    return {};
}

/// Lines with their fields at blanks, but for comments. Blank lines have no fields.
std::vector<std::pair<std::size_t, TextRow>> linesOf(const std::string& file) {
    std::ifstream in = openText(file);
    std::vector<std::pair<std::size_t, TextRow>> lines;
    int number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        if (line.starts_with('#')) continue;
        std::istringstream stream(line);
        std::vector<std::string> fields;
        for (std::string field; stream >> field;) fields.push_back(field);
        const std::size_t count = fields.size();
        lines.emplace_back(count, TextRow(file, number, std::move(fields)));
    }
    return lines;
}

unsigned pixelsIn(const TextRow& row, std::size_t column) {
    constexpr double kMost = 1e5;
    const double value = row.number(column);
    if (!(value >= 1. && value <= kMost && value == std::floor(value))) {
        row.fail(fmt::format("'{}' is no number of pixels", row.text(column)));
    }
    return static_cast<unsigned>(value);
}

/// CAMERA_ID MODEL WIDTH HEIGHT PARAMS...
Camera cameraOf(const TextRow& row, std::size_t fields) {
    const std::string model = fields > 1 ? row.text(1) : "";
    const bool isSimple = model == "SIMPLE_PINHOLE";
    if (!isSimple && model != "PINHOLE") {
        row.fail(
            fmt::format("camera model '{}': images must be without distortion (PINHOLE, "
                        "SIMPLE_PINHOLE), as `colmap image_undistorter` makes them",
                        model));
    }
    if (fields != (isSimple ? 7U : 8U)) row.fail(fmt::format("{} fields of a {}", fields, model));
    const std::size_t next = isSimple ? 5 : 6;
    const double fx = row.number(4), fy = isSimple ? fx : row.number(5);
    Camera camera{pixelsIn(row, 2),
                  pixelsIn(row, 3),
                  {fx, fy, row.number(next) - kPixelCentre, row.number(next + 1) - kPixelCentre}};
    constexpr double kLeastFocal = 0.005, kFarthestCentre = 10.;  // of the image's size
    const auto isPlausible = [](double focal, double centre, double size) {
        return focal >= kLeastFocal * size && std::abs(centre) <= kFarthestCentre * size;
    };
    if (!isPlausible(fx, camera.cx(), camera.width) ||
        !isPlausible(fy, camera.cy(), camera.height)) {
        row.fail("implausible focal length or principal point");
    }
    return camera;
}

std::map<std::string, Camera> readCameras(const std::string& file) {
    std::map<std::string, Camera> cameras;
    for (const auto& [fields, row] : linesOf(file)) {
        if (fields > 0) cameras.insert_or_assign(row.text(0), cameraOf(row, fields));
    }
    if (cameras.empty()) throw InputError(file, "", "no cameras");
    return cameras;
}

/// IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, where a name may have blanks.
Sequence::Entry imageOf(const TextRow& row, std::size_t fields, const fs::path& images) {
    if (fields < kImageFields) row.fail(fmt::format("{} fields of an image", fields));
    std::string name = row.text(kImageFields - 1);
    for (std::size_t i = kImageFields; i < fields; ++i) name += " " + row.text(i);
    Sequence::Entry image;
    image.T_c_w = poseOfRow(row, 0., {row.number(5), row.number(6), row.number(7)},
                            {row.number(1), row.number(2), row.number(3), row.number(4)})
                      .T_w_c;  // COLMAP's pose maps the world into the camera
    image.colourFile = (images / name).string();
    return image;
}

/// Every image has a second line with its points.
void readImages(const std::string& file, const fs::path& images, Sequence& sequence,
                std::string& usedCamera) {
    const auto lines = linesOf(file);
    for (std::size_t i = 0; i < lines.size(); i += 2) {
        const auto& [fields, row] = lines[i];
        if (fields == 0 && i + 1 == lines.size()) break;  // a blank line at the end
        sequence.frames.push_back(imageOf(row, fields, images));
        const std::string& camera = row.text(kImageFields - 2);
        if (!usedCamera.empty() && camera != usedCamera) {
            row.fail("another camera than the images before it: one is needed for all");
        }
        usedCamera = camera;
    }
    if (sequence.frames.empty()) throw InputError(file, "", "no images");
    auto& frames = sequence.frames;
    std::ranges::sort(frames, [](const Sequence::Entry& a, const Sequence::Entry& b) {
        return strverscmp(a.colourFile.c_str(), b.colourFile.c_str()) < 0;
    });
    for (std::size_t i = 0; i < frames.size(); ++i) {
        frames[i].timestamp = static_cast<double>(i);
        if (i > 0 && frames[i].colourFile == frames[i - 1].colourFile) {
            throw InputError(file, "", frames[i].colourFile + " is listed twice");
        }
    }
}

}  // namespace

bool isColmapFolder(const std::string& folder) { return modelIn(folder).has_value(); }

Sequence readColmapSequence(const std::string& folder) {
    return reading(folder, [&] {
        const std::optional<fs::path> model = modelIn(folder);
        if (!model) throw InputError(folder, "", "no cameras.txt and images.txt of COLMAP");
        if (!fs::exists(*model / "cameras.txt") && fs::exists(*model / "cameras.bin")) {
            throw InputError((*model / "cameras.bin").string(), "",
                             "a binary model; `colmap model_converter --output_type TXT` makes "
                             "it text");
        }
        const fs::path images = fs::path(folder) / "images";
        Sequence sequence;
        sequence.cameraFile = (*model / "cameras.txt").string();
        sequence.needsDepth = false;
        std::string used;
        readImages((*model / "images.txt").string(),
                   fs::is_directory(images) ? images : fs::path(folder), sequence, used);
        const auto cameras = readCameras(sequence.cameraFile);
        const auto camera = cameras.find(used);
        if (camera == cameras.end()) {
            throw InputError(sequence.cameraFile, "", fmt::format("no camera {}", used));
        }
        sequence.camera = camera->second;
        sequence.recorded = sequence.frames.size();
        return sequence;
    });
}

void writeColmapModel(const std::string& folder, const Camera& camera,
                      std::vector<ColmapImage> images) {
    const auto write = [&](const char* name, const std::string& text) {
        writeFileAtomically(fs::path(folder) / name, text);
    };
    write("cameras.txt", fmt::format("# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
                                     "1 PINHOLE {} {} {:.9g} {:.9g} {:.9g} {:.9g}\n",
                                     camera.width, camera.height, camera.fx(), camera.fy(),
                                     camera.cx() + kPixelCentre, camera.cy() + kPixelCentre));
    std::ranges::sort(images, {}, &ColmapImage::name);
    std::string text =
        "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n# POINTS2D[] as (X, Y, "
        "POINT3D_ID)\n";
    for (std::size_t i = 0; i < images.size(); ++i) {
        const Eigen::Vector3d& t = images[i].T_c_w.translation();
        const Eigen::Quaterniond q(images[i].T_c_w.linear());
        text += fmt::format("{} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} 1 {}\n\n", i + 1,
                            q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), images[i].name);
    }
    write("images.txt", text);
    write("points3D.txt", "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]\n");
}

}  // namespace photonav
