// SPDX-License-Identifier: BSD-3-Clause
#include "io/atomic_file.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <random>
#include <string>
#include <system_error>

#include "io/error.hpp"

namespace photonav {

namespace {

/// A name beside the file that no other writer has, be it in this process, in another, or on
/// another machine that shares the folder.
std::filesystem::path temporaryFor(const std::filesystem::path& file) {
    static const unsigned random = std::random_device{}();
    static std::atomic<unsigned> count{0};
    std::string name = file.string() + ".tmp";
    for (const auto part : {static_cast<unsigned>(getpid()), random, count++}) {
        name.append("-").append(std::to_string(part));
    }
    return name;
}

/// Is removed at the end unless it was renamed.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::filesystem::path& file) : path_(temporaryFor(file)) {}
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace

void writeFileAtomically(const std::filesystem::path& file,
                         const std::function<void(std::ostream&)>& write) {
    const auto fail = [&](const std::string& reason) {
        throw InputError(file.string(), "", "cannot be written: " + reason);
    };
    const TemporaryFile temporary(file);
    errno = 0;
    std::ofstream stream(temporary.path(), std::ios::binary);
    if (stream) write(stream);
    stream.close();
    if (!stream) fail(errno != 0 ? std::strerror(errno) : "input/output error");

    std::error_code error;
    std::filesystem::rename(temporary.path(), file, error);
    if (error) fail(error.message());
}

void writeFileAtomically(const std::filesystem::path& file, std::string_view content) {
    writeFileAtomically(file, [&](std::ostream& stream) {
        stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    });
}

}  // namespace photonav
