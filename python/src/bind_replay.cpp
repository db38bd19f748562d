// SPDX-License-Identifier: BSD-3-Clause
// Recorded flights.
#include <cctype>
#include <nlohmann/json.hpp>

#include "bindings.hpp"
#include "config/key_table.hpp"
#include "conversions.hpp"
#include "interruptible.hpp"
#include "io/error.hpp"
#include "replay/replay.hpp"
#include "replay/replay_config.hpp"
#include "replay/replay_errors.hpp"
#include "replay/replay_result.hpp"

namespace photonav::python {
namespace {

/// True and False as YAML spells them, all else as it is printed.
std::string textOf(const py::handle& value) {
    if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
    if (py::hasattr(value, "__fspath__")) return pathOf(py::reinterpret_borrow<py::object>(value));
    return py::str(value);
}

ReplayOptions optionsOf(const py::object& dataset, const py::kwargs& given) {
    ReplayOptions options;
    KeyTable keys;
    addKeys(keys, options);
    for (const auto& [name, value] : given) {
        const auto path = name.cast<std::string>();
        const ConfigKey* key = keys.find(path);
        if (key == nullptr || path == "dataset") {
            std::vector<std::string> known;
            for (const ConfigKey& each : keys.keys()) known.push_back(each.path());
            const std::string near = nearestWord(path, known);
            throw InputError(
                "replay", path,
                near.empty() ? "no such option" : "no such option, did you mean '" + near + "'?");
        }
        try {
            key->set(textOf(value));
        } catch (const InputError& error) {
            throw InputError("replay", "", error.reason());
        }
    }
    options.dataset = pathOf(dataset);
    return options;
}

/// An error that names options as this function does: "--least-sigma" is least_sigma.
InputError withNamesOfOptions(const InputError& error) {
    std::string text;
    bool isOption = false;
    const std::string given = error.what();
    for (std::size_t i = 0; i < given.size(); ++i) {
        if (given.compare(i, 2, "--") == 0) {
            isOption = true;
            i += 2;
        }
        isOption = isOption && i < given.size() && (std::islower(given[i]) != 0 || given[i] == '-');
        if (i < given.size()) text += isOption && given[i] == '-' ? '_' : given[i];
    }
    return {"replay", "", text};
}

py::dict replayed(const py::object& dataset, const py::kwargs& given) {
    const ReplayOptions options = optionsOf(dataset, given);
    nlohmann::json numbers;
    std::vector<double> times;
    std::vector<Pose> poses;
    std::vector<Matrix6> covariances;
    const auto track = [&](const std::atomic<bool>& interrupted) {
        const Replay replay(options);
        const ReplayRun run = replay.run([&] { return interrupted.load(); });
        numbers = replayResult(replay.recording().sequence, run, evaluate(run));
        for (const ReplayedFrame& frame : run.frames) {
            if (frame.status != FrameStatus::tracked) continue;
            times.push_back(frame.timestamp);
            poses.push_back(frame.tracked.T_c_w.mean);
            covariances.push_back(frame.tracked.T_c_w.covariance);
        }
    };
    try {
        interruptible(track);
    } catch (const InputError& error) {
        if (std::string(error.what()).find("--") == std::string::npos) throw;
        throw withNamesOfOptions(error);
    }
    py::dict result = objectOf(numbers);
    result["time"] = stacked(times);
    result["T_c_w"] = stacked(poses);
    result["covariance"] = stacked(covariances);
    return result;
}

}  // namespace

void bindReplay(py::module_& module) {
    using namespace py::literals;
    module.def(
        "replay", &replayed, "dataset"_a,
        "Tracks a recorded flight: result.json of `photonav replay` as a dictionary, and the "
        "arrays time (N,), T_c_w (N, 4, 4) and covariance (N, 6, 6) of the tracked frames. "
        "Options are the keys of `photonav keys --of replay`.");
}

}  // namespace photonav::python
