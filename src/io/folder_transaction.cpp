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

/// Whether there are files beside the manifest.
bool hasFiles(const fs::path& folder) {
    const fs::recursive_directory_iterator entries(folder);
    return std::any_of(begin(entries), end(entries), [&](const auto& entry) {
        return !fs::is_directory(entry.symlink_status()) &&
               entry.path() != folder / Manifest::kFileName;
    });
}

/// Files and folders beside the manifest.
std::vector<fs::path> filesIn(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().filename() != Manifest::kFileName) files.push_back(entry.path());
    }
    return files;
}

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

[[noreturn]] void refuse(const fs::path& folder, const std::string& reason) {
    throw InputError(folder.string(), "", reason);
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
            refuse(target, "is a link to a folder that does not exist");
        }
        return;
    }
    if (!fs::is_directory(status)) refuse(target, "is no folder");
    const fs::path here = fs::current_path(error);
    if (!error && resolved.lexically_relative(here) == ".") {
        refuse(target, "is the current directory; give a folder in it");
    }
    struct stat own {};
    struct stat parent {};
    if (stat(resolved.c_str(), &own) == 0 && stat(resolved.parent_path().c_str(), &parent) == 0 &&
        own.st_dev != parent.st_dev) {
        refuse(target, "is a mount point; give a folder in it");
    }
}

/// Refuses a folder with files that no manifest of ours lists.
void checkFiles(const fs::path& target, const fs::path& resolved) {
    if (!fs::exists(resolved)) return;
    const auto file = Manifest::read(resolved).foreignFile(resolved);
    if (!file) return;
    if (file->filename() == Manifest::kFileName) {
        refuse(target / file->parent_path(),
               "is a result within the one to replace; move it away, or give another folder");
    }
    refuse(target / *file,
           "is not of an earlier result, or was changed since; give another folder");
}

constexpr const char* kWorkingSuffix = ".unfinished";

/// Beside a folder.
fs::path workingFolderOf(const fs::path& resolved) { return resolved.string() + kWorkingSuffix; }

/// Where a result is during an exchange in two steps: no result can have this name.
fs::path asideOf(const fs::path& resolved) { return workingFolderOf(workingFolderOf(resolved)); }

/// Removes what a manifest lists; other files stay. The manifest, which is the lock, is the last to
/// go: from then on another process may write here.
void removeResult(const fs::path& folder) {
    Manifest::read(folder).removeFiles(folder);
    for (const fs::path& left : filesIn(folder)) {
        if (fs::is_directory(fs::symlink_status(left))) removeEmptyFolders(left);
    }
    fs::remove(folder / Manifest::kFileName);
    std::error_code ignored;
    fs::remove(folder, ignored);  // fails unless it is empty
}

/// Refuses a folder beside which something else is than a working folder. The lock is the first
/// file in a working folder, and the last one.
void checkWorkingFolder(const fs::path& target, const fs::path& working) {
    std::error_code error;
    // As of the longest path that is made before there are results.
    const fs::path lock = working / Manifest::kFileName;
    if (fs::symlink_status(lock, error).type() == fs::file_type::none) {
        refuse(target, error.message());
    }
    const fs::file_status status = fs::symlink_status(working, error);
    if (status.type() == fs::file_type::not_found) return;
    const char* reason = "is in the way of a result that is being written; rename or remove it";
    if (!fs::is_directory(status)) refuse(working, reason);
    if (fs::exists(lock, error)) return;
    for (const auto& entry : fs::recursive_directory_iterator(working, error)) {
        if (fs::exists(lock, error)) return;  // another process has just made it
        if (!fs::is_directory(entry.symlink_status())) refuse(working, reason);
    }
}

