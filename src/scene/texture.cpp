// SPDX-License-Identifier: BSD-3-Clause
#include "scene/texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <stdexcept>

#include "io/error.hpp"
#include "io/image_decoder.hpp"

namespace photonav {
namespace {

void demand(bool condition, const char* what) {
    if (!condition) throw std::invalid_argument(what);
}

unsigned texels(double length, double texel) {
    demand(length > 0. && texel > 0., "texture: size and texel must be positive");
    const double count = std::max(1., std::round(length / texel));
    demand(count <= 32768., "texture: more than 32768 texels along one side");
    return static_cast<unsigned>(count);
}

unsigned wrap(int i, unsigned n) {
    const int m = i % static_cast<int>(n);
    return static_cast<unsigned>(m < 0 ? m + static_cast<int>(n) : m);
}

/// One field of lattice values in [-1, 1], smoothly interpolated, periodic over [0, 1).
class Lattice {
  public:
    Lattice(unsigned columns, unsigned rows, std::mt19937& random) : values_(rows, columns) {
        for (unsigned i = 0; i < values_.getSize(); ++i) {
            values_.bitmap[i] = static_cast<float>(random()) / 2147483648.F - 1.F;
        }
    }

    /// Adds `amplitude` times the field to the image.
    void addTo(ImageF& image, float amplitude) const {
        const auto columns = stops(image.getWidth(), values_.getWidth());
        const auto rows = stops(image.getHeight(), values_.getHeight());
        for (unsigned v = 0; v < image.getHeight(); ++v) {
            const float* above = values_[rows[v].low];
            const float* below = values_[rows[v].high];
            float* out = image[v];
            for (unsigned u = 0; u < image.getWidth(); ++u) {
                const Stop& s = columns[u];
                const float top = above[s.low] + (above[s.high] - above[s.low]) * s.weight;
                const float bottom = below[s.low] + (below[s.high] - below[s.low]) * s.weight;
                out[u] += amplitude * (top + (bottom - top) * rows[v].weight);
            }
        }
    }

  private:
    struct Stop {
        unsigned low, high;
        float weight;
    };
    static std::vector<Stop> stops(unsigned texelCount, unsigned cells) {
        std::vector<Stop> result(texelCount);
        for (unsigned i = 0; i < texelCount; ++i) {
            const double x = (i + 0.5) / texelCount * cells;
            const auto low = static_cast<unsigned>(x);
            const double t = x - low;
            result[i] = {low % cells, (low + 1) % cells,
                         static_cast<float>(t * t * t * (t * (6. * t - 15.) + 10.))};
        }
        return result;
    }

    ImageF values_;
};

/// Triangle-wave position inside the bars: below 0 dark, above 0 light, in metres from the edge.
double signedDistanceToEdge(double x, double width) {
    const double phase = x / (2. * width);
    const double inPeriod = (phase - std::floor(phase)) * 2. * width;
    return inPeriod < width ? -std::min(inPeriod, width - inPeriod)
                            : std::min(inPeriod - width, 2. * width - inPeriod);
}

/// -1 in dark bars, 1 in light ones, a linear ramp of width `softEdge` between.
double barSign(double x, double width, double softEdge) {
    const double distance = signedDistanceToEdge(x, width);
    return std::clamp(distance / std::max(0.5 * softEdge, 1e-9), -1., 1.);
}

double encodeSrgb(double linear) {
    const double x = std::clamp(linear, 0., 1.);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1. / 2.4) - 0.055;
}

ImageF greyOf(const cv::Mat& file, const std::array<double, 3>& factor) {
    const double maximum = file.depth() == CV_16U ? 65535. : 255.;
    const bool floating = file.depth() == CV_32F || file.depth() == CV_64F;
    const int channels = file.channels();
    ImageF grey(static_cast<unsigned>(file.rows), static_cast<unsigned>(file.cols));
    std::array<float, 16 * 255 + 1> decode{};  // 8-bit values fall on every 16th entry
    for (std::size_t i = 0; i < decode.size(); ++i) {
        decode[i] = static_cast<float>(decodeSrgb(static_cast<double>(i) / (decode.size() - 1.)));
    }
    const auto linear = [&](float x) {
        const float scaled = std::clamp(x, 0.F, 1.F) * (decode.size() - 1.F);
        const auto low = std::min<std::size_t>(static_cast<std::size_t>(scaled), decode.size() - 2);
        return decode[low] + (decode[low + 1] - decode[low]) * (scaled - static_cast<float>(low));
    };
    cv::Mat line;
    for (int v = 0; v < file.rows; ++v) {
        file.row(v).convertTo(line, CV_32F, floating ? 1. : 1. / maximum);
        const auto* row = line.ptr<float>();
        for (int u = 0; u < file.cols; ++u) {
            const float* p = row + static_cast<std::ptrdiff_t>(u) * channels;
            const bool colour = channels >= 3;
            const float b = linear(p[0]);
            grey[v][u] = static_cast<float>(
                greyOfLinear({factor[0] * (colour ? linear(p[2]) : b),
                              factor[1] * (colour ? linear(p[1]) : b), factor[2] * b}));
        }
    }
    return grey;
}

}  // namespace

