#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints a table of results for a page.

usage: measured_tables.py NAME KIND CAPTION ROW=FOLDER...

FOLDER is a result folder of photonav, and ROW is what the table calls it. KIND is flights (results of fly), ends (of fly: how
flights ended; with ROW=FOLDER,FOLDER... those of several folders are counted together), explorations or trials (of explore: a
row for each planner, or for each flight), replays, depth (of map --depth monocular), or paper (of sweep). With KIND text, one
file is quoted as it is.
The table is enclosed in <!-- measured NAME --> and <!-- end -->, as in the pages.
"""

import json
import pathlib
import statistics
import sys

ENDS = {  # in a table, and the keys of fly's summary
    "arrived": "arrived", "uncertain": "uncertain_arrivals", "astray": "astray", "lost": "given_up",
    "collided": "collisions", "out of time": "out_of_time",
}


def number(value, digits):
    return "" if value is None else f"{value:.{digits}f}"


def millimetres(metres):
    if metres is None:
        return ""
    return f"{metres * 1000:.{1 if abs(metres) < 0.01 else 0}f} mm"


def ends(counts):
    """Numbers of flights by their end, without those that are 0."""
    return ", ".join(f"{n} {name}" for name, n in counts.items() if n)


def flightRows(label, result):
    for s in result["planners"]:
        yield {
            "config": label,
            "seed": str(result["seed"]),
            "planner": s["planner"],
            "ends": ends({name: s[key] for name, key in ENDS.items()}),
            "error": millimetres(s["position_rmse_m"]),
            "predicted": millimetres(s["predicted_sigma_m"]),
            "believed": millimetres(s["believed_sigma_m"]),
            "NEES": number(s["nees_per_dof"], 2),
            "median flight": number(s["nees_median_flight_per_dof"], 2),
            "at the goal": number(s["nees_at_goal_per_dof"], 2),
            "goal error": millimetres(s["goal_error_m"]),
            "speed": number(s["mean_speed_mps"], 2) + " m/s" if s["mean_speed_mps"] else "",
        }


def endRows(label, *results):
    for summaries in zip(*(result["planners"] for result in results)):
        yield {
            "config": label,
            "planner": summaries[0]["planner"],
            "ends": ends({name: sum(s[key] for s in summaries) for name, key in ENDS.items()}),
        }


def explorationRows(label, result):
    for s in result["summary"]:
        trials = [trial for trial in result["trials"] if trial["planner"] == s["planner"]]
        counts = dict.fromkeys(ENDS, 0)
        for trial in trials:
            name = trial["end"].removesuffix(" arrival")
            counts[name] = counts.get(name, 0) + 1
        yield {
            "config": label,
            "planner": s["planner"],
            "ends": ends(counts),
            "length": number(s["length"], 1) + " m",
            "duration": number(s["duration_s"], 0) + " s",
            "decided after": number(s["decided_after_m"], 1) + " m" if s["decided_after_m"] is not None else "",
            "mean trace": number(s["mean_trace"], 4) + " m²",
            "goal trace": number(s["goal_trace"], 4) + " m²",
            "goal error": millimetres(s["goal_error_m"]),
            "position error": millimetres(s["position_rmse_m"]),
            "NEES": number(s["nees_per_dof"], 2),
            "median flight": number(s["nees_median_flight_per_dof"], 2),
            "times lost": str(sum(trial["times_lost"] for trial in trials)),
            "median update": number(s["update_median_ms"], 0) + " ms",
        }


def trialRows(label, result):
    for trial in result["trials"]:
        updates = [update["fuse_ms"] + update["clearance_ms"] + update["plan_ms"] for update in trial["updates"]]
        yield {
            "config": label,
            "planner": trial["planner"],
            "seed": str(trial["seed"]),
            "end": trial["end"],
            "probability": number(trial["arrival_probability"], 2),
            "length": number(trial["length"], 1) + " m",
            "duration": number(trial["duration_s"], 0) + " s",
            "goal error": millimetres(trial["goal_error_m"]),
            "position error": millimetres(trial["position_rmse_m"]),
            "NEES": number(trial["nees_per_dof"], 2),
            "times lost": str(trial["times_lost"]),
            "median update": number(statistics.median(updates), 0) + " ms" if updates else "",
        }


def replayRows(label, result):
    def relative(key):
        error = result["rpe"][key]
        return error and f"{millimetres(error['translation_m'])}, {number(error['rotation_deg'], 2)} deg"

    position, rotation = result["nees_position_per_dof"], result["nees_rotation_per_dof"]
    yield {
        "recording": label,
        "tracked": f"{result['tracked']} of {result['frames']}",
        "degenerate": str(result["degenerate"]),
        "absolute, RMS": f"{millimetres(result['ate_rmse_m'])}, {number(result['ate_rotation_rmse_deg'], 2)} deg",
        "largest": millimetres(result["ate_max_m"]),
        "per frame": relative("frame") or "",
        "per second": relative("second") or "",
        "NEES": number(result["nees_per_dof"], 2),
        "median": number(result["nees_median_per_dof"], 2),
        "median of position, rotation": f"{number(position['median'], 2)}, {number(rotation['median'], 2)}",
        "beyond 5 sigma": str(result["converged_beyond_5_sigma"]),
    }


def depthRows(label, result):
    depth = result["monocular"]
    yield {
        "recording": label,
        "completeness": number(100 * depth["completeness"], 1) + " %",
        "relative error, median": number(100 * depth["median_relative_error"], 1) + " %",
        "90th percentile": number(100 * depth["p90_relative_error"], 1) + " %",
        "references": str(depth["references"]),
    }


def paperRows(label, result):
    """Our first planner beside the paper's Table I."""
    for s in result["summary"]:
        if s["planner"] != result["planners"][0]:
            continue
        row = {"config": label, "α": f"{s['alpha']:g}"}
        for name, key, digits in (("length [m]", "length", 2), ("mean trace [m²]", "mean_trace", 4), ("goal trace [m²]", "goal_trace", 4)):
            row[name] = number(s[f"{key}_mean"], digits)
            row[f"paper's {name.split(' [')[0]}"] = number(s[f"paper_{key}"], digits)
        yield row


KINDS = {"flights": flightRows, "ends": endRows, "explorations": explorationRows, "trials": trialRows, "replays": replayRows,
         "depth": depthRows, "paper": paperRows}


def table(rows):
    """Lines of a Markdown table. A first cell that repeats, and a column of seeds that are all the same, are left out."""
    columns = [name for name in rows[0] if name != "seed" or len({row["seed"] for row in rows}) > 1]
    yield "| " + " | ".join(columns) + " |"
    yield "|---" * len(columns) + "|"
    above = None
    for row in rows:
        first, *others = (row[name] for name in columns)
        yield "| " + " | ".join(["" if first == above else first, *others]).lstrip() + " |"
        above = first


def main():
    name, kind, caption, *rowsOfFolders = sys.argv[1:]
    if kind == "text":
        body = ["```", pathlib.Path(rowsOfFolders[0]).read_text().strip("\n"), "```"]
    else:
        rows = []
        for label, folders in (row.split("=", 1) for row in rowsOfFolders):
            results = (json.loads((pathlib.Path(folder) / "result.json").read_text()) for folder in folders.split(","))
            rows += KINDS[kind](label, *results)
        body = table(rows)
    print(f"<!-- measured {name} -->", f"*{caption}*\n", *body, "<!-- end -->\n", sep="\n")


if __name__ == "__main__":
    main()
