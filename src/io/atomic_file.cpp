// SPDX-License-Identifier: BSD-3-Clause
#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <locale>
#include <random>
#include <regex>
#include <string>
#include <system_error>

#include "io/durable_file.hpp"
#include "io/error.hpp"

namespace photonav {

namespace {

/// A name beside the file that no other writer has, be it in this process, in another, or on
/// another machine that shares the folder. isTemporaryFile() knows it.
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

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
    throw InputError(file.string(), "", "cannot be written: " + reason);
}

using Write = std::function<void(std::ostream&)>;

/// The file that is to be replaced. A link stays, and what it leads to is replaced.
std::filesystem::path targetOf(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!exists(status)) return file;
    if (!is_regular_file(status)) fail(file, "it is not a regular file");
    return std::filesystem::is_symlink(file) ? std::filesystem::canonical(file) : file;
}

/// @param onWritten called before the temporary file is renamed
void writeAndRename(const std::filesystem::path& file, const Write& write,
                    const std::function<void(const std::filesystem::path&)>& onWritten) {
    const std::filesystem::path target = targetOf(file);
    const TemporaryFile temporary(target);
    errno = 0;
    std::ofstream stream(temporary.path(), std::ios::binary);
    stream.imbue(std::locale::classic());  // a point in numbers, and no other separator
    if (stream) write(stream);
    stream.close();
    if (!stream) fail(file, errno != 0 ? std::strerror(errno) : "input/output error");
    onWritten(temporary.path());

    std::error_code error;
    std::filesystem::rename(temporary.path(), target, error);
    if (error) fail(file, error.message());
}

Write writing(std::string_view content) {
    return [content](std::ostream& stream) {
        stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    };
}

}  // namespace

void writeFileAtomically(const std::filesystem::path& file, const Write& write) {
    writeAndRename(file, write, [](const auto& /*temporary*/) {});
}

void writeFileAtomically(const std::filesystem::path& file, std::string_view content) {
    writeFileAtomically(file, writing(content));
}

bool isTemporaryFile(const std::filesystem::path& file) {
    static const std::regex kName{R"(\.tmp(-\d+){3})"};
    return std::regex_match(file.extension().string(), kName);
}

void replaceFile(const std::filesystem::path& file, std::string_view content) {
    writeAndRename(file, writing(content),
                   [&](const auto& temporary) { synchronise(temporary, file); });
    synchronise(std::filesystem::absolute(file).parent_path(), file);
}

void synchronise(const std::filesystem::path& path, const std::filesystem::path& reported) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const bool failed = file < 0 || fsync(file) != 0;
    const int reason = errno;
    if (file >= 0) close(file);
    if (failed) fail(reported, std::strerror(reason));
}

}  // namespace photonav
