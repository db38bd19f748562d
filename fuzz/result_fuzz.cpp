// SPDX-License-Identifier: BSD-3-Clause
// Files that earlier runs left: the journal of a sweep, the table of reference paths, the report's
// data, the manifest of a result folder.
#include "fuzz_input.hpp"
#include "io/folder_transaction.hpp"
#include "report/report.hpp"
#include "sweep/reference_table.hpp"
#include "sweep/sweep_journal.hpp"

void photonav::fuzz::run(std::string_view input) {
    const unsigned choice = takeChoice(input, 4);
    check([&] {
        if (choice == 0) {
            write("runs.jsonl", input);
            SweepJournal::read(folder());
        } else if (choice == 1) {
            const std::array<std::string, 2> names{"table.csv", "table_paths.csv"};
            writeParts(names, input);
            ReferenceTable(folder() / "table.csv").read();
        } else if (choice == 2) {
            readReportJson(write("report.json", input));
        } else {
            write("result/.photonav", input);
            Manifest::read(folder() / "result").foreignFile(folder() / "result");
        }
    });
}
