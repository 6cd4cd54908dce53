#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes tests/bench/TRUTH.md: six shared models at 200 mm through the real programs, verified, as measured.

    tests/bench/truth/truth.py --models ../shared/models --bin build/release/bin

Every figure comes from the report.json of `skinframe run`; the words are made from the figures, so that
nothing here can flatter. `skinframe check` has to hold for each result, or the run ends with 1.
"""
import argparse
import datetime
import json
import os
import pathlib
import subprocess
import sys
import tempfile

MODELS = ["fish", "hand", "koala_low", "nefertiti_70k", "penguin", "spot_low"]
LOADS = {"side": "side:top:20,0,0", "down": "down:top:0,0,-5"}
DESIGNS = [("skin_frame", "skin-frame"), ("hollow", "hollow"), ("solid", "solid"), ("skin_alone", "skin alone")]
PRINTER = "sinterstation-hiq"
EVEN = 0.01  # rows nearer than that are draws, as in the report


def run_model(programs, mesh, folder, size_mm):
    command = [programs / "skinframe", "run", mesh, "--printer", PRINTER, "--size", str(size_mm),
               "--out", folder]
    for load in LOADS.values():
        command += ["--load", load]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    subprocess.run([programs / "skinframe", "check", folder], check=True, stdout=subprocess.DEVNULL)
    for mesh_file in folder.rglob("*"):  # meshes are large and have been checked
        if mesh_file.suffix in {".stl", ".3mf", ".ply"}:
            mesh_file.unlink()


def shown(value, digits=3):
    return "-" if value is None else f"{value:.{digits}g}"


def load_figure(design, load, figure):
    for item in (design or {}).get("loads", []):
        if item["name"] == load:
            return item[figure]
    return None


def rows_of(verification):
    """(title, {design: figure}, less is better)."""
    designs = verification["comparison"]["designs"]
    take = lambda read: {key: read(designs[key]) if designs[key] else None for key, _ in DESIGNS}
    rows = [(f"moves at most, {load}, mm", take(lambda d: load_figure(d, load, "max_displacement_mm")), True)
            for load in LOADS]
    rows += [(f"gives way at the load, {load}, mm", take(lambda d: load_figure(d, load, "load_displacement_mm")), True)
             for load in LOADS]
    rows += [("pinch of 10 N, mean, mm", take(lambda d: d["pinch_mean_mm"]), True),
             ("pinch of 10 N, worst, mm", take(lambda d: d["pinch_max_mm"]), True)]
    rows += [(f"buckling factor, {load}", take(lambda d: load_figure(d, load, "buckling_factor")), False)
             for load in LOADS]
    return rows


def better(figures, less):
    ours, hollow = figures["skin_frame"], figures["hollow"]
    if ours is None or hollow is None:
        return "-"
    if abs(ours - hollow) <= EVEN * max(abs(ours), abs(hollow)):
        return "even"
    return "skin-frame" if (ours < hollow) == less else "hollow"


def section(name, printer, wins):
    v = printer["verification"]
    counts = printer["counts"]["geometry"]
    lines = [f"## {name}", ""]
    if v["label"] != "verified":
        return lines + [f"Not verified: {v['reason']}", ""]
    designs = v["comparison"]["designs"]
    lines += ["| | " + " | ".join(title for _, title in DESIGNS) + " | better at equal mass |",
              "|---|" + "--:|" * len(DESIGNS) + "---|",
              "| weight, g | " + " | ".join(shown(designs[k]["weight_g"]) if designs[k] else "-" for k, _ in DESIGNS)
              + " | |"]
    for title, figures, less in rows_of(v):
        who = better(figures, less)
        wins[who] = wins.get(who, 0) + 1
        lines.append(f"| {title} | " + " | ".join(shown(figures[k]) for k, _ in DESIGNS) + f" | {who} |")
    wall = f" of {v['hollow_thickness_mm']:.2f} mm wall" if "hollow_thickness_mm" in v else ""
    lines += ["", f"{counts['nodes']} nodes, {counts['struts']} struts; hollow{wall}. The paper's model says "
              f"{shown(printer['max_displacement_mm'])} mm where the valid one says "
              f"{shown(v['max_displacement_mm'])} mm. Safety factor {shown(v['safety_factor'])}, Euler factor of the "
              f"worst strut {shown(v['euler_factor'])}. Mesh of {v['mesh']['nodes']} nodes, error estimate "
              f"{100 * v['mesh']['error_estimate']:.1f} %. Report: {v['comparison']['verdict']}.", ""]
    for key, title in DESIGNS:
        if f"{key}_missing" in v["comparison"]:
            lines += [f"No figures of the {title}: {v['comparison'][key + '_missing']}.", ""]
    return lines


def summary(results):
    lines = ["## Self-check and time", "",
             "Reactions against loads, relative (the largest over all load cases and pinches); CPU seconds of the "
             "verification by stage, and for how long on the clock the job waited for it beyond the writing of its files, "
             "which goes on at the same time.", ""]
    stages = []
    for printer in results.values():
        for stage in printer["verification"].get("cpu_seconds", {}):
            if stage not in stages:
                stages.append(stage)
    stages.sort(key=["mesh", "pinch sites", "skin-frame", "skin alone", "hollow", "solid"].index)
    lines += ["| model | forces | moments | " + " | ".join(stages) + " | all | without the solid | waited |",
              "|---|" + "--:|" * (len(stages) + 5)]
    for name, printer in results.items():
        v = printer["verification"]
        if v["label"] != "verified":
            continue
        seconds = v["cpu_seconds"]
        total = sum(seconds.values())
        lines.append(f"| {name} | {v['balance']['force']:.0e} | {v['balance']['moment']:.0e} | "
                     + " | ".join(f"{seconds.get(s, 0):.1f}" for s in stages)
                     + f" | {total:.1f} | {total - seconds.get('solid', 0):.1f} | "
                     + f"{printer['seconds'].get('verify', 0):.1f} |")
    return lines + [""]


def machine():
    model = "unknown processor"
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    return f"{len(os.sched_getaffinity(0))} cores ({model}), load average {os.getloadavg()[2]:.0f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=pathlib.Path, required=True, help="folder of manifest.json")
    parser.add_argument("--bin", type=pathlib.Path, required=True, help="folder of skinframe and its worker")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent / "TRUTH.md")
    parser.add_argument("--size", type=float, default=200)
    parser.add_argument("--keep", type=pathlib.Path, help="folder of results; those already there are not run again")
    parser.add_argument("--only", nargs="*", default=MODELS, help="run these; the table has all that there are")
    asked = parser.parse_args()
    files = {entry["id"]: entry["file"] for entry in json.loads((asked.models / "manifest.json").read_text())["good"]}
    with tempfile.TemporaryDirectory() as temporary:
        keep = asked.keep or pathlib.Path(temporary)
        for name in asked.only:
            if not (keep / name / "report.json").exists():
                print(f"{name} ...", file=sys.stderr)
                run_model(asked.bin, asked.models / files[name], keep / name, asked.size)
        results = {name: json.loads((keep / name / "report.json").read_text())["printers"][0]
                   for name in MODELS if (keep / name / "report.json").exists()}
    version = subprocess.run([asked.bin / "skinframe", "--version"], check=True, capture_output=True, text=True)
    wins = {}
    sections = [line for name, printer in results.items() for line in section(name, printer, wins)]
    words = ", ".join(f"{who} {count}" for who, count in sorted(wins.items(), key=lambda item: -item[1]))
    head = ["# Truth: what the valid model says of our results", "",
            "Written by `tests/bench/truth/truth.py`, which runs the real programs; not edited by hand.", "",
            f"{datetime.date.today()}, {version.stdout.strip()}, {machine()}. Largest edge {asked.size:g} mm, "
            f"{PRINTER}, its default material; 20 N sideways at the top (x), 5 N down at the top, own weight in "
            "either, each design its own, the solid many times the others'; a pinch of 10 N at up to 40 sites. "
            "Figures are those of shell and struts with rigid joints (linear, nu 0.35), of a uniform hollow of the same "
            "printed mass on the same mesh, of quadratic tetrahedra for the solid, and of the skin without its struts. The optimiser ran on the paper's model, with its "
            "limit of 0.05 mm.", "", f"**Rows won at equal mass, all models together: {words}.**", ""]
    asked.out.write_text("\n".join(head + sections + summary(results)))


if __name__ == "__main__":
    main()