/// Writes the manifest of a working folder into its file, which is open. @returns whether it is
/// whole
bool writeInto(int descriptor, const Manifest& files) {
    const std::string text = files.text();
    return ftruncate(descriptor, 0) == 0 &&
           pwrite(descriptor, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
}

/// The manifest of work that is kept has its first line from the beginning. That of other work is
/// empty until it lists all files.
void checkLeftNoWork(const fs::path& working, const Manifest& left) {
    const bool isWork = left.empty() && fs::file_size(working / Manifest::kFileName) > 0;
    if (!isWork || !hasFiles(working)) return;
    refuse(working,
           "holds the work of a command that did not end; go on with that command's --resume, "
           "remove that folder, or give another one");
}

/// The lock is on the manifest, which moves with the folder: a folder that another process has just
/// put in place is not ours, and the next try makes a new one.
/// @return whether the working folder was made
bool lockWorkingFolder(FileDescriptor& lock, const fs::path& working, const fs::path& target) {
    const fs::path file = working / Manifest::kFileName;
    for (;;) {
        std::error_code error;
        const bool isNew = fs::create_directories(working, error);
        if (error) refuse(target, "cannot be made: " + error.message());
        lock.reset(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
        if (lock.get() < 0 && errno == ENOENT) continue;
        if (lock.get() < 0) {
            const int reason = errno;
            if (isNew) fs::remove(working, error);
            refuse(target, std::string("cannot be made: ") + std::strerror(reason));
        }
        if (lockOpenFile(lock, file, target)) return isNew;
    }
}

/// Of a working folder with nothing else in it; its lock must be held.
void removeLock(const fs::path& working) {
    std::error_code ignored;
    fs::remove(working / Manifest::kFileName, ignored);
    fs::remove(working, ignored);
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

fs::path resolvedFolder(const fs::path& path) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(fs::absolute(path) / "", error);
    if (error) refuse(path, error.message());
    return whole.has_filename() ? whole : whole.parent_path();
}

FolderTransaction::FolderTransaction(const fs::path& target, Unfinished unfinished)
    : target_(target),
      resolved_(resolvedFolder(target)),
      working_(workingFolderOf(resolved_)),
      unfinished_(unfinished) {
    if (resolved_.extension() == kWorkingSuffix) {
        refuse(target,
               fmt::format("ends in {}, as folders do that are being written", kWorkingSuffix));
    }
    checkPlace(target_, resolved_);
    checkWorkingFolder(target_, working_);
    const bool isNew = lockWorkingFolder(lock_, working_, target_);
    try {
        checkFiles(target_, resolved_);  // nobody else replaces it any more
        takeUp();
    } catch (...) {
        if (isNew) removeLock(working_);
        throw;
    }
}

/// Ends what a killed process has left, and keeps its work if it is to be gone on with.
void FolderTransaction::takeUp() {
    endExchange();
    // The process ended after an exchange, before the earlier result was removed.
    const Manifest left = Manifest::read(working_);
    if (!left.empty()) {
        if (const auto file = left.foreignFile(working_)) {
            refuse(working_ / *file,
                   "is in the way of a result that is being written; move it away");
        }
    }
    const bool isReplaced = !left.empty() && Manifest::read(resolved_).hasReplaced(working_);
    if (unfinished_ == Unfinished::removed) checkLeftNoWork(working_, left);
    if (isReplaced || unfinished_ == Unfinished::removed) removeLeftovers();
    removeTemporaryFiles(working_);
    // What it lists changes from here on.
    const bool isKept = unfinished_ == Unfinished::kept;
    if (!isKept || !writeInto(lock_.get(), {})) {  // on a full disk: what comes next says so
        static_cast<void>(!ftruncate(lock_.get(), 0));
    }
}

FolderLock::FolderLock(const fs::path& folder) {
    const fs::path resolved = resolvedFolder(folder);
    const bool isReplaceable = access(resolved.parent_path().c_str(), W_OK) == 0;
    if (!isReplaceable || !fs::is_directory(resolved)) return;
    working_ = resolved.extension() == kWorkingSuffix ? resolved : workingFolderOf(resolved);
    checkWorkingFolder(folder, working_);
    lockWorkingFolder(lock_, working_, folder);
}

FolderLock::~FolderLock() {
    if (lock_.get() < 0) return;
    try {
        const bool isNoWork = fs::is_empty(working_ / Manifest::kFileName);
        if (isNoWork && filesIn(working_).empty()) removeLock(working_);
    } catch (const std::exception&) {  // the next one at this place removes it
    }
}

bool FolderTransaction::isBeingWritten(const fs::path& target) {
    const fs::path file = workingFolderOf(resolvedFolder(target)) / Manifest::kFileName;
    const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor < 0) return false;
    const bool isLocked = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    close(descriptor);
    return isLocked;
}

/// The process ended within an exchange in two steps: before the second, the earlier result is put
/// back; after it, removed.
void FolderTransaction::endExchange() const {
    const fs::path aside = asideOf(resolved_);
    try {
        if (Manifest::read(aside).empty()) return;
        if (!fs::exists(fs::symlink_status(resolved_))) {
            if (Manifest::read(working_).hasReplaced(aside)) fs::rename(aside, resolved_);
        } else if (Manifest::read(resolved_).hasReplaced(aside)) {
            removeResult(aside);
        }
    } catch (const std::exception&) {  // it stays where it is
    }
}

void FolderTransaction::removeLeftovers() const {
    for (const fs::path& file : filesIn(working_)) fs::remove_all(file);
}

void FolderTransaction::discard() { removeLeftovers(); }

FolderTransaction::~FolderTransaction() {
    if (!isOpen_) return;
    try {
        if (unfinished_ == Unfinished::kept && hasFiles(working_)) return;
        removeLeftovers();
        removeLock(working_);
    } catch (const std::exception&) {  // the next one at this place removes it
    }
}

void FolderTransaction::commit() {
    Manifest files = Manifest::of(working_);
    files.setReplaced(resolved_);
    if (!writeInto(lock_.get(), files)) {
        throw InputError((working_ / Manifest::kFileName).string(), "",
                         std::string("cannot be written: ") + std::strerror(errno));
    }
    synchroniseAll(working_);
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
                                     error.what(), working_.string()));
    }
    isAnyCommitted_ = true;
    unfinished_ = before;
    isOpen_ = false;
    lock_.reset();  // it has moved with the folder, which others may replace now
    synchronise(resolved_.parent_path(), target_);
    if (replaced) {
        removeReplaced(*replaced);
        lockOfReplaced.reset();
        std::error_code ignored;  // on NFS, a file that was open has kept the folder
        fs::remove(*replaced, ignored);
    }
    counted_.reset();
}

