// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "io/folder_transaction.hpp"

namespace photonav {

/// Keeps other processes from writing a file, for as long as this object lives, by a locked file
/// FILE.lock beside it. The system unlocks it if the process is killed.
class FileLock {
  public:
    /// @throws InputError naming the file if another process has the lock, or if FILE.lock cannot
    ///         be made
    explicit FileLock(const std::filesystem::path& file);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    std::filesystem::path lockFile_;
    FileDescriptor lock_;
};

}  // namespace photonav
