# SPDX-License-Identifier: BSD-3-Clause
"""scripts/measure: tables of results, a run that ended is not run again, and the pages get the tables and pictures."""

import importlib.machinery
import importlib.util
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PLANNER = {
    "arrived": 1, "astray": 0, "uncertain_arrivals": 2, "given_up": 0, "collisions": 0, "out_of_time": 0, "position_rmse_m": 0.0051,
    "predicted_sigma_m": 0.3104, "believed_sigma_m": None, "nees_per_dof": 1.234, "nees_median_flight_per_dof": 1,
    "nees_at_goal_per_dof": None, "goal_error_m": 0.0684, "mean_speed_mps": None,
}
TRIAL = {
    "end": "uncertain arrival", "arrival_probability": 0.456, "length": 9.23, "duration_s": 17.2, "goal_error_m": 0.05,
    "position_rmse_m": 0.027, "nees_per_dof": 0.764, "times_lost": 2, "updates": [],
}
SUMMARY = {"length": 9.23, "duration_s": 17.2, "goal_error_m": 0.05, "position_rmse_m": 0.027, "nees_per_dof": 0.764,
           "nees_median_flight_per_dof": 0.764, "update_median_ms": 18.5, "decided_after_m": 2.34, "mean_trace": 0.0125, "goal_trace": 0.0375}
FLOWN = {"seed": 1, "planners": [{"planner": "belief_rrt_star", **PLANNER}, {"planner": "rrt_star", **PLANNER}]}
EXPLORED = {"summary": [{"planner": "rrt_star", **SUMMARY}],
            "trials": [{"planner": "rrt_star", "seed": seed, **TRIAL} for seed in (1, 2)] +
                      [{"planner": "belief_rrt_star", "seed": 1, **TRIAL}]}
# In place of photonav: writes the result that it is given into its result folder, and says so
PROGRAM = """#!/bin/bash
echo "$1" >> {folder}/calls
[ "$1" != "${{FAILS:-}}" ] || exit 2
mkdir -p "${{@: -1}}" && cp {folder}/result.json "${{@: -1}}"
exit 1
"""


def moduleOf(script):
    loader = importlib.machinery.SourceFileLoader(pathlib.Path(script).stem.replace("-", "_"), str(ROOT / "scripts" / script))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


class Tables(unittest.TestCase):
    def setUp(self):
        self.tables = moduleOf("measured_tables.py")

    def test_flightsWithoutWhatIsMissing(self):
        first, _, *rows = self.tables.table(list(self.tables.flightRows("room", FLOWN)))
        self.assertNotIn("seed", first)
        self.assertEqual(rows, [
            "| room | belief_rrt_star | 1 arrived, 2 uncertain | 5.1 mm | 310 mm |  | 1.23 | 1.00 |  | 68 mm |  |",
            "| | rrt_star | 1 arrived, 2 uncertain | 5.1 mm | 310 mm |  | 1.23 | 1.00 |  | 68 mm |  |"])

    def test_seedsWhereTheyDiffer(self):
        rows = [row for seed in (1, 2) for row in self.tables.flightRows("room", {**FLOWN, "seed": seed})]
        self.assertIn("| config | seed |", next(self.tables.table(rows)))

    def test_endsOfAllSeedsAreCountedTogether(self):
        _, _, *rows = self.tables.table(list(self.tables.endRows("room", FLOWN, FLOWN)))
        self.assertEqual(rows, ["| room | belief_rrt_star | 2 arrived, 4 uncertain |", "| | rrt_star | 2 arrived, 4 uncertain |"])

    def test_explorationsOfAPlannerCountItsFlights(self):
        (row,) = self.tables.explorationRows("kitchen", EXPLORED)
        self.assertEqual(row["ends"], "2 uncertain")
        self.assertEqual(row["times lost"], "4")
        self.assertEqual(row["decided after"], "2.3 m")
        self.assertEqual([row["seed"] for row in self.tables.trialRows("kitchen", EXPLORED)], ["1", "2", "1"])

    def test_aShortReplayHasNoRelativeErrors(self):
        errors = dict.fromkeys(["ate_rmse_m", "ate_rotation_rmse_deg", "ate_max_m", "nees_per_dof", "nees_median_per_dof"])
        parts = dict.fromkeys(["nees_position_per_dof", "nees_rotation_per_dof"], {"mean": None, "median": 1.15})
        result = {**errors, **parts, "tracked": 1, "degenerate": 1, "frames": 2, "converged_beyond_5_sigma": 0,
                  "rpe": {"frame": {"translation_m": 0.0053, "rotation_deg": 0.21}, "second": None}}
        (row,) = self.tables.replayRows("castle", result)
        self.assertEqual(row["per frame"], "5.3 mm, 0.21 deg")
        self.assertEqual(row["per second"], "")
        self.assertEqual(row["median of position, rotation"], "1.15, 1.15")


