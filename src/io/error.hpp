// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace photonav {

/// Bad input: a file, an option or a configuration value that cannot be used. what() is one line
/// "FILE: KEY: REASON" (or "FILE: REASON" when no key applies); the executable prints it and exits
/// with 2.
class InputError : public std::runtime_error {
  public:
    InputError(const std::string& file, const std::string& key, const std::string& reason)
        : std::runtime_error(key.empty() ? file + ": " + reason
                                         : file + ": " + key + ": " + reason),
          reason_(key.empty() ? reason : key + ": " + reason) {}

    /// what() without the file.
    const std::string& reason() const { return reason_; }

  private:
    std::string reason_;
};

}  // namespace photonav
