// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <locale>
#include <new>
#include <sstream>
#include <string>
#include <system_error>

#include "io/error.hpp"
#include "io/interrupted.hpp"

namespace photonav {

/// Calls a function that reads a file. Exceptions of libraries, and std::bad_alloc, become an
/// InputError that names the file; InputError and Interrupted are passed on.
template <typename Read>
auto reading(const std::string& file, const Read& read) {
    try {
        return read();
    } catch (const InputError&) {
        throw;
    } catch (const Interrupted&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw InputError(file, "", "needs more memory than there is");
    } catch (const std::exception& error) {
        throw InputError(file, "", error.what());
    }
}

/// Opens a file for reading; the stream is not open if the file is missing. Read errors throw
/// std::ios::failure, because by default a stream would only end early.
/// @throws InputError for folders, pipes and devices (some of them never end), for a file without
///         permission to read, and for a path that cannot be followed
inline std::ifstream openIfThere(const std::string& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::status_known(status)) {
        throw InputError(file, "", "cannot be opened: " + error.message());
    }
    const bool isThere = std::filesystem::exists(status);
    if (isThere && !std::filesystem::is_regular_file(status)) {
        throw InputError(file, "", "not a file");
    }
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (isThere && !stream) {
        throw InputError(file, "", std::string("cannot be opened: ") + std::strerror(errno));
    }
    stream.imbue(std::locale::classic());
    stream.exceptions(std::ios::badbit);
    return stream;
}

/// Opens a file for reading as openIfThere() does; the file must exist.
/// @throws InputError "no such file" as well
inline std::ifstream openToRead(const std::string& file) {
    std::ifstream stream = openIfThere(file);
    if (!stream) throw InputError(file, "", "no such file");
    return stream;
}

/// A stream over the words and numbers of a line. The decimal separator is a point in every locale.
inline std::istringstream wordsOf(const std::string& line) {
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    return words;
}

}  // namespace photonav
