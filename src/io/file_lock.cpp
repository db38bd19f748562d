// SPDX-License-Identifier: BSD-3-Clause
#include "io/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "io/error.hpp"

namespace photonav {

void FileDescriptor::reset(int number) {
    if (number_ >= 0) close(number_);
    number_ = number;
}

bool lockOpenFile(const FileDescriptor& opened, const std::filesystem::path& file,
                  const std::filesystem::path& target) {
    if (flock(opened.get(), LOCK_EX | LOCK_NB) != 0) {
        const bool isHeld = errno == EWOULDBLOCK;
        const std::string reason = std::strerror(errno);
        throw InputError(target.string(), "",
                         isHeld ? "another photonav is writing it" : "not locked: " + reason);
    }
    struct stat locked {};
    struct stat there {};
    return fstat(opened.get(), &locked) == 0 && stat(file.c_str(), &there) == 0 &&
           locked.st_ino == there.st_ino && locked.st_dev == there.st_dev;
}

FileLock::FileLock(const std::filesystem::path& file) : lockFile_(file.string() + ".lock") {
    do {
        lock_.reset(open(lockFile_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
        if (lock_.get() < 0) {
            throw InputError(lockFile_.string(), "",
                             std::string("cannot be made: ") + std::strerror(errno));
        }
    } while (!lockOpenFile(lock_, lockFile_, file));
}

FileLock::~FileLock() {
    std::error_code ignored;
    std::filesystem::remove(lockFile_, ignored);
}

}  // namespace photonav
