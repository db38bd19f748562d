// SPDX-License-Identifier: BSD-3-Clause
// Files that earlier runs left: the journals of a sweep and of explorations, the table of
// reference paths, the report's data, the log of a flight, the manifest of a result folder.
#include <sstream>

#include "exploration/trial_journal.hpp"
#include "flightlog/flight_log.hpp"
#include "fuzz_input.hpp"
#include "io/folder_transaction.hpp"
#include "report/report.hpp"
#include "result/json_values.hpp"
#include "sweep/reference_table.hpp"
#include "sweep/sweep_journal.hpp"

namespace {

using namespace photonav;

/// Lines with checksums that fit: the reader would know at once that the others were changed.
std::string withChecksums(std::string_view input) {
    std::istringstream lines{std::string(input)};
    std::string journal;
    for (std::string line; std::getline(lines, line);) {
        journal += line.empty() ? line : photonav::withChecksum(line);
        if (!lines.eof()) journal += '\n';
    }
    return journal;
}

/// What was read is written, and read again as the same.
void readTrials(std::string_view input) {
    const auto linesOf = [](const TrialJournal& journal) {
        std::string lines;
        for (const ExplorationResult& flight : journal.runs())
            lines += compactJson(TrialKind::save(flight, fuzz::folder()));
        return lines;
    };
    fuzz::write("trials.jsonl", withChecksums(input));
    const TrialJournal journal = TrialJournal::read(fuzz::folder());
    TrialJournal::create(fuzz::folder(), journal.header(), journal.runs());
    fuzz::require(linesOf(TrialJournal::read(fuzz::folder())) == linesOf(journal),
                  "a journal that was written is read as it was");
}

}  // namespace

void photonav::fuzz::run(std::string_view input) {
    const unsigned choice = takeChoice(input, 6);
    check([&] {
        if (choice == 0) {
            write("runs.jsonl", withChecksums(input));
            SweepJournal::read(folder());
        } else if (choice == 1) {
            const std::array<std::string, 2> names{"table.csv", "table_paths.csv"};
            writeParts(names, input);
            ReferenceTable(folder() / "table.csv").read();
        } else if (choice == 2) {
            readReportJson(write("report.json", input));
        } else if (choice == 3) {
            readFlightLog(write("flight.json", input));
        } else if (choice == 4) {
            write("result/.photonav", input);
            Manifest::read(folder() / "result").foreignFile(folder() / "result");
        } else {
            readTrials(input);
        }
    });
}