float Texture::at(const Eigen::Vector2d& position) const {
    if (image.getSize() == 1) return *image.bitmap;
    const double x = position.x() / size.x() * image.getWidth() - 0.5;
    const double y = position.y() / size.y() * image.getHeight() - 0.5;
    const int column = static_cast<int>(std::floor(x));
    const int row = static_cast<int>(std::floor(y));
    const auto s = static_cast<float>(x - column);
    const auto t = static_cast<float>(y - row);
    const unsigned left = wrap(column, image.getWidth());
    const unsigned right = wrap(column + 1, image.getWidth());
    const float* above = image[wrap(row, image.getHeight())];
    const float* below = image[wrap(row + 1, image.getHeight())];
    const float top = above[left] + (above[right] - above[left]) * s;
    const float bottom = below[left] + (below[right] - below[left]) * s;
    return top + (bottom - top) * t;
}

Texture uniformTexture(double grey) {
    demand(grey >= 0. && grey <= 1., "uniform: grey must be within [0, 1]");
    return {ImageF(1, 1, static_cast<float>(grey)), Eigen::Vector2d::Ones()};
}

Texture valueNoise(const NoiseOptions& options) {
    demand(!options.cells.empty(), "noise: no cell sizes");
    std::vector<double> amplitudes = options.amplitudes;
    if (amplitudes.empty()) {
        amplitudes.assign(options.cells.size(), 0.4 / static_cast<double>(options.cells.size()));
    }
    demand(amplitudes.size() == options.cells.size(), "noise: one amplitude per cell size");
    double reach = 0.;
    for (const double a : amplitudes) reach += std::abs(a);
    demand(options.mean - reach >= 0. && options.mean + reach <= 1.,
           "noise: mean plus or minus the sum of amplitudes leaves [0, 1]");

    Texture texture{
        ImageF(texels(options.size.y(), options.texel), texels(options.size.x(), options.texel),
               static_cast<float>(options.mean)),
        options.size};
    std::mt19937 random(options.seed);
    for (std::size_t i = 0; i < amplitudes.size(); ++i) {
        demand(options.cells[i] > 0., "noise: cell sizes must be positive");
        const Lattice lattice(texels(options.size.x(), options.cells[i]),
                              texels(options.size.y(), options.cells[i]), random);
        lattice.addTo(texture.image, static_cast<float>(amplitudes[i]));
    }
    return texture;
}

