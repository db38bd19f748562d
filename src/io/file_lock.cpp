// SPDX-License-Identifier: BSD-3-Clause
#include "io/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "io/error.hpp"

namespace photonav {

FileLock::FileLock(const std::filesystem::path& file) : lockFile_(file.string() + ".lock") {
    for (;;) {
        lock_.reset(open(lockFile_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
        if (lock_.get() < 0) {
            throw InputError(lockFile_.string(), "",
                             std::string("cannot be made: ") + std::strerror(errno));
        }
        if (flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) {
            const bool isHeld = errno == EWOULDBLOCK;
            const std::string reason = std::strerror(errno);
            lock_.reset();
            throw InputError(file.string(), "",
                             isHeld ? "another photonav is writing it" : "not locked: " + reason);
        }
        // The process that had the lock may have removed the file meanwhile.
        struct stat locked {};
        struct stat there {};
        if (fstat(lock_.get(), &locked) == 0 && stat(lockFile_.c_str(), &there) == 0 &&
            locked.st_ino == there.st_ino && locked.st_dev == there.st_dev) {
            return;
        }
    }
}

FileLock::~FileLock() {
    std::error_code ignored;
    std::filesystem::remove(lockFile_, ignored);
}

}  // namespace photonav
