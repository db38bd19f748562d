// SPDX-License-Identifier: BSD-3-Clause
#include "atomic_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "error.hpp"

namespace photonav {

void writeFileAtomically(const std::filesystem::path& file, std::string_view content) {
    const std::filesystem::path temporary =
        file.string() + ".tmp" + std::to_string(static_cast<long>(getpid()));
    const auto fail = [&](const std::string& reason) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw InputError(file.string(), "", "cannot be written: " + reason);
    };

    errno = 0;
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) fail(errno != 0 ? std::strerror(errno) : "input/output error");

    std::error_code error;
    std::filesystem::rename(temporary, file, error);
    if (error) fail(error.message());
}

}  // namespace photonav
