// SPDX-License-Identifier: BSD-3-Clause
#include "io/reading.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <vector>

#include "temporary_folder.hpp"

namespace photonav {
namespace {

TEST(Reading, NamesTheFileWhateverIsThrown) {
    const auto complaint = [](auto read) {
        return test::messageOf<InputError>([&] { reading("a.ot", read); });
    };
    EXPECT_EQ(complaint([]() -> int { throw std::bad_alloc(); }),
              "a.ot: needs more memory than there is");
    EXPECT_EQ(complaint([]() -> int { throw std::out_of_range("no\nsuch node"); }),
              "a.ot: no\\nsuch node");
    EXPECT_EQ(complaint([]() -> int { throw InputError("b.png", "", "damaged"); }),
              "b.png: damaged");
    EXPECT_EQ(reading("a.ot", [] { return 3; }), 3);
    EXPECT_THROW(reading("a.ot", []() -> int { throw Interrupted(); }), Interrupted);
}

TEST(Reading, OpensFilesOnly) {
    const test::TemporaryFolder folder;
    const std::string pipe = folder.file("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    for (const std::string& file : {pipe, folder.path().string(), std::string("/dev/zero")}) {
        EXPECT_EQ(test::messageOf<InputError>([&] { openToRead(file); }), file + ": not a file");
    }
    const std::string missing = folder.file("missing");
    EXPECT_FALSE(openIfThere(missing).is_open());
    EXPECT_EQ(test::messageOf<InputError>([&] { openToRead(missing); }),
              missing + ": no such file");
    EXPECT_TRUE(openToRead(folder.write("there", "")).is_open());
}

TEST(Reading, SaysWhyAFileCannotBeFound) {
    const std::string file = "/tmp/" + std::string(300, 'a');
    EXPECT_EQ(test::messageOf<InputError>([&] { openToRead(file); }),
              file + ": cannot be opened: File name too long");
}

TEST(Reading, NamesFilesThatMayNotBeRead) {
    if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
    const test::TemporaryFolder folder;
    const auto expectRefused = [](const std::string& file) {
        EXPECT_EQ(test::messageOf<InputError>([&] { openToRead(file); }),
                  file + ": cannot be opened: Permission denied");
    };
    const std::string file = folder.write("a.txt", "1 2\n");
    ASSERT_EQ(chmod(file.c_str(), 0), 0);
    expectRefused(file);
    const std::string closed = folder.file("closed");
    ASSERT_EQ(mkdir(closed.c_str(), 0), 0);
    expectRefused(closed + "/a.txt");
    chmod(closed.c_str(), 0700);  // so that it can be removed
}

}  // namespace
}  // namespace photonav
