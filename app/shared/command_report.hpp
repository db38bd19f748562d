// SPDX-License-Identifier: BSD-3-Clause
// What a command that wrote a result folder tells its caller.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "report/report.hpp"

namespace photonav {

struct CommandReport {
    std::filesystem::path folder;  ///< where the result is; empty if there is none
    nlohmann::json result;         ///< content of result.json
    ReportTable summary;           ///< main numbers of the result, for terminal and page
    int exitCode = 0;              ///< kInterrupted when interrupted, kNoAnswer without an answer
};

}  // namespace photonav
