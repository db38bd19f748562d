// SPDX-License-Identifier: BSD-3-Clause
// Journals with lines that a test has changed.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "runs/journal_file.hpp"

namespace photonav::test {

/// The lines of a journal without their checksums; a cut line as it is.
inline std::string withoutChecksums(const std::string& journal) {
    std::istringstream lines(journal);
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        text += lines.eof() ? line : withoutChecksum(line) + "\n";
    }
    return text;
}

/// Writes a journal of such lines, whose checksums fit.
inline void writeJournal(const std::filesystem::path& file, const std::string& text) {
    std::istringstream lines(text);
    std::ofstream stream(file);
    for (std::string line; std::getline(lines, line);) stream << withChecksum(line) << "\n";
}

}  // namespace photonav::test
