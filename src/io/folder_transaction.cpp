// SPDX-License-Identifier: BSD-3-Clause
#include "io/folder_transaction.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "io/durable_file.hpp"
#include "io/error.hpp"
#include "io/reading.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFirstLine = "photonav files 1";
constexpr std::string_view kReplaces = "replaces ";

std::uint32_t checksumOf(const fs::path& file) {
    std::ifstream stream = openIfThere(file.string());
    std::vector<char> block(1U << 20U);
    uLong sum = crc32(0L, Z_NULL, 0);
    while (stream) {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        sum = crc32(sum, reinterpret_cast<const Bytef*>(block.data()),
                    static_cast<uInt>(stream.gcount()));
    }
    return static_cast<std::uint32_t>(sum);
}

bool isFolder(const fs::directory_entry& entry) {
    return !entry.is_symlink() && entry.is_directory();
}

/// Files, links and empty folders of a folder and its subfolders, relative, sorted, the manifest
/// left out.
std::vector<fs::path> namesIn(const fs::path& folder) {
    std::vector<fs::path> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (isFolder(entry) && !fs::is_empty(entry)) continue;
        const fs::path name = entry.path().lexically_relative(folder);
        if (name != Manifest::kFileName) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// Whether there are files beside the manifest.
bool hasFiles(const fs::path& folder) {
    const fs::recursive_directory_iterator entries(folder);
    return std::any_of(begin(entries), end(entries), [&](const auto& entry) {
        return !isFolder(entry) && entry.path() != folder / Manifest::kFileName;
    });
}

void removeEmptyFolders(const fs::path& folder) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        if (isFolder(entry)) removeEmptyFolders(entry.path());
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

/// What stands in the way of replacing a folder.
void checkTarget(const fs::path& target, const fs::path& resolved) {
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

/// What stands in the way of writing beside a folder: anything but a working folder, in which the
/// lock is the first file and the last one.
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
        if (!isFolder(entry)) refuse(working, reason);
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
           "holds the work of a command that was killed; go on with that command's --resume, "
           "remove that folder, or give another one");
}

}  // namespace

void FileDescriptor::reset(int number) {
    if (number_ >= 0) close(number_);
    number_ = number;
}

fs::path resolvedFolder(const fs::path& path) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(fs::absolute(path) / "", error);
    if (error) refuse(path, error.message());
    return whole.has_filename() ? whole : whole.parent_path();
}

Manifest::File Manifest::describe(const fs::path& folder, const fs::path& name) {
    const fs::path file = folder / name;
    if (!fs::is_regular_file(fs::symlink_status(file))) return {name, 0, 0};
    return {name, fs::file_size(file), checksumOf(file)};
}

Manifest Manifest::of(const fs::path& folder) {
    Manifest manifest;
    for (const fs::path& name : namesIn(folder)) manifest.files_.push_back(describe(folder, name));
    return manifest;
}

Manifest Manifest::read(const fs::path& folder) {
    Manifest manifest;
    const fs::path file = folder / kFileName;
    std::ifstream stream = openIfThere(file.string());
    std::string line;
    if (!stream || !std::getline(stream, line)) return manifest;
    const auto fail = [&] { throw InputError(file.string(), "", "is damaged"); };
    if (line != kFirstLine) fail();
    while (std::getline(stream, line)) {
        const bool isReplaces = line.starts_with(kReplaces);
        std::istringstream fields = wordsOf(isReplaces ? line.substr(kReplaces.size()) : line);
        if (isReplaces) {
            std::uint32_t replaced = 0;
            if (!(fields >> std::hex >> replaced)) fail();
            manifest.replaces_ = replaced;
            continue;
        }
        File entry{};
        std::string name;
        fields >> entry.size >> std::hex >> entry.checksum;
        if (!fields || fields.get() != ' ' || !std::getline(fields, name)) fail();
        entry.name = name;
        manifest.files_.push_back(std::move(entry));
    }
    return manifest;
}

void Manifest::setReplaced(const fs::path& folder) { replaces_ = checksumOf(folder / kFileName); }

bool Manifest::isToReplace(const fs::path& folder) const {
    return replaces_ == checksumOf(folder / kFileName);
}

std::string Manifest::text() const {
    std::string text = std::string(kFirstLine) + "\n";
    if (replaces_) text += fmt::format("{}{:08x}\n", kReplaces, *replaces_);
    for (const File& file : files_) {
        text += fmt::format("{} {:08x} {}\n", file.size, file.checksum, file.name.string());
    }
    return text;
}

std::vector<Manifest::File>::const_iterator Manifest::placeOf(const fs::path& name) const {
    return std::lower_bound(files_.begin(), files_.end(), name,
                            [](const File& file, const fs::path& n) { return file.name < n; });
}

std::optional<fs::path> Manifest::foreignFile(const fs::path& folder) const {
    for (const fs::path& name : namesIn(folder)) {
        if (!lists(folder, name)) return name;
    }
    return {};
}

/// A folder in which listed files were is listed, too.
bool Manifest::lists(const fs::path& folder, const fs::path& name) const {
    const auto listed = placeOf(name);
    if (listed == files_.end()) return false;
    if (*listed == describe(folder, name)) return true;
    const auto [end, rest] =
        std::mismatch(name.begin(), name.end(), listed->name.begin(), listed->name.end());
    return end == name.end() && rest != listed->name.end() &&
           fs::is_directory(fs::symlink_status(folder / name));
}

