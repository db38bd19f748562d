// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <new>
#include <string>

#include "io/error.hpp"

namespace photonav {

/// Runs what reads a file. What a library throws, and memory that runs out, becomes an InputError
/// that names the file.
template <typename Read>
auto reading(const std::string& file, const Read& read) {
    try {
        return read();
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw InputError(file, "", "needs more memory than there is");
    } catch (const std::exception& error) {
        throw InputError(file, "", error.what());
    }
}

/// A file to read. An error on the way throws; of its own accord a stream would just end early.
inline std::ifstream openToRead(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    stream.exceptions(std::ios::badbit);
    return stream;
}

}  // namespace photonav
