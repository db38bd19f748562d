// SPDX-License-Identifier: BSD-3-Clause
// Every writer, while one call after the other that brings files to the disk fails.
#include <dlfcn.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>

#include "dataset/sequence_tum.hpp"
#include "drawing/flightlog/sample_log.hpp"
#include "exploration/trial_journal.hpp"
#include "explorations/flight_watch.hpp"
#include "flight/flight_recorder.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "map/octree_file.hpp"
#include "map/surface_cloud.hpp"
#include "shared/result_folder.hpp"
#include "sweep/reference_table.hpp"
#include "sweep/sweep_journal.hpp"
#include "temporary_folder.hpp"

namespace {

/// Which calls of this thread fail, and how.
struct FailingCalls {
    long left = -1;           // until the one that fails; below 0: none does
    bool isDiskFull = false;  // all calls fail from that one on, which writes a half; else it alone
    bool hasFailed = false;
};
thread_local FailingCalls failing;

/// Whether this call is to fail; errno then says why.
bool isFailing() {
    if (failing.left < 0) return false;
    if (failing.left > 0) {
        --failing.left;
        return false;
    }
    if (!failing.isDiskFull) failing.left = -1;
    failing.hasFailed = true;
    errno = failing.isDiskFull ? ENOSPC : EIO;
    return true;
}

/// Bytes that a call which is to fail still writes: half of them, the first time a disk is full.
std::size_t lastBytes(std::size_t size) {
    static thread_local bool wasFull = false;
    const bool isFirst = failing.isDiskFull && !wasFull;
    wasFull = failing.isDiskFull;
    return isFirst ? size / 2 : 0;
}

template <typename... Arguments>
long callSystem(long number, Arguments... arguments) {
    return isFailing() ? -1 : syscall(number, arguments...);
}

}  // namespace

