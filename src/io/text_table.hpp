// SPDX-License-Identifier: BSD-3-Clause
// Strict reading of text tables with blanks between the fields, as TUM's and evo's files are, or
// commas, as EuRoC's.
#pragma once

#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "io/error.hpp"

namespace photonav {

/// One line of a table; its errors name file and line.
class TextRow {
  public:
    TextRow(std::string file, int line, std::vector<std::string> fields)
        : file_(std::move(file)), line_(line), fields_(std::move(fields)) {}

    const std::string& text(std::size_t column) const { return fields_[column]; }

    /// @throws InputError unless the whole field is a finite number
    double number(std::size_t column) const;

    /// A time stamp [s]. @param unit of the field [s]
    /// @throws InputError unless it is a number within 1e10 s of zero (three centuries), beyond
    ///         which differences lose their digits and at last overflow
    double time(std::size_t column, double unit = 1.) const;

    /// "FILE: line N: reason"
    InputError error(const std::string& reason) const;
    /// @throws InputError error(reason)
    [[noreturn]] void fail(const std::string& reason) const { throw error(reason); }

  private:
    std::string file_;
    int line_;
    std::vector<std::string> fields_;
};

/// The fields of a line, without the blanks around them. A comma at the end ends the last field.
std::vector<std::string> splitAtCommas(std::string_view line);

/// Opens a text file for reading as openToRead() does. A byte order mark at its beginning, as
/// editors of Windows write it, is skipped.
/// @throws InputError also for a file with a zero byte within its first 1000 bytes
std::ifstream openText(const std::string& file);

/// All rows of a file, without blank lines and lines that start with '#'.
/// @throws InputError for a missing file, and for a row that does not have `columns` fields; if
///         `badRows` is given, such rows are skipped and their errors are appended to it instead
std::vector<TextRow> readTable(const std::string& file, std::size_t columns,
                               std::vector<InputError>* badRows = nullptr);

/// As readTable(), for fields that are separated by commas, as in EuRoC's files. Blanks around a
/// field are ignored, and a row may have more fields than `leastColumns`.
std::vector<TextRow> readCsv(const std::string& file, std::size_t leastColumns,
                             std::vector<InputError>* badRows = nullptr);

}  // namespace photonav
