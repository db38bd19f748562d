// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace photonav {

/// Escapes line breaks and other control characters in a text ("\n", "\x1b"), so that text from a
/// file can neither break a message into lines nor control a terminal.
inline std::string oneLine(std::string_view text) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string line;
    for (const char character : text) {
        const auto code = static_cast<unsigned char>(character);
        if (code >= 0x20 && code != 0x7F) {
            line += character;
        } else if (character == '\n') {
            line += "\\n";
        } else {
            line += {'\\', 'x', kDigits[code >> 4U], kDigits[code & 15U]};
        }
    }
    return line;
}

/// Bad input: a file, an option or a configuration value that cannot be used. what() is one line
/// "FILE: KEY: REASON" (or "FILE: REASON" when no key applies); the executable prints it and exits
/// with 2.
class InputError : public std::runtime_error {
  public:
    InputError(const std::string& file, const std::string& key, const std::string& reason)
        : std::runtime_error(
              oneLine(key.empty() ? file + ": " + reason : file + ": " + key + ": " + reason)),
          reason_(oneLine(key.empty() ? reason : key + ": " + reason)) {}

    /// what() without the file.
    const std::string& reason() const { return reason_; }

  private:
    std::string reason_;
};

}  // namespace photonav
