// SPDX-License-Identifier: BSD-3-Clause
// Locks that keep other processes out. The system releases them when a process is killed.
#pragma once

#include <filesystem>

namespace photonav {

/// Owns the descriptor of an open file and closes it.
class FileDescriptor {
  public:
    FileDescriptor() = default;
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;
    ~FileDescriptor() { reset(); }

    int get() const { return number_; }
    void reset(int number = -1);

  private:
    int number_ = -1;
};

/// Locks a file that was opened by its path, until it is closed.
/// @return false if another process has moved or removed the file since: it is to be opened again
/// @throws InputError naming `target` if another process has the lock
bool lockOpenFile(const FileDescriptor& opened, const std::filesystem::path& file,
                  const std::filesystem::path& target);

/// Keeps other processes from writing a file, for as long as this object lives, by a locked file
/// FILE.lock beside it.
class FileLock {
  public:
    /// @throws InputError naming the file if another process has the lock, or FILE.lock if it
    ///         cannot be made
    explicit FileLock(const std::filesystem::path& file);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    std::filesystem::path lockFile_;
    FileDescriptor lock_;
};

}  // namespace photonav