// In place of those of the C library, also for what the C++ library calls.
// Exported, so that they take the place of the C library's also for other libraries.
#pragma GCC visibility push(default)
extern "C" {
ssize_t write(int file, const void* data, std::size_t size) {
    if (!isFailing()) return syscall(SYS_write, file, data, size);
    const std::size_t half = lastBytes(size);
    return half > 0 ? syscall(SYS_write, file, data, half) : -1;
}
ssize_t writev(int file, const iovec* parts, int count) {
    return callSystem(SYS_writev, file, parts, count);
}
ssize_t pwrite(int file, const void* data, std::size_t size, off_t offset) {
    if (!isFailing()) return syscall(SYS_pwrite64, file, data, size, offset);
    const std::size_t half = lastBytes(size);
    return half > 0 ? syscall(SYS_pwrite64, file, data, half, offset) : -1;
}
int ftruncate(int file, off_t size) noexcept {
    return static_cast<int>(callSystem(SYS_ftruncate, file, size));
}
int truncate(const char* path, off_t size) noexcept {
    return static_cast<int>(callSystem(SYS_truncate, path, size));
}
int fsync(int file) { return static_cast<int>(callSystem(SYS_fsync, file)); }
int rename(const char* from, const char* to) noexcept {
    return static_cast<int>(callSystem(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}
int renameat2(int fromFolder, const char* from, int toFolder, const char* to,
              unsigned flags) noexcept {
    return static_cast<int>(callSystem(SYS_renameat2, fromFolder, from, toFolder, to, flags));
}
int mkdir(const char* path, mode_t mode) noexcept {
    return static_cast<int>(callSystem(SYS_mkdirat, AT_FDCWD, path, mode));
}
int fclose(std::FILE* stream) {
    static const auto close =
        reinterpret_cast<int (*)(std::FILE*)>(dlsym(RTLD_NEXT, "fclose"));  // NOLINT
    const bool fails = isFailing();  // as network file systems do, which write only now
    const int reason = errno;
    const int result = close(stream);
    if (!fails) return result;
    errno = reason;
    return EOF;
}
}
#pragma GCC visibility pop

namespace photonav {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// What a piece of work answers while calls fail from the n-th on, counted from 0.
struct WriteAnswer {
    bool hasFailed;     ///< there were as many calls
    std::string error;  ///< empty: none
};

WriteAnswer whileWritingFails(long n, bool isDiskFull, const std::function<void()>& work) {
    failing = {n, isDiskFull, false};
    std::string error;
    try {
        work();
    } catch (const InputError& e) {
        error = e.what();
    }
    const bool hasFailed = failing.hasFailed;
    failing = {};
    return {hasFailed, error};
}

/// Lets the calls of a writer fail in turn: one (EIO), and from one on all (ENOSPC). Where it
/// reports an error, that is one line which names the target.
/// @param prepare makes what is there before; not disturbed
/// @param check what is there afterwards, given whether the writer has reported an error
void failInTurn(const std::string& target, const std::function<void()>& prepare,
                const std::function<void()>& write,
                const std::function<void(bool hasError, const std::string& when)>& check) {
    for (const bool isDiskFull : {false, true}) {
        long n = 0;
        for (bool hasFailed = true; hasFailed; ++n) {
            prepare();
            const WriteAnswer answer = whileWritingFails(n, isDiskFull, write);
            hasFailed = answer.hasFailed;
            const std::string when =
                std::string(isDiskFull ? "full from" : "failing") + " call " + std::to_string(n);
            if (!answer.error.empty()) {
                EXPECT_NE(answer.error.find(target), std::string::npos) << when << answer.error;
                EXPECT_EQ(answer.error.find('\n'), std::string::npos) << when << answer.error;
            }
            EXPECT_TRUE(hasFailed || answer.error.empty()) << when << answer.error;
            check(!answer.error.empty(), when);
        }
        EXPECT_GT(n, 1) << target;  // or nothing was disturbed
    }
}

std::size_t filesIn(const fs::path& folder) {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

/// A writer of one file: it holds the earlier content after an error, else the new one, and
/// nothing is left beside it.
void expectFileOldOrNew(const std::function<void(const std::string& file)>& write) {
    const TemporaryFolder folder;
    write(folder.file("new"));
    const std::string whole = test::contentOf(folder.file("new"));
    fs::remove(folder.file("new"));
    const std::string file = folder.file("file");
    failInTurn(
        file, [&] { folder.write("file", "old"); }, [&] { write(file); },
        [&](bool hasError, const std::string& when) {
            EXPECT_EQ(test::contentOf(file), hasError ? "old" : whole) << when;
            EXPECT_EQ(filesIn(folder.path()), 1U) << when;
        });
}

TexturedOcTree smallMap() {
    TexturedOcTree map(0.1);
    for (int i = 0; i < 40; ++i) {
        const float x = 0.05F + 0.1F * static_cast<float>(i);
        map.updateNode(octomap::point3d(x, 0.05F, 0.05F), true)->faces[5] = {0.4F, 1.F};
    }
    return map;
}

TEST(FailingWrites, OfFiles) {
    expectFileOldOrNew([](const std::string& file) { writeFileAtomically(file, "new"); });
    const std::string large(100000, 'x');
    expectFileOldOrNew([&](const std::string& file) { writeFileAtomically(file, large); });
    expectFileOldOrNew([](const std::string& file) {
        writeFileAtomically(file, [](std::ostream& stream) {
            for (int i = 0; i < 9; ++i) stream << std::string(3000, 'a') << std::flush;
        });
    });
}

TEST(FailingWrites, OfMaps) {
    const TexturedOcTree map = smallMap();
    expectFileOldOrNew([&](const std::string& file) { saveTexturedOcTree(map, file); });
    expectFileOldOrNew([&](const std::string& file) { saveColorOcTree(map, file); });
    expectFileOldOrNew([&](const std::string& file) { saveBinaryOcTree(map, file); });
    expectFileOldOrNew([&](const std::string& file) { saveSurfaceCloud(map, file); });
}

void writeNumbered(const fs::path& target, const std::string& number) {
    FolderTransaction folder = beginResult(target, InputPaths{});
    fs::create_directories(folder.path() / "images");
    writeFileAtomically(folder.path() / "images" / "view.png", number);
    commitResult(folder, {{"number", number}});
}

/// The folder holds the earlier result or the new one, file for file, and the next result takes its
/// place as if nothing had been.
TEST(FailingWrites, OfResults) {
    const TemporaryFolder folder;
    const fs::path target = folder.path() / "result";
    failInTurn(
        target.string(), [&] { writeNumbered(target, "old"); },
        [&] {
            try {
                writeNumbered(target, "new");
            } catch (const fs::filesystem_error& error) {  // the command line names its path
                throw InputError(error.path1().string(), "", error.code().message());
            }
        },
        [&](bool hasError, const std::string& when) {
            const std::string view = test::contentOf(target / "images" / "view.png");
            EXPECT_TRUE(view == "new" || (hasError && view == "old")) << when << view;
            EXPECT_NE(test::contentOf(target / "result.json").find('"' + view + '"'),
                      std::string::npos)
                << when;
            EXPECT_FALSE(Manifest::read(target).foreignFile(target)) << when;
            writeNumbered(target, "next");
            EXPECT_EQ(filesIn(folder.path()), 1U) << when;
        });
}

SweepRun runOf(std::uint32_t seed) {
    return {{"rrt_star", 0.5, seed},
            1.,
            2.,
            3.,
            4.,
            5,
            6,
            7.,
            "done",
            {{Eigen::Vector3d(1., 2., 3.), 0.}, {Eigen::Vector3d(3., 2., 3.), 0.}}};
}

/// A line that was written, but could neither be brought to the disk nor be removed again, as where
/// every call fails from then on, is whole: it counts.
void expectAllButTheLast(std::size_t runs, bool hasError, const std::string& when) {
    if (hasError && when.starts_with("full")) {
        EXPECT_GE(runs, 1U) << when;
        EXPECT_LE(runs, 2U) << when;
    } else {
        EXPECT_EQ(runs, hasError ? 1U : 2U) << when;
    }
}

/// A run that could not be written is missing, those before it are there, and the next one can be.
TEST(FailingWrites, OfRunsOfASweep) {
    const TemporaryFolder folder;
    std::optional<SweepJournal> journal;
    failInTurn(
        folder.file(SweepJournal::kFileName),
        [&] {
            journal = SweepJournal::create(folder.path(), {"name", "config", {}, {1, 1}});
            journal->append(runOf(1));
        },
        [&] { journal->append(runOf(2)); },
        [&](bool hasError, const std::string& when) {
            journal.reset();
            SweepJournal read = SweepJournal::read(folder.path());
            expectAllButTheLast(read.runs().size(), hasError, when);
            read.append(runOf(3));
            EXPECT_EQ(SweepJournal::read(folder.path()).runs().back().item.seed, 3U) << when;
        });
}

ExplorationResult flightOf(std::uint32_t seed) {
    ExplorationResult flight;
    flight.planner = "rrt_star";
    flight.seed = seed;
    flight.end = FlightEnd::noWay;
    flight.samples.emplace_back();
    return flight;
}

/// So is a flight of an exploration, and the map of the first one, which is a file of its own.
TEST(FailingWrites, OfFlightsOfAnExploration) {
    const TemporaryFolder folder;
    std::optional<TrialJournal> journal;
    failInTurn(
        folder.path().string(),
        [&] {
            fs::remove(folder.file(TrialKind::kMapFile));
            journal = TrialJournal::create(folder.path(), {"name", "config", {}, {1, 1}});
            journal->append(flightOf(2));
        },
        [&] {
            ExplorationResult first = flightOf(1);
            first.map = std::make_shared<TexturedOcTree>(smallMap());
            journal->append(std::move(first));
        },
        [&](bool hasError, const std::string& when) {
            journal.reset();
            TrialJournal read = TrialJournal::read(folder.path());
            expectAllButTheLast(read.runs().size(), hasError, when);
            if (!hasError) {
                EXPECT_TRUE(read.runs()[1].map) << when;
            }
            read.append(flightOf(3));
            EXPECT_EQ(TrialJournal::read(folder.path()).runs().back().seed, 3U) << when;
        });
}

TEST(FailingWrites, OfFlightLogs) {
    const FlightLog log = test::sampleLog();
    const TemporaryFolder folder;
    failInTurn(
        folder.path().string(), [&] { folder.write(FlightLog::kFileName, "old"); },
        [&] { writeFlightLog(folder.path(), log); },
        [&](bool hasError, const std::string& when) {
            const std::string file = folder.file(FlightLog::kFileName);
            if (hasError) {
                EXPECT_EQ(test::contentOf(file), "old") << when;
            } else {
                EXPECT_EQ(readFlightLog(file).moments.size(), log.moments.size()) << when;
            }
        });
}

/// The table can be read, with the paths of its rows, although it is two files.
TEST(FailingWrites, OfReferenceTables) {
    const TemporaryFolder folder;
    const std::string file = folder.file("table.csv");
    const auto path = [](double alpha) {
        return ReferencePath{.alpha = alpha,
                             .cost = 1.,
                             .planner = "rrt_star",
                             .waypoints = {Pose::Identity(), Pose::Identity()}};
    };
    failInTurn(
        folder.path().string(),
        [&] {
            fs::remove(file);
            fs::remove(folder.file("table_paths.csv"));
            ReferenceTable table(file);
            table.offer(path(0.5));
            table.write();
        },
        [&] {
            ReferenceTable table(file);
            table.read();
            table.offer(path(0.2));
            table.write();
        },
        [&](bool hasError, const std::string& when) {
            ReferenceTable table(file);
            ASSERT_NO_THROW(table.read()) << when;
            // The new table may be in place already when its folder cannot be synchronised.
            EXPECT_LE(table.alphas().size(), 2U) << when;
            if (!hasError) {
                EXPECT_EQ(table.alphas().size(), 2U) << when;
            }
            ASSERT_NE(table.at(0.5), nullptr) << when;
            EXPECT_EQ(table.at(0.5)->waypoints.size(), 2U) << when;
        });
}

/// A recording that could not be written whole has no tables, without which nothing reads it.
TEST(FailingWrites, OfRecordings) {
    const TemporaryFolder folder;
    const fs::path target = folder.path() / "recording";
    const Camera camera = makeCamera(16, 12, 1.);
    const Exposed exposed{0., Pose::Identity(), ImageF(12, 16, 0.5F), ImageF(12, 16, 1.F)};
    failInTurn(
        folder.path().string(), [&] { fs::remove_all(target); },
        [&] {
            FolderTransaction transaction(target);
            FlightRecorder recorder(transaction.path(), camera, 1., 0.);
            recorder.add(exposed);
            recorder.finish();
            transaction.commit();
        },
        [&](bool hasError, const std::string& when) {
            if (fs::exists(target)) {
                EXPECT_EQ(readTumSequence(target.string()).frames.size(), 1U) << when;
            } else {
                EXPECT_TRUE(hasError) << when;
            }
        });
}

}  // namespace
}  // namespace photonav