Texture stripes(const StripeOptions& options) {
    demand(options.width > 0., "stripes: width must be positive");
    const double period = 2. * options.width;
    const unsigned count = texels(period, options.texel);
    Texture texture{ImageF(1, count), {period, period / count}};
    const double middle = 0.5 * (options.light + options.dark);
    const double half = 0.5 * (options.light - options.dark);
    for (unsigned i = 0; i < count; ++i) {
        const double x = (i + 0.5) * period / count - options.offset;
        texture.image[0][i] =
            static_cast<float>(middle + half * barSign(x, options.width, options.softEdge));
    }
    if (options.alongV) {
        ImageF column(count, 1);
        std::copy_n(texture.image.bitmap, count, column.bitmap);
        texture.image = column;
        std::swap(texture.size.x(), texture.size.y());
    }
    return texture;
}

Texture checker(const CheckerOptions& options) {
    demand(options.cell > 0., "checker: cell must be positive");
    const double period = 2. * options.cell;
    const unsigned count = texels(period, options.texel);
    Texture texture{ImageF(count, count), {period, period}};
    const double middle = 0.5 * (options.light + options.dark);
    const double half = 0.5 * (options.light - options.dark);
    for (unsigned v = 0; v < count; ++v) {
        const double y = barSign((v + 0.5) * period / count, options.cell, options.softEdge);
        for (unsigned u = 0; u < count; ++u) {
            const double x = barSign((u + 0.5) * period / count, options.cell, options.softEdge);
            texture.image[v][u] = static_cast<float>(middle - half * x * y);
        }
    }
    return texture;
}

Texture imageTexture(const std::string& file, double width) {
    demand(width > 0., "image: width must be positive");
    ImageF image = readGrey(file);
    const double texel = width / image.getWidth();
    const double height = texel * image.getHeight();
    return {std::move(image), {width, height}};
}

Texture patchedTexture(const Texture& base, const std::vector<Patch>& patches,
                       const Eigen::Vector2d& size, double texel) {
    const unsigned columns = texels(size.x(), texel);
    const unsigned rows = texels(size.y(), texel);
    Texture result{ImageF(rows, columns), size};
    const Eigen::Vector2d pitch(size.x() / columns, size.y() / rows);
    const auto covered = [](double low, double high, double texelLow, double width) {
        return std::clamp((std::min(high, texelLow + width) - std::max(low, texelLow)) / width, 0.,
                          1.);
    };
    for (unsigned v = 0; v < rows; ++v) {
        for (unsigned u = 0; u < columns; ++u) {
            const Eigen::Vector2d corner(u * pitch.x(), v * pitch.y());
            const Eigen::Vector2d centre = corner + 0.5 * pitch;
            float grey = base.at(centre);
            for (const Patch& patch : patches) {
                const auto coverage = static_cast<float>(
                    covered(patch.min.x(), patch.max.x(), corner.x(), pitch.x()) *
                    covered(patch.min.y(), patch.max.y(), corner.y(), pitch.y()));
                if (coverage > 0.F) grey += (patch.texture->at(centre) - grey) * coverage;
            }
            result.image[v][u] = grey;
        }
    }
    return result;
}

double decodeSrgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double greyOfLinear(const std::array<double, 3>& rgb) {
    return encodeSrgb(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
}

ImageF readGrey(const std::string& file, const std::array<double, 3>& factor) {
    return decodeGrey(readBytes(file), file, factor);
}

ImageF decodeGrey(std::span<const std::uint8_t> encoded, const std::string& name,
                  const std::array<double, 3>& factor) {
    const auto bounded = [&](const ImageSize& size) {
        if (static_cast<double>(size.width) * static_cast<double>(size.height) <= kMostTexels) {
            return true;
        }
        throw InputError(name, "",
                         fmt::format("{}x{} pixels: textures have at most {:.0f} million",
                                     size.width, size.height, 1e-6 * kMostTexels));
    };
    const cv::Mat image = decodedImage(encoded, cv::IMREAD_UNCHANGED, bounded);
    if (image.empty()) throw InputError(name, "", "not an image, or damaged");
    return greyOf(image, factor);
}

}  // namespace photonav
