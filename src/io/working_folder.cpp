// SPDX-License-Identifier: BSD-3-Clause
#include "io/working_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "io/error.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

/// Refuses a folder beside which something else is than a working folder.
void checkWorkingFolder(const fs::path& working, const fs::path& target) {
    std::error_code error;
    // As of the longest path that is made before there are results.
    const fs::path lock = working / Manifest::kFileName;
    if (fs::symlink_status(lock, error).type() == fs::file_type::none) {
        refuseFolder(target, error.message());
    }
    const fs::file_status status = fs::symlink_status(working, error);
    if (status.type() == fs::file_type::not_found) return;
    const char* reason = "is in the way of a result that is being written; rename or remove it";
    if (!fs::is_directory(status)) refuseFolder(working, reason);
    if (fs::exists(lock, error)) return;
    for (const auto& entry : fs::recursive_directory_iterator(working, error)) {
        if (fs::exists(lock, error)) return;  // another process has just made it
        if (!fs::is_directory(entry.symlink_status())) refuseFolder(working, reason);
    }
}

/// A folder that another process has just put in place is not ours, and the next try makes a new
/// one. @returns whether the folder was made
bool lockWorkingFolder(FileDescriptor& lock, const fs::path& working, const fs::path& target) {
    const fs::path file = working / Manifest::kFileName;
    for (;;) {
        std::error_code error;
        const bool isNew = fs::create_directories(working, error);
        if (error) refuseFolder(target, "cannot be made: " + error.message());
        lock.reset(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
        if (lock.get() < 0 && errno == ENOENT) continue;
        if (lock.get() < 0) {
            const int reason = errno;
            if (isNew) fs::remove(working, error);
            refuseFolder(target, std::string("cannot be made: ") + std::strerror(reason));
        }
        if (lockOpenFile(lock, file, target)) return isNew;
    }
}

}  // namespace

void refuseFolder(const fs::path& folder, const std::string& reason) {
    throw InputError(folder.string(), "", reason);
}

fs::path resolvedFolder(const fs::path& path) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(fs::absolute(path) / "", error);
    if (error) refuseFolder(path, error.message());
    return whole.has_filename() ? whole : whole.parent_path();
}

fs::path WorkingFolder::of(const fs::path& resolved) { return resolved.string() + kSuffix; }

WorkingFolder::WorkingFolder(const fs::path& resolved, const fs::path& target)
    : path_(of(resolved)) {
    checkWorkingFolder(path_, target);
    isNew_ = lockWorkingFolder(lock_, path_, target);
}

std::vector<fs::path> WorkingFolder::files() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(path_)) {
        if (entry.path().filename() != Manifest::kFileName) files.push_back(entry.path());
    }
    return files;
}

bool WorkingFolder::hasFiles() const {
    const fs::recursive_directory_iterator entries(path_);
    return std::any_of(begin(entries), end(entries), [&](const auto& entry) {
        return !fs::is_directory(entry.symlink_status()) &&
               entry.path() != path_ / Manifest::kFileName;
    });
}

void WorkingFolder::removeFiles() const {
    for (const fs::path& file : files()) fs::remove_all(file);
}

bool WorkingFolder::write(const Manifest& manifest) {
    const std::string text = manifest.text();
    return ftruncate(lock_.get(), 0) == 0 &&
           pwrite(lock_.get(), text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
}

void WorkingFolder::clearManifest() { static_cast<void>(!ftruncate(lock_.get(), 0)); }

void WorkingFolder::remove() const {
    std::error_code ignored;
    fs::remove(path_ / Manifest::kFileName, ignored);
    fs::remove(path_, ignored);
}

bool WorkingFolder::isLocked(const fs::path& folder) {
    const fs::path file = of(resolvedFolder(folder)) / Manifest::kFileName;
    FileDescriptor lock;
    lock.reset(open(file.c_str(), O_RDWR | O_CLOEXEC));
    return lock.get() >= 0 && flock(lock.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

FolderLock::FolderLock(const fs::path& folder) {
    fs::path resolved = resolvedFolder(folder);
    const bool isReplaceable = access(resolved.parent_path().c_str(), W_OK) == 0;
    if (!isReplaceable || !fs::is_directory(resolved)) return;
    if (resolved.extension() == WorkingFolder::kSuffix) resolved.replace_extension();  // is one
    working_.emplace(resolved, folder);
}

FolderLock::~FolderLock() {
    if (!working_) return;
    try {
        const bool isNoWork = fs::is_empty(working_->path() / Manifest::kFileName);
        if (isNoWork && working_->files().empty()) working_->remove();
    } catch (const std::exception&) {  // the next one at this place removes it
    }
}

}  // namespace photonav
