// SPDX-License-Identifier: BSD-3-Clause
#include "commands/export_command.hpp"

#include <fmt/format.h>

#include "commands/command_io.hpp"
#include "interchange/result_export.hpp"
#include "io/atomic_file.hpp"

namespace photonav {

namespace fs = std::filesystem;

int runExport(fs::path folder, fs::path file, bool quiet) {
    folder = folder.lexically_normal();
    if (!folder.has_filename()) folder = folder.parent_path();  // without a closing slash
    const McapExport result = exportMcap(folder);
    if (file.empty()) file = folder.string() + ".mcap";
    writeFileAtomically(file, result.content);
    if (!quiet) {
        fmt::print("{}: {} messages over {:.1f} s, {:.1f} MB\n", file.string(), result.messages,
                   result.duration, 1e-6 * static_cast<double>(result.content.size()));
    }
    return kDone;
}

}  // namespace photonav
