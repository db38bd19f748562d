// SPDX-License-Identifier: BSD-3-Clause
#include "io/folder_transaction.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/durable_file.hpp"
#include "io/error.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

void removeEmptyFolders(const fs::path& folder) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        if (fs::is_directory(entry.symlink_status())) removeEmptyFolders(entry.path());
    }
    fs::remove(folder, ignored);  // fails unless it is empty
}

void synchroniseAll(const fs::path& folder) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_symlink()) synchronise(entry.path(), entry.path());
    }
    synchronise(folder, folder);
}

/// Removes the unfinished files that a killed process left.
void removeTemporaryFiles(const fs::path& folder) {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (isTemporaryFile(entry.path())) found.push_back(entry.path());
    }
    for (const fs::path& file : found) fs::remove(file);
}

/// Refuses what is no folder that could be replaced, whatever it holds.
void checkPlace(const fs::path& target, const fs::path& resolved) {
    std::error_code error;
    const fs::file_status status = fs::status(resolved, error);
    if (status.type() == fs::file_type::not_found) {
        if (fs::is_symlink(fs::symlink_status(resolved, error))) {
            refuseFolder(target, "is a link to a folder that does not exist");
        }
        return;
    }
    if (!fs::is_directory(status)) refuseFolder(target, "is no folder");
    const fs::path here = fs::current_path(error);
    if (!error && resolved.lexically_relative(here) == ".") {
        refuseFolder(target, "is the current directory; give a folder in it");
    }
    struct stat own {};
    struct stat parent {};
    if (stat(resolved.c_str(), &own) == 0 && stat(resolved.parent_path().c_str(), &parent) == 0 &&
        own.st_dev != parent.st_dev) {
        refuseFolder(target, "is a mount point; give a folder in it");
    }
}

/// Refuses a folder with files that no manifest of ours lists.
void checkFiles(const fs::path& target, const fs::path& resolved) {
    if (!fs::exists(resolved)) return;
    const auto file = Manifest::read(resolved).foreignFile(resolved);
    if (!file) return;
    if (file->filename() == Manifest::kFileName) {
        refuseFolder(target / file->parent_path(),
                     "is a result within the one to replace; move it away, or give another folder");
    }
    refuseFolder(target / *file,
                 "is not of an earlier result, or was changed since; give another folder");
}

/// Where a result is during an exchange in two steps: no result can have this name.
fs::path asideOf(const fs::path& resolved) {
    return WorkingFolder::of(WorkingFolder::of(resolved));
}

/// Removes what a manifest lists; other files stay. The manifest, which is the lock, is the last to
/// go: from then on another process may write here.
void removeResult(const fs::path& folder) {
    Manifest::read(folder).removeFiles(folder);
    removeEmptyFolders(folder);
    fs::remove(folder / Manifest::kFileName);
    std::error_code ignored;
    fs::remove(folder, ignored);  // fails unless it is empty
}

/// The manifest of work that is kept has its first line from the beginning. That of other work is
/// empty until it lists all files.
void checkLeftNoWork(const WorkingFolder& working, const Manifest& left) {
    const bool isWork = left.empty() && fs::file_size(working.path() / Manifest::kFileName) > 0;
    if (!isWork || !working.hasFiles()) return;
    refuseFolder(
        working.path(),
        "holds the work of a command that did not end; go on with that command's --resume, "
        "remove that folder, or give another one");
}

/// Keeps other processes from writing where the earlier result will be until it is removed there.
/// @return whether there is a lock
bool lockReplaced(FileDescriptor& lock, const fs::path& resolved) {
    const fs::path file = resolved / Manifest::kFileName;
    lock.reset(open(file.c_str(), O_RDWR | O_CLOEXEC));  // for writing, as NFS needs it
    if (lock.get() < 0) lock.reset(open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (lock.get() < 0) return false;
    int failed = 0;
    do {  // others have it for a moment only
        failed = flock(lock.get(), LOCK_EX);
    } while (failed != 0 && errno == EINTR);
    return failed == 0;
}

}  // namespace

FolderTransaction::FolderTransaction(const fs::path& target, Unfinished unfinished)
    : target_(target), resolved_(resolvedFolder(target)), unfinished_(unfinished) {
    if (resolved_.extension() == WorkingFolder::kSuffix) {
        refuseFolder(target, fmt::format("ends in {}, as folders do that are being written",
                                         WorkingFolder::kSuffix));
    }
    checkPlace(target_, resolved_);
    working_.emplace(resolved_, target_);
    path_ = working_->path();
    try {
        checkFiles(target_, resolved_);  // nobody else replaces it any more
        takeUp();
    } catch (...) {
        if (working_->isNew()) working_->remove();
        throw;
    }
}

