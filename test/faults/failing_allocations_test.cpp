// SPDX-License-Identifier: BSD-3-Clause
// Every reader, and the writer of results, while one allocation after the other fails.
#include <gtest/gtest.h>
#include <omp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <new>
#include <opencv2/imgcodecs.hpp>

#include "bag_of_recording.hpp"
#include "check/given_trajectory.hpp"
#include "config/config.hpp"
#include "dataset/colmap_model.hpp"
#include "dataset/image_file.hpp"
#include "dataset/sequence_bag.hpp"
#include "dataset/sequence_tum.hpp"
#include "euroc_dataset.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "map/octree_file.hpp"
#include "map/point_cloud.hpp"
#include "posters/poster.hpp"
#include "replay/calibration_file.hpp"
#include "scene/scene.hpp"
#include "shared/result_folder.hpp"
#include "sweep/reference_table.hpp"
#include "tum_dataset.hpp"

namespace {

thread_local long allocationsLeft = -1;  // until the one that fails; below 0: none does

/// Not in a parallel region of OpenMP, which no exception may leave: OctoMap's constructor has one.
void* allocate(std::size_t size, std::size_t alignment) {
    const bool isCounted = allocationsLeft >= 0 && omp_get_level() == 0;
    if (isCounted && allocationsLeft-- == 0) throw std::bad_alloc();
    void* memory = nullptr;
    if (posix_memalign(&memory, alignment, size) == 0) return memory;
    throw std::bad_alloc();
}

}  // namespace

