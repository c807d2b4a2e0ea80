#!/usr/bin/env python3
"""Checks that the figures of `awmr report --figures`, drawn by the plot.py that it writes, are complete, well-formed and reproducible.

usage: figures.py AWMR
"""
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET

AWMR = pathlib.Path(sys.argv[1]).resolve()
SOURCE = pathlib.Path(__file__).resolve().parents[2]
SVG = "{http://www.w3.org/2000/svg}"
GAINS = {"schema": "awmr.gains/1", "heading": {"lambda": 3, "mu": 50, "epsilon": 12}, "speed": {"mu": 5, "epsilon": 1.2},
         "search": {"algorithm": "none", "stop_reason": "none", "evaluations": 9, "simulated": 9, "seed": 1, "history": {
             "evaluations": 9, "global_evaluations": 5, "best": [{"evaluation": 2, "objective": 0.9}, {"evaluation": 7, "objective": 0.8}]}},
         "robust": {"draws": 4, "seed": 1, "motor_time_constant_s": 0.02, "noise": {"heading_deg": 1, "yaw_rate_degps": 0.5, "speed_mps": 0.02},
                    "latency": {"heading_s": 0.02, "yaw_rate_s": 0.02, "speed_s": 0.02}, "nominal_history": {"evaluations": 12, "global_evaluations": 7, "best": [{"evaluation": 1, "objective": 0.7}]}}}
MODES = ["differential", "steering", "combined"]
# One of each kind.
DRAWN = ["surge_resistance", "yaw_resistance", "surge_residuals", "log_drive_2", "coastdown", "tuning_history",
         "forces_c3_heading_steps", "heading_c3_heading_steps", "speed_c3_heading_steps", "steering_c3_heading_steps",
         "path_c10_obstacle_between_waypoints", "heading_c10_obstacle_between_waypoints",
         "distribution_c3_heading_steps_settling_time_s", "differences_c3_heading_steps_differential_steering"]


