// SPDX-License-Identifier: BSD-3-Clause
// The folder NAME.unfinished beside a result folder. One process at a time has its lock, and with
// it the right to write the result.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/file_lock.hpp"
#include "io/manifest.hpp"

namespace photonav {

/// @throws InputError always: of a folder that cannot be used, and why
[[noreturn]] void refuseFolder(const std::filesystem::path& folder, const std::string& reason);

/// The file or folder that a path leads to, absolute, links followed, without a closing slash; it
/// and its last parents need not exist.
/// @throws InputError for a path that the system refuses, such as one that is too long
std::filesystem::path resolvedFolder(const std::filesystem::path& path);

/// A working folder that this process has locked. The lock is on its manifest, which is the first
/// file in it and the last one, and moves with the folder.
class WorkingFolder {
  public:
    static constexpr const char* kSuffix = ".unfinished";

    /// The working folder of a resolved folder.
    static std::filesystem::path of(const std::filesystem::path& resolved);

    /// Makes the folder if there is none, and locks it.
    /// @param resolved folder beside which it is
    /// @param target the same folder as the user has named it
    /// @throws InputError when another process has the lock, and when the working folder cannot be
    ///         made or is none of ours
    WorkingFolder(const std::filesystem::path& resolved, const std::filesystem::path& target);

    const std::filesystem::path& path() const { return path_; }
    bool isNew() const { return isNew_; }

    /// Files and folders in it beside the manifest.
    std::vector<std::filesystem::path> files() const;
    /// Whether there are files beside the manifest, at any depth.
    bool hasFiles() const;
    void removeFiles() const;

    /// Writes the manifest. @returns whether it is whole
    bool write(const Manifest& manifest);
    /// An empty manifest is that of a process that keeps nothing if it is killed.
    void clearManifest();

    /// Removes the folder, in which there must be nothing but the manifest.
    void remove() const;

    /// Gives up the lock. It may have moved with the folder, which others may replace then.
    void unlock() { lock_.reset(); }

    /// Whether another process has the lock beside a folder.
    static bool isLocked(const std::filesystem::path& folder);

    /// Whether this process has such an object. Without one, an interrupted process has nothing to
    /// keep, and no working folder. May be called in a signal handler.
    static bool isAnyOpen() { return open_ > 0; }

  private:
    struct Counted {
        Counted() { ++open_; }
        ~Counted() { --open_; }
        Counted(const Counted&) = delete;
        Counted& operator=(const Counted&) = delete;
    };

    static inline std::atomic<int> open_{0};
    Counted counted_;
    std::filesystem::path path_;
    FileDescriptor lock_;
    bool isNew_ = false;
};

/// Keeps other processes from writing a result folder while one of its files is replaced: as long
/// as this object lives, they are refused as a FolderTransaction refuses them. Does nothing for a
/// folder that does not exist, or that this user may not replace.
class FolderLock {
  public:
    /// @throws InputError as WorkingFolder does
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    std::optional<WorkingFolder> working_;
};

}  // namespace photonav
