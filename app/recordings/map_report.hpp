// SPDX-License-Identifier: BSD-3-Clause
// The report of a map made from a recording.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mapping/map_result.hpp"
#include "recordings/map_command.hpp"
#include "report/problem_report.hpp"

namespace photonav {

/// Results of mapping in addition to the map.
struct MapRun : FusedRecording {
    /// Comparisons of frames with their predictions.
    nlohmann::json compared = nlohmann::json::array();
    std::vector<NamedFigure> figures;
    std::vector<ReportFrame> pictures;  ///< of compared frames, evenly spread
    bool interrupted = false;
};

/// The image of a used frame beside the prediction of the map and their difference.
/// @param number of the frame among the used ones
ReportFrame pictureOf(const RecordedFrame& frame, std::size_t number, const View& predicted);

/// A perspective view of the map, from above one of its corners: overview.
NamedFigure overview(const TexturedOcTree& map, const std::string& title);

/// The main numbers of result.json, with labels.
ReportTable mapSummary(const nlohmann::json& result);

/// Writes the figures, config.yaml, report.json and report.html.
void writeMapReport(const std::filesystem::path& folder, const MapCommandOptions& options,
                    const nlohmann::json& result, const Recording& recording,
                    const TexturedOcTree& map, const MapRun& run);

}  // namespace photonav
