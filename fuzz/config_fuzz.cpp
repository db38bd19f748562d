// SPDX-License-Identifier: BSD-3-Clause
// Configs of planning problems: what was read can be written, and read again as the same.
#include "config/config.hpp"
#include "fuzz_input.hpp"

void photonav::fuzz::run(std::string_view input) {
    check([&] {
        const std::string text = toYaml(loadConfig(write("config.yaml", input), {}));
        const std::string again = toYaml(loadConfig(write("again.yaml", text), {}));
        require(text == again, "a config that was written is read as it was");
    });
}
