// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_input.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "io/error.hpp"

namespace photonav::fuzz {
namespace fs = std::filesystem;
namespace {

struct TemporaryFolder {
    fs::path path = (fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path()) /
                    fs::path("photonav-fuzz-" + std::to_string(getpid()));

    TemporaryFolder() { fs::create_directories(path); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

}  // namespace

const fs::path& folder() {
    static const TemporaryFolder temporary;
    return temporary.path;
}

std::string write(const std::string& name, std::string_view content) {
    const std::string path = (folder() / name).string();
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) {
        fs::create_directories(fs::path(path).parent_path());
        file = std::fopen(path.c_str(), "wb");
    }
    require(file != nullptr, "the file system of the fuzz target takes a file");
    std::fwrite(content.data(), 1, content.size(), file);
    std::fclose(file);
    return path;
}

std::string_view takePart(std::string_view& input) {
    constexpr std::string_view kSeparator = "\n====\n";
    const std::size_t end = input.find(kSeparator);
    const std::string_view part = input.substr(0, end);
    input.remove_prefix(end == std::string_view::npos ? input.size() : end + kSeparator.size());
    return part;
}

void writeParts(std::span<const std::string> names, std::string_view input) {
    for (const std::string& name : names) {
        const std::string_view part = takePart(input);
        if (part.empty()) {
            unlink((folder() / name).c_str());
        } else {
            write(name, part);
        }
    }
}

void check(const std::function<void()>& read) {
    try {
        read();
    } catch (const InputError& error) {
        const std::string_view message = error.what();
        require(!message.empty(), "an error says something");
        require(message.find('\n') == std::string_view::npos, "an error is one line");
    }
}

void require(bool condition, const char* what) {
    if (condition) return;
    std::fprintf(stderr, "does not hold: %s\n", what);
    std::abort();
}

unsigned takeChoice(std::string_view& input, unsigned choices) {
    if (input.empty()) return 0;
    const auto choice = static_cast<unsigned char>(input.front()) % choices;
    input.remove_prefix(1);
    return choice;
}

}  // namespace photonav::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    photonav::fuzz::run({reinterpret_cast<const char*>(bytes), size});
    return 0;
}
