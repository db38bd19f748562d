// SPDX-License-Identifier: BSD-3-Clause
// Result folders that appear as a whole or not at all, even if the program is killed.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>

#include "io/manifest.hpp"
#include "io/working_folder.hpp"

namespace photonav {

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
    const std::filesystem::path& path() const { return path_; }

    /// Writes everything to the disk, then puts the working folder in the target's place.
    /// @throws InputError when that cannot be done; the working folder is kept then
    void commit();

    /// As commit(), but as the folder NAME + suffix beside the target, which stays as it is;
    /// target() is that folder from then on.
    /// @throws InputError as the constructor does for that folder, and as commit() does; what was
    ///         written is kept then
    void commitBeside(const std::string& suffix);

    /// The folder of commitBeside(). @throws InputError where it cannot be made, as its name is too
    ///         long
    static std::filesystem::path placeBeside(const std::filesystem::path& target,
                                             const std::string& suffix);

    /// Whether the target holds an earlier result.
    bool hasEarlier() const { return !Manifest::read(resolved_).empty(); }
    /// Whether work that was not committed is kept.
    bool isKept() const { return unfinished_ == Unfinished::kept; }

    /// Removes what was written so far: nothing of it is worth keeping.
    void discard();

    /// Whether this process has put a result in its place. May be called in a signal handler.
    static bool isAnyCommitted() { return isAnyCommitted_; }

  private:
    void takeUp();
    void endExchange() const;
    std::optional<std::filesystem::path> exchange() const;
    static void removeReplaced(const std::filesystem::path& place);

    static inline std::atomic<bool> isAnyCommitted_{false};
    std::filesystem::path target_;          // as given
    std::filesystem::path resolved_;        // absolute, links followed
    std::optional<WorkingFolder> working_;  // beside it, until commit() ends
    std::filesystem::path path_;            // of the working folder
    Unfinished unfinished_;
    bool isOpen_ = true;
};

}  // namespace photonav