/// As the target was given, unless its path leads elsewhere through a link.
fs::path FolderTransaction::placeBeside(const fs::path& target, const std::string& suffix) {
    const fs::path given = (target / "").parent_path().string() + suffix;
    const fs::path place = resolvedFolder(target).string() + suffix;
    static_cast<void>(resolvedFolder(workingFolderOf(place)));
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
                                     error.what(), working_.string(), target_.string()));
    }
    for (const fs::path& file : filesIn(working_)) {
        fs::rename(file, beside->path() / file.filename());
    }
    beside->commit();
    target_ = place;
}

/// In one step where the file system can, else in two with the earlier folder aside.
/// @return where the earlier result is now; nothing if there was none
std::optional<fs::path> FolderTransaction::exchange() const {
    const auto fail = [&](int reason) { refuse(resolved_, std::strerror(reason)); };
    if (!fs::exists(resolved_ / Manifest::kFileName)) {  // or an empty folder
        if (std::rename(working_.c_str(), resolved_.c_str()) != 0) fail(errno);
        return {};
    }
    if (renameat2(AT_FDCWD, working_.c_str(), AT_FDCWD, resolved_.c_str(), RENAME_EXCHANGE) == 0) {
        return working_;
    }
    if (errno != EINVAL && errno != ENOSYS) fail(errno);
    endExchange();
    const fs::path aside = asideOf(resolved_);
    if (std::rename(resolved_.c_str(), aside.c_str()) != 0) fail(errno);
    if (std::rename(working_.c_str(), resolved_.c_str()) != 0) {
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