// The other forms call these.
void* operator new(std::size_t size) { return allocate(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace photonav {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// What a piece of work answers while its n-th allocation fails, counted from 0.
struct Answer {
    bool hasFailed;     ///< there were as many allocations
    bool isBare;        ///< the std::bad_alloc came out as it was
    std::string error;  ///< empty: none
    std::size_t result;
};

Answer whileFailing(long n, const std::function<std::size_t()>& work) {
    Answer answer{};
    allocationsLeft = n;
    try {
        answer.result = work();
        answer.hasFailed = std::exchange(allocationsLeft, -1) < 0;
    } catch (const InputError& error) {
        allocationsLeft = -1;
        answer.hasFailed = true;
        answer.error = error.what();
    } catch (const std::bad_alloc&) {
        allocationsLeft = -1;
        answer.hasFailed = answer.isBare = true;
    }
    return answer;
}

/// Fails the allocations of a reader in turn, of many every so often: it answers with one line that
/// names the file, or with the whole of it. (Copies of the file's name may fail before there is one
/// to report.)
/// @param read returns how much it has read
void expectAllOrOneLine(const std::string& file, const std::function<std::size_t()>& read) {
    const std::size_t whole = read();
    std::size_t errors = 0, bare = 0;
    for (long n = 0;; n += 1 + n / 50) {
        const Answer answer = whileFailing(n, read);
        if (!answer.hasFailed) break;
        if (answer.isBare) {
            ++bare;
        } else if (answer.error.empty()) {
            EXPECT_EQ(answer.result, whole) << file << ": allocation " << n;
        } else {
            ++errors;
            EXPECT_NE(answer.error.find(file), std::string::npos) << n << ": " << answer.error;
            EXPECT_EQ(answer.error.find('\n'), std::string::npos) << n << ": " << answer.error;
        }
    }
    EXPECT_GT(errors, 3U) << file;
    EXPECT_LE(bare, 2U) << file;
}

TEST(FailingAllocations, OfReadersOfProblems) {
    const TemporaryFolder folder;
    const std::string scene =
        folder.write("scene.yaml",
                     "textures: [{name: a, type: noise, size: [1, 1], cells: [0.5], texel: 0.1}]\n"
                     "planes: [{corner: [0, 0, 0], u: [9, 0, 0], v: [0, 9, 0], texture: a}]\n");
    expectAllOrOneLine(scene, [&] { return loadScene(scene).triangles.size(); });
    const std::string config =
        folder.write("config.yaml",
                     "scene: {file: scene.yaml}\nbounds: [[0, 0, 2], [9, 9, 2]]\nstart: [0, 0, 2]\n"
                     "goal: [2, 9, 2]\nsweep: {alphas: [0.1, 0.5]}\n");
    expectAllOrOneLine(config, [&] { return loadConfig(config, {}).sweep.alphas.size(); });
    const std::string obj = folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expectAllOrOneLine(obj, [&] { return loadScene(obj).triangles.size(); });
    const std::string posters =
        folder.write("posters.yaml",
                     "candidates: [{name: a, textures: [{name: t}], "
                     "planes: [{corner: [0, 0, 1], u: [1, 0, 0], v: [0, 1, 0], texture: t}]}]\n");
    expectAllOrOneLine(posters, [&] { return readPosters(posters).size(); });
}

TEST(FailingAllocations, OfReadersOfMaps) {
    const TemporaryFolder folder;
    TexturedOcTree map(0.1);
    for (int i = 0; i < 40; ++i) {
        const float x = 0.05F + 0.1F * static_cast<float>(i);
        map.updateNode(octomap::point3d(x, 0.05F, 0.05F), true)->faces[5] = {0.4F, 1.F};
    }
    saveTexturedOcTree(map, folder.file("map.ot"));
    saveColorOcTree(map, folder.file("color.ot"));
    saveBinaryOcTree(map, folder.file("map.bt"));
    for (const char* name : {"map.ot", "color.ot", "map.bt"}) {
        const std::string file = folder.file(name);
        expectAllOrOneLine(file, [&] { return loadTexturedOcTree(file)->size(); });
    }
    const std::string cloud = folder.write(
        "cloud.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty float intensity\nend_header\n"
        "1 2 3 0.5\n1 2 3.00000000000000000000000001 0.5\n1 2 3.00000000000000000000000001 0.5\n");
    expectAllOrOneLine(cloud, [&] {
        std::size_t points = 0;
        PointCloudFile(cloud).read([&](const ScanPoint&) { ++points; });
        return points;
    });
}

TEST(FailingAllocations, OfReadersOfRecordings) {
    const TemporaryFolder folder;
    const std::string tum = folder.file("tum");
    test::FloorDataset().write(tum);
    for (const bool forgiving : {false, true}) {
        expectAllOrOneLine(
            tum, [&] { return readTumSequence(tum, {.forgiving = forgiving}).frames.size(); });
    }
    const std::string euroc = folder.file("euroc");
    test::WallDataset().write(euroc);
    expectAllOrOneLine(euroc, [&] { return readEurocSequence(euroc).frames.size(); });
    const std::string bag = folder.file("flight.bag");
    test::writeBag(bag, tum);
    expectAllOrOneLine(bag, [&] {
        const BagSequence sequence = readBagSequence(bag, {.depthScale = 5000.});
        return sequence.sequence.frames.size() + sequence.view(0).intensity.getSize();
    });
    const std::string colmap = folder.file("colmap");
    fs::create_directory(colmap);
    writeColmapModel(colmap, makeCamera(188, 120, 1.2),
                     {{"0.png", Pose::Identity()}, {"1.png", Pose::Identity()}});
    expectAllOrOneLine(colmap, [&] { return readColmapSequence(colmap).frames.size(); });
}

TEST(FailingAllocations, OfReadersOfImages) {
    const TemporaryFolder folder;
    const Camera camera = makeCamera(8, 6, 1.2);
    const std::string grey = folder.file("grey.png"), depth = folder.file("depth.png");
    cv::imwrite(grey, cv::Mat(6, 8, CV_8U, cv::Scalar(7)));
    cv::imwrite(depth, cv::Mat(6, 8, CV_16U, cv::Scalar(7)));
    expectAllOrOneLine(grey, [&] { return readGrey8(grey, camera, "camera").getSize(); });
    expectAllOrOneLine(depth, [&] { return readDepth16(depth, camera, "camera", 1e-3).getSize(); });
}

TEST(FailingAllocations, OfReadersOfTrajectories) {
    const TemporaryFolder folder;
    const std::string table = folder.write("table.csv", "t,x,y,z,yaw\n0,1,2,3,0\n1,2,3,4,0.5\n");
    const std::string tum = folder.write("poses.tum", "0 1 2 3 0 0 0 1\n1 2 3 4 0 0 0 1\n");
    for (const std::string& file : {table, tum}) {
        expectAllOrOneLine(
            file, [&] { return readGivenTrajectory(file, Pose::Identity()).poses.size(); });
    }
}

/// But JSON: nlohmann's destructor allocates, and may not throw.
TEST(FailingAllocations, OfReadersOfResults) {
    const TemporaryFolder folder;
    const std::string calibration = folder.write(
        "calibration.yaml", "mode: mesh\nscale: 0.5\nleast_sigma: 0\nleast_sigma_rotation: 0\n");
    expectAllOrOneLine(calibration,
                       [&] { return readCalibration(calibration, MapKind::mesh).scale == 0.5; });
    const std::string table =
        std::string(PHOTONAV_SOURCE_DIR) + "/config/reference/two_textures.csv";
    ReferenceTable reference(table);
    expectAllOrOneLine(table.substr(0, table.size() - 4), [&] {
        reference.read();
        return reference.alphas().size();
    });
}

/// The folder holds the earlier result or the new one.
void expectOldOrNew(const fs::path& target, const std::string& what) {
    const std::string content = test::contentOf(target / "result.json");
    EXPECT_TRUE(content == "old" || content == "new") << what << ": " << content;
    EXPECT_FALSE(Manifest::read(target).foreignFile(target)) << what;
}

std::size_t writeResult(const fs::path& target, const char* text) {
    FolderTransaction folder = beginResult(target, InputPaths{});
    writeFileAtomically(folder.path() / "result.json", text);
    folder.commit();
    return 1;
}

/// In a process of its own: directory iterators of libstdc++ end it when they get no memory.
bool failsWhileFailing(long n, const fs::path& target) {
    const pid_t child = fork();
    if (child == 0) {
        static_cast<void>(!std::freopen("/dev/null", "w", stderr));
        const Answer answer = whileFailing(n, [&] { return writeResult(target, "new"); });
        std::_Exit(answer.hasFailed ? 1 : 0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status != 0;
}

TEST(FailingAllocations, OfTheWriterOfResults) {
    const TemporaryFolder folder;
    const fs::path target = folder.path() / "result";
    bool hasFailed = true;
    for (long n = 0; hasFailed; ++n) {
        writeResult(target, "old");
        EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << n;
        hasFailed = failsWhileFailing(n, target);
        expectOldOrNew(target, std::to_string(n));
    }
}

}  // namespace
}  // namespace photonav
