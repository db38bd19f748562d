// SPDX-License-Identifier: BSD-3-Clause
// A folder is replaced as a whole or not at all, and only what was written before is replaced.
#include "io/folder_transaction.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

#include "io/error.hpp"
#include "reason_of.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::reasonOf;
using test::TemporaryFolder;
using Unfinished = FolderTransaction::Unfinished;

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

void commit(const fs::path& folder, const std::string& file, const std::string& text) {
    FolderTransaction transaction(folder);
    write(transaction.path() / file, text);
    transaction.commit();
}

std::string complaint(const fs::path& folder) {
    try {
        const FolderTransaction transaction(folder);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::size_t entries(const fs::path& folder) {
    return std::distance(fs::directory_iterator(folder), {});
}

class FolderTransactionTest : public testing::Test {
  protected:
    const TemporaryFolder temporary_;
    const fs::path target_ = temporary_.path() / "target";
};

TEST_F(FolderTransactionTest, ReplacesTheFolderAsAWhole) {
    commit(target_, "old.txt", "old");
    FolderTransaction transaction(target_);
    write(transaction.path() / "sub/new.txt", "new");
    EXPECT_EQ(contentOf(target_ / "old.txt"), "old");  // until it is committed
    transaction.commit();
    EXPECT_FALSE(fs::exists(target_ / "old.txt"));
    EXPECT_EQ(contentOf(target_ / "sub/new.txt"), "new");
    EXPECT_EQ(entries(temporary_.path()), 1U);
}

TEST_F(FolderTransactionTest, LeavesNothingBehindWhenItIsNotCommitted) {
    commit(target_, "old.txt", "old");
    {
        const FolderTransaction transaction(target_);
        write(transaction.path() / "new.txt", "new");
    }
    EXPECT_EQ(contentOf(target_ / "old.txt"), "old");
    EXPECT_EQ(entries(temporary_.path()), 1U);
}

TEST_F(FolderTransactionTest, RefusesFilesThatItDidNotWrite) {
    write(target_ / "notes.txt", "mine");
    EXPECT_NE(complaint(target_).find(
                  "target/notes.txt: is not of an earlier result, or was changed since"),
              std::string::npos);
    EXPECT_EQ(contentOf(target_ / "notes.txt"), "mine");
    fs::remove(target_ / "notes.txt");
    EXPECT_EQ(complaint(target_), "");  // empty
    commit(target_, "config.yaml", "a: 1");
    EXPECT_EQ(complaint(target_), "");
    write(target_ / "config.yaml", "a: 2");  // edited
    EXPECT_NE(complaint(target_), "");
}

TEST_F(FolderTransactionTest, RefusesEmptyFoldersThatItDidNotMake) {
    const auto isRefused = [&] {
        return complaint(target_).find("target/mine: is not of an earlier result") !=
               std::string::npos;
    };
    fs::create_directories(target_ / "mine");
    EXPECT_TRUE(isRefused()) << complaint(target_);
    fs::remove(target_ / "mine");
    {
        FolderTransaction transaction(target_);
        write(transaction.path() / "images/1.png", "1");
        fs::create_directory(transaction.path() / "none");
        transaction.commit();
    }
    fs::create_directory(target_ / "mine");
    EXPECT_TRUE(isRefused()) << complaint(target_);
    fs::remove(target_ / "mine");
    fs::remove(target_ / "images/1.png");  // its folder is still one of the result
    EXPECT_EQ(complaint(target_), "");
    commit(target_, "new.txt", "new");
    EXPECT_EQ(entries(target_), 2U);
    EXPECT_EQ(entries(temporary_.path()), 1U);
}

TEST_F(FolderTransactionTest, PathsThatAreTooLongAreNamedAndNothingIsMade) {
    for (const std::size_t length : {250U, 300U}) {  // with .unfinished, and as it is
        const fs::path folder = temporary_.path() / std::string(length, 'a');
        EXPECT_TRUE(complaint(folder).starts_with(folder.string())) << complaint(folder);
        EXPECT_TRUE(complaint(folder).ends_with(": File name too long")) << complaint(folder);
    }
    std::string deep = temporary_.path().string();
    while (deep.size() < 4078) deep += "/a";
    EXPECT_TRUE(complaint(deep).ends_with(": File name too long")) << complaint(deep);
    EXPECT_EQ(entries(temporary_.path()), 0U);
}

/// The lock takes the last descriptor, or finds none.
TEST_F(FolderTransactionTest, LeavesNothingWhereTooManyFilesAreOpen) {
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    const int next = dup(STDIN_FILENO);
    ASSERT_GE(next, 0);
    close(next);
    for (const int more : {0, 1}) {
        rlimit few = before;
        few.rlim_cur = static_cast<rlim_t>(next + more);
        ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
        const std::string reason = complaint(target_);
        ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
        EXPECT_NE(reason.find("Too many open files"), std::string::npos) << reason;
        EXPECT_EQ(entries(temporary_.path()), 0) << more;
    }
    commit(target_, "new.txt", "new");
    EXPECT_EQ(contentOf(target_ / "new.txt"), "new");
}

TEST_F(FolderTransactionTest, NamesFoldersBesideWhichNothingMayBeWritten) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    commit(target_, "old.txt", "old");
    for (const fs::perms allowed : {fs::perms(0555), fs::perms(0)}) {
        fs::permissions(temporary_.path(), allowed);
        for (const fs::path& folder : {target_, temporary_.path() / "new/one"}) {
            EXPECT_TRUE(complaint(folder).starts_with(folder.string() + ": "));
            EXPECT_TRUE(complaint(folder).ends_with("Permission denied")) << complaint(folder);
        }
    }
    fs::permissions(temporary_.path(), fs::perms(0755));
    EXPECT_EQ(contentOf(target_ / "old.txt"), "old");
    EXPECT_EQ(entries(temporary_.path()), 1U);
}

TEST_F(FolderTransactionTest, KeepsTheResultWhenSomeoneWroteIntoTheFolderMeanwhile) {
    commit(target_, "old.txt", "old");
    FolderTransaction transaction(target_);
    write(transaction.path() / "new.txt", "new");
    write(target_ / "notes.txt", "mine");
    EXPECT_THROW(transaction.commit(), InputError);
    EXPECT_EQ(contentOf(target_ / "notes.txt"), "mine");
    EXPECT_EQ(contentOf(transaction.path() / "new.txt"), "new");
}

TEST_F(FolderTransactionTest, SaysWhereAResultIsThatCouldNotTakeItsPlace) {
    FolderTransaction transaction(target_);
    write(transaction.path() / "new.txt", "new");
    write(target_ / "notes.txt", "mine");
    const std::string reason = reasonOf([&] { transaction.commit(); });
    for (const char* part : {"target/notes.txt: is not of an earlier result", "the result is in ",
                             "target.unfinished until the next run"}) {
        EXPECT_NE(reason.find(part), std::string::npos) << reason;
    }
}

TEST_F(FolderTransactionTest, RefusesToReplaceAResultWithAnotherOneInIt) {
    commit(target_, "old.txt", "old");
    commit(target_ / "sub/inner", "inner.txt", "inner");
    EXPECT_NE(complaint(target_).find("target/sub/inner: is a result within the one to replace"),
              std::string::npos)
        << complaint(target_);
    EXPECT_EQ(contentOf(target_ / "sub/inner/inner.txt"), "inner");
    EXPECT_EQ(complaint(target_ / "sub/inner"), "");
    fs::rename(target_ / "sub/inner", temporary_.path() / "inner");
    fs::remove(target_ / "sub");
    EXPECT_EQ(complaint(target_), "");
}

TEST_F(FolderTransactionTest, TakesUpWhatWasWrittenAgain) {
    commit(target_, "report.html", "one");
    write(target_ / "report.html", "two");
    Manifest::renew(target_, "report.html");
    EXPECT_EQ(complaint(target_), "");
}

TEST_F(FolderTransactionTest, OneProcessWritesAFolderAtATime) {
    const FolderTransaction first(target_);
    EXPECT_NE(complaint(target_).find("another photonav is writing it"), std::string::npos);
    EXPECT_TRUE(fs::exists(first.path()));
}

/// An earlier result is removed after the exchange, at the place where the next one begins.
TEST_F(FolderTransactionTest, ManyAtOnceAreWholeOrRefused) {
    const auto writeAgain = [&](int writer) {
        for (int round = 0; round < 100; ++round) {
            try {
                commit(target_, fmt::format("{}/{}.txt", writer, round), "text");
            } catch (const InputError& error) {
                const std::string reason = error.what();
                EXPECT_NE(reason.find("another photonav is writing it"), std::string::npos)
                    << reason;
            }
        }
    };
    std::vector<std::thread> writers;
    for (int writer = 0; writer < 3; ++writer) writers.emplace_back(writeAgain, writer);
    for (std::thread& writer : writers) writer.join();
    EXPECT_FALSE(Manifest::read(target_).empty());
    EXPECT_FALSE(Manifest::read(target_).foreignFile(target_));
    EXPECT_EQ(entries(temporary_.path()), 1U);
    EXPECT_EQ(complaint(target_), "");
}

TEST_F(FolderTransactionTest, WaitsForNoneWhileAFileIsReplaced) {
    { const FolderLock nothing(target_ / "missing"); }
    EXPECT_EQ(entries(temporary_.path()), 0U);
    commit(target_, "old.txt", "old");
    {
        const FolderLock lock(target_);
        EXPECT_TRUE(WorkingFolder::isAnyOpen());
        EXPECT_NE(complaint(target_).find("another photonav is writing it"), std::string::npos);
        const auto second = [&] { const FolderLock again(target_); };
        EXPECT_NE(reasonOf(second).find("another photonav"), std::string::npos);
    }
    EXPECT_EQ(entries(temporary_.path()), 1U);
    EXPECT_EQ(complaint(target_), "");
}

/// `photonav report` may have been killed.
TEST_F(FolderTransactionTest, UnfinishedFilesInAResultAreOurs) {
    commit(target_, "old.txt", "old");
    write(target_ / ".photonav.tmp-1-2-3", "half a list");
    write(target_ / "old.txt.tmp-1-2-3", "half a page");
    commit(target_, "new.txt", "new");
    EXPECT_EQ(entries(target_), 2U);  // with the manifest
    EXPECT_EQ(entries(temporary_.path()), 1U);
    for (const char* mine : {"notes.tmp-1-2-3", "new.txt.tmp-2024", "new.txt.tmp-1-2-"}) {
        write(target_ / mine, "");
        EXPECT_NE(complaint(target_).find("is not of an earlier result"), std::string::npos)
            << mine;
        fs::remove(target_ / mine);
    }
}

TEST_F(FolderTransactionTest, IsSeenByOthersUntilItEnds) {
    const auto isSeen = [&] {
        EXPECT_EQ(WorkingFolder::isAnyOpen(), WorkingFolder::isLocked(target_));
        return WorkingFolder::isAnyOpen();
    };
    EXPECT_FALSE(isSeen());
    {
        FolderTransaction first(target_);
        EXPECT_TRUE(isSeen());
        first.commit();
    }
    EXPECT_FALSE(isSeen());
    { const FolderTransaction unfinished(target_, Unfinished::kept); }
    EXPECT_FALSE(isSeen());
}

TEST_F(FolderTransactionTest, FollowsLinksAndRefusesWhatIsNoFolder) {
    commit(target_, "old.txt", "old");
    const fs::path link = temporary_.path() / "link";
    fs::create_directory_symlink(target_, link);
    commit(link / "", "new.txt", "new");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(contentOf(target_ / "new.txt"), "new");
    write(temporary_.path() / "file", "");
    EXPECT_NE(complaint(temporary_.path() / "file").find("file: is no folder"), std::string::npos);
    EXPECT_NE(complaint(".").find("is the current directory"), std::string::npos);
    EXPECT_NE(complaint("/proc").find("is a mount point"), std::string::npos);
    EXPECT_NE(complaint("/proc/x").find("/proc/x: cannot be made"), std::string::npos);
}

/// Runs `work` in a process that is killed when it has ended its work.
void inKilledProcess(const std::function<void()>& work) {
    const pid_t child = fork();
    if (child == 0) {
        work();
        std::raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
}

TEST_F(FolderTransactionTest, AKilledProcessLeavesTheEarlierFolder) {
    commit(target_, "old.txt", "old");
    const fs::path unfinished = target_.string() + ".unfinished";
    for (const Unfinished policy : {Unfinished::removed, Unfinished::kept}) {
        inKilledProcess([&] {
            const FolderTransaction transaction(target_, policy);
            write(transaction.path() / "runs.txt", "1");
        });
        EXPECT_EQ(contentOf(target_ / "old.txt"), "old");
        {
            const FolderTransaction next(target_, policy);
            EXPECT_EQ(fs::exists(next.path() / "runs.txt"), policy == Unfinished::kept);
        }
        EXPECT_EQ(fs::exists(unfinished), policy == Unfinished::kept);
    }
}

TEST_F(FolderTransactionTest, WhatWasReplacedIsNotTakenForUnfinishedWork) {
    // As if killed between the exchange and the removal of the folder that was replaced.
    commit(target_, "old.txt", "old");
    fs::rename(target_, target_.string() + ".unfinished");
    commit(target_, "new.txt", "new");
    EXPECT_EQ(contentOf(target_ / "new.txt"), "new");
    EXPECT_EQ(entries(temporary_.path()), 1U);
    EXPECT_EQ(entries(target_), 2U);
}

TEST_F(FolderTransactionTest, AUsersFileBesideAResultThatWasReplacedIsKept) {
    commit(target_, "old.txt", "old");
    const fs::path working = target_.string() + ".unfinished";
    fs::copy(target_, working, fs::copy_options::recursive);
    write(working / "notes.txt", "mine");
    EXPECT_NE(complaint(target_).find("notes.txt: is in the way"), std::string::npos);
    EXPECT_EQ(contentOf(working / "notes.txt"), "mine");
    EXPECT_EQ(contentOf(target_ / "old.txt"), "old");
}

TEST_F(FolderTransactionTest, UnfinishedWorkIsKeptThatWasAboutToReplaceTheFolder) {
    commit(target_, "old.txt", "old");
    inKilledProcess([&] {
        FolderTransaction transaction(target_, Unfinished::kept);
        write(transaction.path() / "runs.txt", "1");
        write(target_ / "notes.txt", "mine");  // in the way, after the manifest was written
        EXPECT_THROW(transaction.commit(), InputError);
    });
    fs::remove(target_ / "notes.txt");
    FolderTransaction next(target_, Unfinished::kept);
    EXPECT_TRUE(fs::exists(next.path() / "runs.txt"));
    next.commit();
    EXPECT_EQ(contentOf(target_ / "runs.txt"), "1");
    EXPECT_FALSE(fs::exists(target_ / "old.txt"));
}

TEST_F(FolderTransactionTest, WorkThatWentOnAfterAFailedCommitIsNoForeignFile) {
    commit(target_, "old.txt", "old");
    inKilledProcess([&] {
        FolderTransaction transaction(target_, Unfinished::kept);
        write(transaction.path() / "runs.txt", "1");
        write(target_ / "notes.txt", "mine");  // in the way: the manifest is written, and stays
        EXPECT_THROW(transaction.commit(), InputError);
    });
    fs::remove(target_ / "notes.txt");
    inKilledProcess([&] {
        const FolderTransaction transaction(target_, Unfinished::kept);
        write(transaction.path() / "runs.txt", "1 2");
    });
    const FolderTransaction next(target_, Unfinished::kept);
    EXPECT_EQ(contentOf(next.path() / "runs.txt"), "1 2");
}

TEST_F(FolderTransactionTest, UnfinishedWorkIsKeptWhereTheFolderInTheWayWasMoved) {
    commit(target_, "old.txt", "old");
    inKilledProcess([&] {
        FolderTransaction transaction(target_, Unfinished::kept);
        write(transaction.path() / "runs.txt", "1");
        write(target_ / "notes.txt", "mine");
        EXPECT_THROW(transaction.commit(), InputError);
    });
    fs::rename(target_, temporary_.path() / "elsewhere");
    FolderTransaction next(target_, Unfinished::kept);
    EXPECT_TRUE(fs::exists(next.path() / "runs.txt"));
}

TEST_F(FolderTransactionTest, WorkThatFollowsAReplacedResultIsKept) {
    commit(target_, "old.txt", "old");
    const fs::path copy = temporary_.path() / "copy";
    fs::copy(target_, copy, fs::copy_options::recursive);
    commit(target_, "new.txt", "new");
    // As if killed between the exchange and the removal of the folder that was replaced.
    fs::rename(copy, target_.string() + ".unfinished");
    inKilledProcess([&] {
        const FolderTransaction transaction(target_, Unfinished::kept);
        EXPECT_FALSE(fs::exists(transaction.path() / "old.txt"));
        write(transaction.path() / "runs.txt", "1");
    });
    const FolderTransaction next(target_, Unfinished::kept);
    EXPECT_TRUE(fs::exists(next.path() / "runs.txt"));
}

// Where the file system cannot exchange two folders in one step: as if killed between the steps.
TEST_F(FolderTransactionTest, AnExchangeInTwoStepsLosesNothing) {
    const fs::path unfinished = target_.string() + ".unfinished";
    const fs::path aside = unfinished.string() + ".unfinished";
    commit(target_, "old.txt", "old");
    fs::copy(target_, aside, fs::copy_options::recursive);
    commit(target_, "new.txt", "new");
    fs::rename(target_, unfinished);
    {
        const FolderTransaction next(target_, Unfinished::kept);
        EXPECT_EQ(contentOf(target_ / "old.txt"), "old");
        EXPECT_EQ(contentOf(next.path() / "new.txt"), "new");
        EXPECT_FALSE(fs::exists(aside));
    }
    fs::remove_all(unfinished);

    fs::copy(target_, aside, fs::copy_options::recursive);
    commit(target_, "new.txt", "new");
    EXPECT_TRUE(fs::exists(aside)) << "not what the result before has replaced";
    EXPECT_EQ(complaint(target_), "");
    EXPECT_FALSE(fs::exists(aside));
    EXPECT_EQ(contentOf(target_ / "new.txt"), "new");
}

TEST_F(FolderTransactionTest, ACopyOfAResultIsTheUsers) {
    commit(target_, "old.txt", "old");
    const fs::path copy = target_.string() + ".replaced";
    fs::copy(target_, copy, fs::copy_options::recursive);
    commit(target_, "new.txt", "new");
    commit(target_, "newer.txt", "newer");
    fs::remove_all(target_);
    commit(target_, "newest.txt", "newest");
    EXPECT_EQ(contentOf(copy / "old.txt"), "old");
}

TEST_F(FolderTransactionTest, KeptWorkIsNotRemovedByWhoKeepsNone) {
    inKilledProcess([&] {
        const FolderTransaction transaction(target_, Unfinished::kept);
        write(transaction.path() / "runs.txt", "1");
    });
    EXPECT_NE(complaint(target_).find("target.unfinished: holds the work of a command"),
              std::string::npos)
        << complaint(target_);
    FolderTransaction next(target_, Unfinished::kept);
    EXPECT_EQ(contentOf(next.path() / "runs.txt"), "1");
    next.commit();
    EXPECT_EQ(complaint(target_), "");
}

TEST_F(FolderTransactionTest, RefusesALinkToNowhereAtTheBeginning) {
    fs::create_symlink("nowhere", target_);
    EXPECT_NE(complaint(target_).find("is a link to a folder that does not exist"),
              std::string::npos);
}

TEST_F(FolderTransactionTest, LinesOfAManifestNameNothingOutsideOfItsFolder) {
    const fs::path outside = temporary_.path() / "outside";
    write(outside / "notes.txt", "mine");
    commit(target_, "old.txt", "old");
    const std::string first = "photonav files 1\n";
    const std::string rest = contentOf(target_ / ".photonav").substr(first.size());
    write(target_ / ".photonav", first + "0 00000000 ../outside/notes.txt\n" + rest);
    commit(target_, "new.txt", "new");
    EXPECT_EQ(contentOf(outside / "notes.txt"), "mine");
    EXPECT_EQ(contentOf(target_ / "new.txt"), "new");
}

TEST_F(FolderTransactionTest, TakesOnlyWorkingFoldersForUnfinishedWork) {
    const fs::path working = target_.string() + ".unfinished";
    write(working / "sub/notes.txt", "mine");
    EXPECT_NE(complaint(target_).find("target.unfinished: is in the way"), std::string::npos);
    EXPECT_EQ(contentOf(working / "sub/notes.txt"), "mine");
    fs::remove(working / "sub/notes.txt");
    EXPECT_EQ(complaint(target_), "");  // as killed before the lock was made
    const fs::path elsewhere = temporary_.path() / "elsewhere";
    commit(elsewhere, "result.json", "{}");
    fs::create_directory_symlink(elsewhere, working);
    EXPECT_NE(complaint(target_).find("is in the way"), std::string::npos);
    EXPECT_EQ(contentOf(elsewhere / "result.json"), "{}");
    fs::remove(working);
    EXPECT_NE(complaint(working).find("ends in .unfinished"), std::string::npos);
}

}  // namespace
}  // namespace photonav