/// Ends what a killed process has left, and keeps its work if it is to be gone on with.
void FolderTransaction::takeUp() {
    endExchange();
    // The process ended after an exchange, before the earlier result was removed.
    const Manifest left = Manifest::read(path_);
    if (!left.empty()) {
        if (const auto file = left.foreignFile(path_)) {
            refuseFolder(path_ / *file,
                         "is in the way of a result that is being written; move it away");
        }
    }
    const bool isReplaced = !left.empty() && Manifest::read(resolved_).hasReplaced(path_);
    if (unfinished_ == Unfinished::removed) checkLeftNoWork(*working_, left);
    if (isReplaced || unfinished_ == Unfinished::removed) working_->removeFiles();
    removeTemporaryFiles(path_);
    // What it lists changes from here on.
    const bool isKept = unfinished_ == Unfinished::kept;
    // On a full disk, what comes next says so.
    if (!isKept || !working_->write({})) working_->clearManifest();
}

/// The process ended within an exchange in two steps: before the second, the earlier result is put
/// back; after it, removed.
void FolderTransaction::endExchange() const {
    const fs::path aside = asideOf(resolved_);
    try {
        if (Manifest::read(aside).empty()) return;
        if (!fs::exists(fs::symlink_status(resolved_))) {
            if (Manifest::read(path_).hasReplaced(aside)) fs::rename(aside, resolved_);
        } else if (Manifest::read(resolved_).hasReplaced(aside)) {
            removeResult(aside);
        }
    } catch (const std::exception&) {  // it stays where it is
    }
}

void FolderTransaction::discard() { working_->removeFiles(); }

FolderTransaction::~FolderTransaction() {
    if (!isOpen_) return;
    try {
        if (unfinished_ == Unfinished::kept && working_->hasFiles()) return;
        working_->removeFiles();
        working_->remove();
    } catch (const std::exception&) {  // the next one at this place removes it
    }
}

void FolderTransaction::commit() {
    Manifest files = Manifest::of(path_);
    files.setReplaced(resolved_);
    if (!working_->write(files)) {
        throw InputError((path_ / Manifest::kFileName).string(), "",
                         std::string("cannot be written: ") + std::strerror(errno));
    }
    synchroniseAll(path_);
    const Unfinished before = std::exchange(unfinished_, Unfinished::kept);
    FileDescriptor lockOfReplaced;
    std::optional<fs::path> replaced;
    try {
        checkPlace(target_, resolved_);  // as it was at the beginning?
        checkFiles(target_, resolved_);
        const bool isLocked = lockReplaced(lockOfReplaced, resolved_);
        replaced = exchange();
        if (!isLocked) replaced.reset();  // the next one at this place removes it
    } catch (const InputError& error) {
        throw InputError(target_.string(), "",
                         fmt::format("cannot be replaced: {}; the result is in {} until the next "
                                     "run with this folder",
                                     error.what(), path_.string()));
    }
    isAnyCommitted_ = true;
    unfinished_ = before;
    isOpen_ = false;
    working_->unlock();
    synchronise(resolved_.parent_path(), target_);
    if (replaced) {
        removeReplaced(*replaced);
        lockOfReplaced.reset();
        std::error_code ignored;  // on NFS, a file that was open has kept the folder
        fs::remove(*replaced, ignored);
    }
    working_.reset();
}

/// As the target was given, unless its path leads elsewhere through a link.
fs::path FolderTransaction::placeBeside(const fs::path& target, const std::string& suffix) {
    const fs::path given = (target / "").parent_path().string() + suffix;
    const fs::path place = resolvedFolder(target).string() + suffix;
    static_cast<void>(resolvedFolder(WorkingFolder::of(place)));
    return resolvedFolder(given) == place ? given : place;
}

void FolderTransaction::commitBeside(const std::string& suffix) {
    const fs::path place = placeBeside(target_, suffix);
    std::optional<FolderTransaction> beside;
    try {
        beside.emplace(place);
    } catch (const InputError& error) {
        unfinished_ = Unfinished::kept;
        throw InputError(place.string(), "",
                         fmt::format("cannot be made: {}; what was done is in {} until the next "
                                     "run with {}",
                                     error.what(), path_.string(), target_.string()));
    }
    for (const fs::path& file : working_->files()) {
        fs::rename(file, beside->path() / file.filename());
    }
    beside->commit();
    target_ = place;
}

/// In one step where the file system can, else in two with the earlier folder aside.
/// @return where the earlier result is now; nothing if there was none
std::optional<fs::path> FolderTransaction::exchange() const {
    const auto fail = [&](int reason) { refuseFolder(resolved_, std::strerror(reason)); };
    if (!fs::exists(resolved_ / Manifest::kFileName)) {  // or an empty folder
        if (std::rename(path_.c_str(), resolved_.c_str()) != 0) fail(errno);
        return {};
    }
    if (renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, resolved_.c_str(), RENAME_EXCHANGE) == 0) {
        return path_;
    }
    if (errno != EINVAL && errno != ENOSYS) fail(errno);
    endExchange();
    const fs::path aside = asideOf(resolved_);
    if (std::rename(resolved_.c_str(), aside.c_str()) != 0) fail(errno);
    if (std::rename(path_.c_str(), resolved_.c_str()) != 0) {
        const int reason = errno;
        static_cast<void>(std::rename(aside.c_str(), resolved_.c_str()));
        fail(reason);
    }
    return aside;
}

void FolderTransaction::removeReplaced(const fs::path& place) {
    try {
        removeResult(place);
    } catch (const std::exception&) {  // the new one is in place; the next one removes this
    }
}

}  // namespace photonav
