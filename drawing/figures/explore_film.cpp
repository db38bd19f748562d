// SPDX-License-Identifier: BSD-3-Clause
#include "figures/explore_film.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

#include "figures/flight_log_figures.hpp"
#include "io/error.hpp"

namespace photonav {
namespace {

constexpr double kRate = 12.;     // [frames/s]
constexpr double kSpeed = 2.;     // of the film, by the flight's
constexpr double kLongest = 40.;  // [s]
constexpr int kLastFrames = 12;

/// OpenCV reports on standard error that WebM has no tag of four characters for VP8, which it does
/// not need.
class QuietStandardError {
  public:
    QuietStandardError() : kept_(dup(STDERR_FILENO)) {
        const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        dup2(nowhere, STDERR_FILENO);
        close(nowhere);
    }
    QuietStandardError(const QuietStandardError&) = delete;
    QuietStandardError& operator=(const QuietStandardError&) = delete;
    ~QuietStandardError() {
        dup2(kept_, STDERR_FILENO);
        close(kept_);
    }

  private:
    int kept_;
};

/// Blue, green, red; white at the right and below, so that both sides are even.
cv::Mat frameOf(const Picture& picture) {
    const int rows = picture.rows() + picture.rows() % 2;
    const int columns = picture.columns + picture.columns % 2;
    cv::Mat frame(rows, columns, CV_8UC3, cv::Scalar::all(255));
    for (int v = 0; v < picture.rows(); ++v) {
        for (int u = 0; u < picture.columns; ++u) {
            const Color& color = picture.pixels[static_cast<std::size_t>(v) * picture.columns + u];
            frame.at<cv::Vec3b>(v, u) = {color.blue, color.green, color.red};
        }
    }
    return frame;
}

cv::VideoWriter openFilm(const std::filesystem::path& file, const cv::Size& size) {
    const QuietStandardError quiet;
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    cv::VideoWriter film(file.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('V', 'P', '8', '0'),
                         kRate, size);
    if (!film.isOpened()) {
        throw InputError(file.string(), "", "cannot be written as a film (WebM, VP8) by OpenCV");
    }
    return film;
}

double durationOf(const FlightLog& log) {
    const double last = log.rest.empty() ? 0. : log.rest.back().time;
    return std::max(log.moments.back().update.time, last);
}

}  // namespace

void writeFilm(const std::filesystem::path& file, const FlightLog& log, const TopView& scene,
               const std::atomic<bool>& interrupted,
               const std::function<void(double share)>& onFrame) {
    const double duration = durationOf(log);
    const double step = std::max(kSpeed, duration / kLongest) / kRate;
    const int frames = static_cast<int>(std::ceil(duration / step)) + 1;
    const FilmScript script(log, scene);
    std::size_t moment = 0;
    cv::VideoWriter film;
    for (int i = 0; i < frames + kLastFrames && !interrupted; ++i) {
        const double time = std::min(i * step, duration);
        while (moment + 1 < log.moments.size() && log.moments[moment + 1].update.time <= time) {
            ++moment;
        }
        const cv::Mat frame = frameOf(script.frame(time, moment).picture());
        if (!film.isOpened()) film = openFilm(file, frame.size());
        film.write(frame);
        if (onFrame) onFrame(std::min(1., (i + 1.) / frames));
    }
}

}  // namespace photonav