class Measure(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        (self.folder / "result.json").write_text(json.dumps(EXPLORED))
        (self.folder / "photonav").write_text(PROGRAM.format(folder=self.folder))
        (self.folder / "photonav").chmod(0o755)

    def tearDown(self):
        self.temporary.cleanup()

    def measure(self, *arguments, **environment):
        script = [ROOT / "scripts/measure", "--build", self.folder, "--out", self.folder / "out", *arguments]
        return subprocess.run(script, capture_output=True, text=True, env={**os.environ, **environment})

    def calls(self):
        return (self.folder / "calls").read_text().split()

    def test_whatEndedIsNotRunAgain(self):
        failed = self.measure("explorations", FAILS="explore")
        self.assertEqual(failed.returncode, 2)
        self.assertFalse((self.folder / "out/explorations.md").exists())
        self.assertEqual(self.calls(), ["explore"])
        self.assertEqual(self.measure("explorations").returncode, 0)
        self.assertEqual(len(self.calls()), 8)
        self.assertEqual(self.measure("explorations").returncode, 0)
        self.assertEqual(len(self.calls()), 8)
        self.assertEqual(self.measure("explorations", "--trials", "5").returncode, 0)
        self.assertEqual(len(self.calls()), 15)

    def test_faultyFlightsOfFiveSeedsAreOneRow(self):
        (self.folder / "result.json").write_text(json.dumps(FLOWN))
        self.assertEqual(self.measure("faults").returncode, 0)
        self.assertEqual(self.calls(), (["plan"] + ["fly"] * 5) * 4)
        self.assertIn("| kitchen | belief_rrt_star | 5 arrived, 10 uncertain |\n", (self.folder / "out/faults.md").read_text())

    def test_pagesGetTheTables(self):
        self.measure("explorations")
        update = moduleOf("update-docs")
        tables = update.measured(self.folder / "out")
        page = "Before.\n<!-- measured explorations -->\nold\n<!-- end -->\nAfter.\n<!-- measured others -->\nstay\n<!-- end -->\n"
        new = update.refreshed(page, None, tables)
        self.assertRegex(new, r"Before.\n<!-- measured explorations -->\n\*4 flights .* Commit .*\n\n\| config \|")
        self.assertTrue(new.endswith("|\n<!-- end -->\nAfter.\n<!-- measured others -->\nstay\n<!-- end -->\n"))
        self.assertEqual(update.refreshed(new, None, tables), new)

    def test_picturesOfQuotedProgramsAreReplaced(self):
        program, pictures = self.folder / "tutorials/tutorial-1", self.folder / "images"
        program.parent.mkdir()
        program.write_text("#!/bin/bash\necho 7 cm; echo new > shown.png; echo new > other.png\n")
        program.chmod(0o755)
        pictures.mkdir()
        (pictures / "shown.png").write_text("old\n")
        update = moduleOf("update-docs")
        page = update.refreshed("<!-- output tutorial-1 1-1 -->\n```\n8 cm\n```\n", self.folder, {})
        self.assertIn("\n7 cm\n", page)
        update.replacePictures(page, self.folder, pictures)
        self.assertEqual((pictures / "shown.png").read_text(), "new\n")
        self.assertFalse((pictures / "other.png").exists())


if __name__ == "__main__":
    unittest.main()
