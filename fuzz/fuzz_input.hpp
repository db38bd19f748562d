// SPDX-License-Identifier: BSD-3-Clause
// What the fuzz targets share: bytes become files in memory, and a reader may do two things with
// them, read them or refuse them in one line.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace photonav::fuzz {

/// A folder in memory that is gone when the process ends.
const std::filesystem::path& folder();

/// Writes a file of that folder, its own folders included.
/// @returns its path
std::string write(const std::string& name, std::string_view content);

/// Takes what comes before the next separator line "====", and the line.
std::string_view takePart(std::string_view& input);

/// Writes one file per name from the parts of an input; a file with an empty part is not there.
void writeParts(std::span<const std::string> names, std::string_view input);

/// Runs a reader. An InputError of one line is an answer; anything else that is thrown, a crash,
/// more than the memory limit or more than the time limit is a finding.
void check(const std::function<void()>& read);

/// Ends the process as a finding unless the condition holds.
void require(bool condition, const char* what);

/// Takes the first byte of an input, which chooses between readers; 0 when there is none.
unsigned takeChoice(std::string_view& input, unsigned choices);

/// The body of a fuzz target.
void run(std::string_view input);

}  // namespace photonav::fuzz
