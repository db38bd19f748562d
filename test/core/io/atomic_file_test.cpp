// SPDX-License-Identifier: BSD-3-Clause
#include "io/atomic_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "io/error.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
  protected:
    AtomicFile()
        : folder_(fs::temp_directory_path() / ("atomic_file_" + std::to_string(getpid()))) {
        fs::create_directories(folder_);
    }
    ~AtomicFile() override { fs::remove_all(folder_); }

    static std::string contentOf(const fs::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : fs::directory_iterator(folder_)) {
            found.push_back(entry.path().filename().string());
        }
        return found;
    }

    fs::path folder_;
};

TEST_F(AtomicFile, ReplacesAFileAndLeavesNothingElse) {
    writeFileAtomically(folder_ / "a", "old");
    writeFileAtomically(folder_ / "a", "new");
    EXPECT_EQ(contentOf(folder_ / "a"), "new");
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(AtomicFile, FollowsALinkAndKeepsIt) {
    writeFileAtomically(folder_ / "a", "old");
    fs::create_symlink("a", folder_ / "link");
    writeFileAtomically(folder_ / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(contentOf(folder_ / "a"), "new");
}

TEST_F(AtomicFile, ReplacesNeitherPipesNorFolders) {
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    fs::create_directory(folder_ / "folder");
    for (const char* name : {"pipe", "folder"}) {
        EXPECT_THROW(writeFileAtomically(folder_ / name, "new"), InputError) << name;
    }
    EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
    EXPECT_EQ(names().size(), 2U);
}

TEST_F(AtomicFile, AWriterThatThrowsLeavesTheOlderFileWhole) {
    writeFileAtomically(folder_ / "a", "old");
    const auto broken = [](std::ostream& stream) {
        stream << "half";
        throw std::runtime_error("stopped");
    };
    EXPECT_THROW(writeFileAtomically(folder_ / "a", broken), std::runtime_error);
    EXPECT_EQ(contentOf(folder_ / "a"), "old");
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(AtomicFile, AWriterInsideAWriterOfTheSameFileDisturbsNobody) {
    writeFileAtomically(folder_ / "a", [&](std::ostream& stream) {
        stream << "outer ";
        stream.flush();
        writeFileAtomically(folder_ / "a", "inner");
        EXPECT_EQ(contentOf(folder_ / "a"), "inner");
        stream << "again";
    });
    EXPECT_EQ(contentOf(folder_ / "a"), "outer again");
}

TEST_F(AtomicFile, FilesThatThreadsWriteAtTheSameTimeAreWhole) {
    const auto write = [&](char letter) {
        for (int i = 0; i < 50; ++i)
            writeFileAtomically(folder_ / "a", std::string(100000, letter));
    };
    std::thread other(write, 'b');
    write('c');
    other.join();
    const std::string content = contentOf(folder_ / "a");
    ASSERT_EQ(content.size(), 100000U);
    EXPECT_EQ(content, std::string(100000, content[0]));
    EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(AtomicFile, KnowsWhatAKilledWriterLeaves) {
    writeFileAtomically(folder_ / "a", [&](std::ostream&) {
        ASSERT_EQ(names().size(), 1U);
        EXPECT_TRUE(isTemporaryFile(names().front()));
    });
    for (const char* name : {"a", "a.tmp", "a.tmp-b", "a.tmp-1-2", "a.tmp-1-2-3-4", "tmp-1-2-3"}) {
        EXPECT_FALSE(isTemporaryFile(name)) << name;
    }
}

TEST_F(AtomicFile, AFolderThatDoesNotExistIsNamed) {
    EXPECT_THROW(writeFileAtomically(folder_ / "none" / "a", "x"), InputError);
}

}  // namespace
}  // namespace photonav
