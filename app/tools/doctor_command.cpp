// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ompl/config.h>
#include <unistd.h>
#include <visp3/core/vpConfig.h>

#include <Eigen/Core>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/core/version.hpp>
#include <sstream>
#include <thread>

#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "problem/planning_problem.hpp"
#include "shared/command_io.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

constexpr double kGigabyte = 1024. * 1024. * 1024.;
constexpr double kLeastMemory = 2. * kGigabyte;

void print(const char* state, const std::string& what, const std::string& value) {
    fmt::print("{:<9} {:<22} {}\n", state, what, value);
}

/// Whether the processor has the instructions that the program was built for.
bool checkProcessor() {
#if defined(__AVX512F__)
    const bool isEnough = __builtin_cpu_supports("avx512f") != 0;
    const char* built = "AVX-512";
#elif defined(__AVX2__)
    const bool isEnough = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
    const char* built = "AVX2";
#else
    const bool isEnough = true;
    const char* built = "no vector extension";
#endif
    print(isEnough ? "ok" : "missing", "processor",
          fmt::format("built for {}, {} threads", built, std::thread::hardware_concurrency()));
    return isEnough;
}

void checkMemory() {
    const double bytes =
        static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
    print(bytes >= kLeastMemory ? "ok" : "little", "memory",
          fmt::format("{:.1f} GB", bytes / kGigabyte));
}

void printLibraries() {
    print("ok", "photonav", PHOTONAV_VERSION);
    print("ok", "ViSP",
          fmt::format("{}.{}.{}", VISP_VERSION_MAJOR, VISP_VERSION_MINOR, VISP_VERSION_PATCH));
    print("ok", "OpenCV", CV_VERSION);
    print("ok", "OMPL",
          fmt::format("{}.{}.{}", OMPL_MAJOR_VERSION, OMPL_MINOR_VERSION, OMPL_PATCH_VERSION));
    print("ok", "Eigen",
          fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION));
}

/// The first program of this name on the path; empty: none.
fs::path programOf(const std::string& name) {
    const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path file = fs::path(folder) / name;
        if (access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file)) return file;
    }
    return {};
}

void checkProgram(const std::vector<std::string>& names, const std::string& use) {
    for (const std::string& name : names) {
        const fs::path file = programOf(name);
        if (!file.empty()) return print("ok", use, file.string());
    }
    print("optional", use,
          names.size() == 1 ? names.front() + " is not installed"
                            : fmt::format("none of {} is installed", fmt::join(names, ", ")));
}

void checkDisplay() {
    const bool has = std::getenv("DISPLAY") != nullptr ||        // NOLINT(concurrency-mt-unsafe)
                     std::getenv("WAYLAND_DISPLAY") != nullptr;  // NOLINT(concurrency-mt-unsafe)
    print(has ? "ok" : "optional", "display", has ? "there is one" : "none; reports are files");
}

/// Half of a floor textured, as in the paper's first scenario.
constexpr const char* kScene = R"(
textures:
  - {name: white, type: uniform, grey: 0.9}
  - {name: noise, type: noise, size: [4, 8], cells: [0.6, 0.3, 0.15], amplitudes: [0.2, 0.14, 0.08]}
planes:
  - {corner: [-4, -4, 0], u: [8, 0, 0], v: [0, 16, 0], texture: white}
  - {corner: [4, -4, 0], u: [8, 0, 0], v: [0, 16, 0], texture: noise}
)";
constexpr const char* kConfig = R"(
scene: {file: scene.yaml}
bounds: [[-1, 0, 2], [7, 8, 2]]
start: [1, 0, 2]
goal: [2, 8, 2]
camera: {information_scale: 0.08}
noise: {motion: [1e-3, 1e-3, 1e-3, 4.5e-6, 4.5e-6, 1.35e-4]}
planner: {vertices: 300, alpha: 0.1, view_pitch: 0.25}
)";

/// A folder that is removed at the end.
class Scratch {
  public:
    Scratch() : path_(fs::temp_directory_path() / fmt::format("photonav-doctor-{}", getpid())) {
        std::error_code error;
        fs::create_directories(path_, error);
        if (error) throw InputError("TMPDIR", path_.string(), error.message());
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    ~Scratch() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    std::string file(const char* name) const { return (path_ / name).string(); }

  private:
    fs::path path_;
};

/// Plans a problem in which a detour over texture is worth it.
bool checkSample() {
    const Stopwatch watch;
    std::string reason;
    try {
        const Scratch scratch;
        std::ofstream(scratch.file("scene.yaml")) << kScene;
        const Config config = parseConfig(kConfig, scratch.file("config.yaml"));
        const World world(config);
        PlanningProblem problem(config, world);
        const PlanOutcome ours = problem.solve("belief_rrt_star");
        const PlanOutcome shortest = problem.solve("rrt_star");
        if (!ours.isSolved() || !shortest.isSolved()) {
            reason = "no path found";
        } else if (!(ours.path->cost < shortest.path->cost)) {
            reason = "the plan costs more than the shortest path";
        }
    } catch (const std::exception& error) {
        reason = error.what();
    }
    print(reason.empty() ? "ok" : "failed", "sample plan",
          reason.empty() ? fmt::format("{:.1f} s", watch.seconds()) : reason);
    return reason.empty();
}

}  // namespace

int runDoctor() {
    printLibraries();
    const bool hasProcessor = checkProcessor();
    checkMemory();
    checkDisplay();
    checkProgram({"xdg-open", "chromium", "firefox"}, "opens reports");
    checkProgram({"octovis"}, "opens maps");
    checkProgram({"ompl_benchmark_statistics"}, "reads benchmarks");
    return hasProcessor && checkSample() ? kDone : kNoAnswer;
}

}  // namespace photonav
