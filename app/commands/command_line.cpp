// SPDX-License-Identifier: BSD-3-Clause
#include "commands/command_line.hpp"

#include <fmt/format.h>

#include <set>

#include "io/error.hpp"

namespace photonav {
namespace {

const CLI::Validator& notEmpty() {
    static const CLI::Validator validator(
        [](const std::string& text) {
            return std::string(text.empty() ? "must not be empty" : "");
        },
        "");
    return validator;
}

}  // namespace

void addOutput(CLI::App& parser, OutputOptions output, const std::string& defaultFolder) {
    parser
        .add_option("--out", output.out, fmt::format("result folder (default: {})", defaultFolder))
        ->check(notEmpty());
    parser.add_flag("--quiet", output.quiet, "no progress, no summary");
    parser.add_flag("--json", output.json, "result.json on standard output");
}

void printOutput(const OutputOptions& output, const nlohmann::json& result,
                 const ReportTable& summary, const std::vector<std::string>& files) {
    if (output.json) {
        fmt::print("{}\n", result.dump(2));
        return;
    }
    if (output.quiet) return;
    for (const auto& [label, value] : summary.rows) fmt::print("{:<42}{}\n", label, value);
    for (const std::string& file : files) {
        fmt::print("{}: {}\n", std::filesystem::path(file).stem().string(),
                   (output.out / file).string());
    }
}

void addOverrides(CLI::App& parser, std::vector<std::string>& overrides) {
    parser
        .add_option("--set", overrides, "override a value of the config (photonav keys lists them)")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
}

void addCommon(CLI::App& parser, CommandOptions& options, bool needsConfig) {
    parser.add_option("config", options.config, "YAML file of the planning problem")
        ->required(needsConfig);
    addOverrides(parser, options.overrides);
    addOutput(parser, {options.out, options.quiet, options.json}, "out/<command>-<config>");
}

void addRecording(CLI::App& parser, RecordingOptions& options) {
    parser.add_option("--camera", options.cameraFile,
                      "camera.yaml to use instead of the dataset's");
    parser
        .add_option("--up", options.up,
                    "upward direction of the recorded world: x ... -z, a direction x,y,z, or floor")
        ->capture_default_str();
    parser.add_option("--every", options.every, "use every n-th frame")->capture_default_str();
    parser.add_option("--frames", options.frames, "only the frames from a on and before b")
        ->type_name("A:B");
    parser.add_option("--depth-scale", options.depthScale,
                      "depth image value of one metre (default: the dataset's)");
    parser.add_option("--stereo", options.stereo,
                      "bm or sgbm: block matching (default), semi-global; for EuRoC recordings");
    parser.add_option("--tolerance", options.tolerance, "largest difference of timestamps [s]")
        ->capture_default_str();
}

std::string folderName(const std::string& path) {
    return (std::filesystem::path(path) / "").lexically_normal().parent_path().filename().string();
}

void refuseOptionsBeside(const std::string& config, const CLI::App& parser) {
    static const std::set<std::string> allowed{"--out", "--quiet", "--json"};
    for (const CLI::Option* option : parser.get_options()) {
        const std::string name = option->get_name();
        if (option->count() > 0 && name.starts_with("--") && !allowed.contains(name)) {
            throw InputError(name, "", "not together with a config; edit " + config);
        }
    }
}

}  // namespace photonav