void Manifest::renew(const fs::path& folder, const fs::path& name) {
    Manifest manifest = read(folder);
    if (manifest.empty()) return;
    const auto place =
        manifest.files_.begin() + (manifest.placeOf(name) - manifest.files_.cbegin());
    if (place != manifest.files_.end() && place->name == name) {
        *place = describe(folder, name);
    } else {
        manifest.files_.insert(place, describe(folder, name));
    }
    replaceFile(folder / kFileName, manifest.text());
}

void Manifest::removeFiles(const fs::path& folder) const {
    std::error_code ignored;
    for (const fs::path& name : namesIn(folder)) {
        const auto listed = placeOf(name);
        if (listed != files_.end() && listed->name == name) fs::remove(folder / name, ignored);
    }
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
    checkTarget(target_, resolved_);
    checkWorkingFolder(target_, working_);
    lock();
    // The process ended after an exchange, before the earlier result was removed.
    const Manifest left = Manifest::read(working_);
    const bool isReplaced = !left.empty() && !left.isToReplace(resolved_);
    if (unfinished_ == Unfinished::removed) checkLeftNoWork(working_, left);
    if (isReplaced || unfinished_ == Unfinished::removed) removeLeftovers();
    const bool isNewWork = unfinished_ == Unfinished::kept && left.empty();
    if (isNewWork && !writeInto(lock_.get(), left)) {  // on a full disk: what comes next says so
        static_cast<void>(!ftruncate(lock_.get(), 0));
    }
    ++open_;
}

bool FolderTransaction::isBeingWritten(const fs::path& target) {
    const fs::path file = workingFolderOf(resolvedFolder(target)) / Manifest::kFileName;
    const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor < 0) return false;
    const bool isLocked = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    close(descriptor);
    return isLocked;
}

/// The lock is on the manifest, which moves with the folder: a folder that another process has just
/// put in place is not ours, and the next try makes a new one.
void FolderTransaction::lock() {
    const fs::path file = working_ / Manifest::kFileName;
    for (;;) {
        std::error_code error;
        fs::create_directories(working_, error);
        if (error) refuse(target_, "cannot be made: " + error.message());
        lock_.reset(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
        if (lock_.get() < 0 && errno == ENOENT) continue;
        if (lock_.get() < 0)
            refuse(target_, std::string("cannot be made: ") + std::strerror(errno));
        if (flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) {
            const bool isHeld = errno == EWOULDBLOCK;
            const std::string reason = std::strerror(errno);
            refuse(target_, isHeld ? "another photonav is writing it" : "not locked: " + reason);
        }
        struct stat locked {};
        struct stat there {};
        if (fstat(lock_.get(), &locked) == 0 && stat(file.c_str(), &there) == 0 &&
            locked.st_ino == there.st_ino && locked.st_dev == there.st_dev) {
            return;
        }
    }
}

void FolderTransaction::removeLeftovers() const {
    for (const auto& entry : fs::directory_iterator(working_)) {
        if (entry.path().filename() != Manifest::kFileName) fs::remove_all(entry.path());
    }
}

FolderTransaction::~FolderTransaction() {
    --open_;
    if (!isOpen_) return;
    try {
        if (unfinished_ == Unfinished::removed || !hasFiles(working_)) {
            fs::remove_all(working_);
        }
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
    try {
        checkTarget(target_, resolved_);  // as it was at the beginning?
        exchange();
    } catch (const InputError& error) {
        throw InputError(target_.string(), "",
                         fmt::format("cannot be replaced: {}; the result is in {} until the next "
                                     "run with this folder",
                                     error.what(), working_.string()));
    }
    unfinished_ = before;
    isOpen_ = false;
    synchronise(resolved_.parent_path(), target_);
    removeReplaced();
}

/// In one step where the file system can, else in two with the earlier folder aside.
void FolderTransaction::exchange() {
    const auto fail = [&](int reason) { refuse(resolved_, std::strerror(reason)); };
    if (!fs::exists(resolved_)) {
        if (std::rename(working_.c_str(), resolved_.c_str()) != 0) fail(errno);
        return;
    }
    if (renameat2(AT_FDCWD, working_.c_str(), AT_FDCWD, resolved_.c_str(), RENAME_EXCHANGE) == 0) {
        return;
    }
    if (errno != EINVAL && errno != ENOSYS) fail(errno);
    const std::string aside = resolved_.string() + ".replaced";
    if (std::rename(resolved_.c_str(), aside.c_str()) != 0) fail(errno);
    if (std::rename(working_.c_str(), resolved_.c_str()) != 0) {
        const int reason = errno;
        static_cast<void>(std::rename(aside.c_str(), resolved_.c_str()));
        fail(reason);
    }
    static_cast<void>(std::rename(aside.c_str(), working_.c_str()));
}

/// The folder that was the target is now where the working folder was.
void FolderTransaction::removeReplaced() const {
    try {
        if (!fs::exists(working_)) return;
        Manifest::read(working_).removeFiles(working_);
        fs::remove(working_ / Manifest::kFileName);
        removeEmptyFolders(working_);
    } catch (const std::exception&) {  // the new one is in place; the next one removes this
    }
}

}  // namespace photonav
