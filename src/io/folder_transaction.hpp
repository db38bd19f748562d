// SPDX-License-Identifier: BSD-3-Clause
// Result folders that appear as a whole or not at all, even if the program is killed.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace photonav {

/// The file or folder that a path leads to, absolute, links followed, without a closing slash; it
/// and its last parents need not exist.
/// @throws InputError for a path that the system refuses, such as one that is too long
std::filesystem::path resolvedFolder(const std::filesystem::path& path);

/// The list of files and empty folders that this program wrote into a folder. It is stored there as
/// `.photonav`, one line per file with size, checksum and name. What is not listed, or was changed
/// since, belongs to the user.
class Manifest {
  public:
    static constexpr const char* kFileName = ".photonav";

    /// The files of a folder and its subfolders, as they are now.
    static Manifest of(const std::filesystem::path& folder);

    /// The manifest of an earlier run; empty if the folder has none.
    /// @throws InputError when it is damaged
    static Manifest read(const std::filesystem::path& folder);

    /// States which result this one is to replace: the one whose manifest a folder has now.
    void setReplaced(const std::filesystem::path& folder);
    /// Whether the folder still has the result of setReplaced(): the replacement did not happen.
    bool isToReplace(const std::filesystem::path& folder) const;

    std::string text() const;
    bool empty() const { return files_.empty(); }

    /// A file or an empty folder that is not listed or was changed since; nothing when all are
    /// listed.
    std::optional<std::filesystem::path> foreignFile(const std::filesystem::path& folder) const;

    /// Removes the listed files of the folder. Links are not followed, and files outside of the
    /// folder are not removed even if a line names them.
    void removeFiles(const std::filesystem::path& folder) const;

    /// Updates the entry of a file that the program has written again. Does nothing if the folder
    /// has no manifest.
    static void renew(const std::filesystem::path& folder, const std::filesystem::path& name);

  private:
    struct File {
        std::filesystem::path name;  // relative to the folder
        std::uintmax_t size;         // [bytes]
        std::uint32_t checksum;      // CRC-32
        bool operator==(const File&) const = default;
    };
    bool lists(const std::filesystem::path& folder, const std::filesystem::path& name) const;
    /// Position of the first file whose name is not before this one in the sorted list.
    std::vector<File>::const_iterator placeOf(const std::filesystem::path& name) const;
    static File describe(const std::filesystem::path& folder, const std::filesystem::path& name);

    std::vector<File> files_;                // sorted by name
    std::optional<std::uint32_t> replaces_;  // CRC-32 of the manifest that was in place, 0: none
};

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

/// Replaces a folder as a whole. Files are written into a working folder beside it,
/// NAME.unfinished; commit() exchanges the two in one step. Until then, and when the program is
/// killed or the disk is full, an earlier folder stays as it was. One process at a time: the
/// working folder is locked.
class FolderTransaction {
  public:
    /// What happens to a working folder that was not committed, or that a killed process left
    /// behind. `kept` is for work that can be resumed: the next transaction finds it again, and one
    /// of the other kind refuses to remove it.
    enum class Unfinished { removed, kept };

    /// @param target need not exist; a link to a folder stays a link
    /// @throws InputError when the target holds files that no manifest of ours lists, is the
    ///         current directory, a mount point or no folder, when another process writes it, and
    ///         when the working folder cannot be made or is none of ours
    explicit FolderTransaction(const std::filesystem::path& target,
                               Unfinished unfinished = Unfinished::removed);
    ~FolderTransaction();
    FolderTransaction(const FolderTransaction&) = delete;
    FolderTransaction& operator=(const FolderTransaction&) = delete;

    /// Where results will be, as it was given.
    const std::filesystem::path& target() const { return target_; }
    /// Where to write until commit().
    const std::filesystem::path& path() const { return working_; }

    /// Writes everything to the disk, then puts the working folder in the target's place.
    /// @throws InputError when that cannot be done; the working folder is kept then
    void commit();

    /// Whether this process has an open transaction. Without one, an interrupted process has no
    /// results to keep. May be called in a signal handler.
    static bool isAnyOpen() { return open_ > 0; }

    /// Whether another process is writing this folder.
    static bool isBeingWritten(const std::filesystem::path& target);

  private:
    void lock();
    void removeLeftovers() const;
    void exchange();
    void removeReplaced() const;

    std::filesystem::path target_;    // as given
    std::filesystem::path resolved_;  // absolute, links followed
    std::filesystem::path working_;   // beside it
    Unfinished unfinished_;
    FileDescriptor lock_;  // of the working folder's manifest
    bool isOpen_ = true;
    static inline std::atomic<int> open_{0};
};

}  // namespace photonav