def awmr(*words, code=0):
    done = subprocess.run([AWMR, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == code, (words, done.returncode, done.stdout, done.stderr)
    return done


def results(at):
    """Results of `awmr run` with given gains: identification, a validated log, heading and path runs, five samples."""
    paper, data = SOURCE / "configs/paper", SOURCE / "datasets/paper"
    awmr("identify", "--vehicle", paper / "vehicle.json", "--surge", data / "surge.csv", "--turning", data / "turning.csv",
         "--coastdown", data / "coastdown.csv", "-o", at / "model.json")
    (at / "gains.json").write_text(json.dumps(GAINS))
    inputs = ["--model", at / "model.json", "--gains", at / "gains.json"]
    for stem in ["c3_heading_steps", "c10_obstacle_between_waypoints"]:
        scenario = paper / f"scenarios/{stem}.json"
        (at / f"scenario_{stem}.json").write_text(scenario.read_text())
        for mode in MODES:
            awmr("simulate", *inputs, "--scenario", scenario, "--mode", mode, "-o", at / f"run_{stem}_{mode}_tuned.csv")
    subprocess.run([AWMR, "validate", *map(str, inputs), "--log", SOURCE / "datasets/synthetic/drive_2.csv", "-o",
                    # passing is not required here
                    at / "validation.json"], capture_output=True, check=False)
    awmr("compare", *inputs, "--samples", 5, "--scenario", paper / "scenarios/c3_heading_steps.json", "-o", at)


def texts(root):
    return ["".join(node.itertext()) for node in root.iter(f"{SVG}text")]


def draw(at, *names):
    return subprocess.run([sys.executable, at / "plot.py", *names], capture_output=True, text=True)


def series_of(at, name):
    """Names of the series of a figure in figures.json, in the order of panels and series, that have rows in its CSV file."""
    figure = next(one for one in json.loads((at / "figures.json").read_text())["figures"] if one["name"] == name)
    with open(at / f"{name}.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    names = {(int(row["panel"]), int(row["series"])): row["name"] for row in rows}
    for (panel, series), text in names.items():
        assert figure["panels"][panel]["series"][series]["name"] == text, (name, panel, series)
    for row in rows:
        assert all(math.isfinite(float(row[key])) for key in ("x", "y", "low", "high") if row[key]), (name, row)
    return [text for text in names.values() if text]


def check_svg(path):
    """Checks that the SVG is well-formed, 150 mm wide, and contains its text as text, not as outlines."""
    root = ET.fromstring(path.read_bytes())
    assert abs(float(root.get("width").removesuffix("pt")) / 72 * 25.4 - 150) < 0.1, root.get("width")
    assert texts(root), path
    return root


def check_pdf(path):
    """Checks that the PDF has one page, embeds every font and contains no date (so that it is reproducible)."""
    pdf = path.read_bytes()
    assert pdf.startswith(b"%PDF-") and pdf.rstrip().endswith(b"%%EOF"), path
    assert len(re.findall(rb"/Type /Page\b(?!s)", pdf)) == 1, path
    fonts = pdf.count(b"/Type /FontDescriptor")
    assert fonts >= 1 and len(re.findall(rb"/FontFile\d?\b", pdf)) == fonts, path
    assert b"Date" not in pdf, path


def check_content(at):
    svg = {path.stem: check_svg(path) for path in at.glob("*.svg")}

    def expect(name, names, *labels):
        assert sorted(series_of(at, name)) == sorted(names), (name, series_of(at, name), names)
        for label in labels:
            assert any(label in text for text in texts(svg[name])), (name, label, texts(svg[name]))

    expect("surge_resistance", ["95 % confidence band", "fit", "measured", "measured, doubtful"], "u (m/s)", "τ")
    expect("yaw_resistance", ["95 % confidence band", "fit", "measured", "measured, doubtful"], "r (rad/s)", "τ")
    panels = texts(svg["log_drive_2"]).count("t (s)")
    assert panels == 1 and {"u (m/s)", "ψ (deg)", "x (m)"} <= set(texts(svg["log_drive_2"])), texts(svg["log_drive_2"])
    assert set(series_of(at, "log_drive_2")) == {"measured", "predicted"}
    expect("coastdown", ["model", "stop, measured"], "t (s)", "u (m/s)")
    expect("heading_c3_heading_steps", MODES + ["reference"], "t (s)", "ψ (deg)")
    expect("speed_c3_heading_steps", MODES + ["reference"], "u (m/s)")
    expect("forces_c3_heading_steps", MODES * 2, "F′")
    expect("steering_c3_heading_steps", MODES * 2, "δ")
    expect("path_c10_obstacle_between_waypoints", MODES + ["waypoints"], "x (m)", "y (m)", "obstacles")
    expect("heading_c10_obstacle_between_waypoints", MODES + ["reference"] * 3, "ψ (deg)")
    expect("distribution_c3_heading_steps_settling_time_s", ["sample", "median, 5 to 95 %"] * 3, "settling time (s)", *MODES)
    expect("tuning_history", ["robust", "nominal", "the paper's gains"], "evaluation", "objective, best so far")
    assert set(svg) == set(DRAWN), svg.keys()
    assert {"surge_residuals.csv", "yaw_residuals.csv"} <= {path.name for path in at.iterdir()}
    for name in svg:
        check_pdf(at / f"{name}.pdf")
    return svg


def main():
    with tempfile.TemporaryDirectory() as temporary:
        at = pathlib.Path(temporary)
        out = at / "out"
        out.mkdir()
        results(out)
        told = json.loads(awmr("report", out, "--figures", at / "new/figures", "--json").stdout)
        written = {pathlib.Path(path).name for path in told["written"]}
        drawn = draw(at / "new/figures", *DRAWN)
        assert drawn.returncode == 0 and not drawn.stderr, drawn.stderr
        figures = check_content(at / "new/figures")
        names = {one["name"] for one in json.loads((at / "new/figures/figures.json").read_text())["figures"]}
        assert written == {"report.html", "figures.json", "plot.py"} | {f"{name}.csv" for name in names}, written
        assert not told["findings"], told["findings"]

        awmr("report", out, "--figures", at / "again")
        assert draw(at / "again", "surge_resistance", "coastdown").returncode == 0
        assert "surge_resistance" in draw(at / "again", "no_such_figure").stderr
        assert len(list((at / "again").glob("*.pdf"))) == 2
        (at / "again/plot.py").write_text("# edited\n")
        awmr("report", out, "--figures", at / "again")
        assert (at / "again/plot.py").read_text() == "# edited\n"
        (at / "again/plot.py").write_text((at / "new/figures/plot.py").read_text())
        for path in (at / "again").iterdir():
            assert path.read_bytes() == (at / "new/figures" / path.name).read_bytes(), path

        # Figures without data are listed and not drawn.
        alone = at / "alone"
        alone.mkdir()
        awmr("identify", "--vehicle", SOURCE / "configs/paper/vehicle.json", "--surge", SOURCE / "datasets/paper/surge.csv",
             "-o", alone / "model.json")
        told = json.loads(awmr("report", alone, "--figures", alone / "figures", "--json").stdout)
        assert {path.name for path in (alone / "figures").iterdir()} == {
            "surge_resistance.csv", "surge_residuals.csv", "figures.json", "plot.py"}
        assert {finding["code"] for finding in told["findings"]} == {"not-drawn"}, told["findings"]
        assert len(told["findings"]) == 6, told["findings"]

        # If figures cannot be written, nothing is written.
        (alone / "report.html").unlink()
        for place in [alone / "model.json", alone / "model.json/figures", "/proc/figures"]:
            assert "error: " in awmr("report", alone, "--figures", place, code=2).stderr
            assert not (alone / "report.html").exists(), place

        # Files that differ from awmr's output in any way.
        good = json.loads((out / "comparison.json").read_text())
        for broken in [[], {**good, "scenarios": 3}, {**good, "ranking": None}, {**good, "scenarios": [{}]},
                       {**good, "scenarios": [{**good["scenarios"][0], "modes": []}]}]:
            (out / "comparison.json").write_text(json.dumps(broken))
            assert "comparison" in awmr("report", out, "--figures", at / "broken", code=2).stderr
            assert not (at / "broken").exists()
        (out / "comparison.json").write_text(json.dumps(good))
        valid = json.loads((out / "validation.json").read_text())
        for broken in [[], {**valid, "logs": 3}, {**valid, "logs": [{}]},
                       {**valid, "logs": [{"file": "a", "channels": {"x_m": {"series": {"t_s": [0, 1], "measured": [0]}}}}]}]:
            (out / "validation.json").write_text(json.dumps(broken))
            assert "validation" in awmr("report", out, "--figures", at / "broken", code=2).stderr
            assert not (at / "broken").exists()
        (out / "validation.json").write_text(json.dumps(valid))
        for broken in [{**GAINS, "search": 3}, {**GAINS, "search": {"history": {"best": 7}}},
                       {**GAINS, "search": {"history": {"evaluations": 9, "best": [{"evaluation": "a", "objective": 1}]}}}]:
            (alone / "gains.json").write_text(json.dumps(broken))
            assert "gains.json" in awmr("report", alone, "--figures", at / "broken", code=2).stderr
            assert not (at / "broken").exists()
    print(f"{len(figures)} figures checked")


main()
