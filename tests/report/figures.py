#!/usr/bin/env python3
"""The figures of `awmr report --figures` for use in a thesis: complete, readable by other programs, reproducible.

usage: figures.py AWMR
"""
import json
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


def series(root):
    return [group.find(f"{SVG}title").text if group.find(f"{SVG}title") is not None else ""
            for group in root.iter(f"{SVG}g") if group.get("class") == "series"]


def check_svg(path):
    """Well-formed, in millimetres, text as text, every coordinate on the page."""
    root = ET.fromstring(path.read_bytes())
    assert root.get("width") == "150mm", root.get("width")
    width, height = map(float, root.get("viewBox").split()[2:])
    for node in root.iter():
        for pair in (node.get("points") or "").split():
            x, y = map(float, pair.split(","))
            assert -0.01 <= x <= width + 0.01 and -0.01 <= y <= height + 0.01, (path, pair)
    assert texts(root), path
    return root


def check_pdf(path):
    """One page, every font embedded, no date."""
    pdf = path.read_bytes()
    assert pdf.startswith(b"%PDF-") and pdf.rstrip().endswith(b"%%EOF"), path
    assert len(re.findall(rb"/Type /Page\b(?!s)", pdf)) == 1, path
    fonts = pdf.count(b"/Type /FontDescriptor")
    assert fonts >= 1 and len(re.findall(rb"/FontFile\d?\b", pdf)) == fonts, path
    assert b"Date" not in pdf, path


def expect(root, names, *labels):
    assert sorted(series(root)) == sorted(names), (series(root), names)
    for label in labels:
        assert label in texts(root), (label, texts(root))


def check_content(at):
    svg = {path.stem: check_svg(path) for path in at.glob("*.svg")}
    expect(svg["surge_resistance"], ["95 % confidence band", "fit", "measured", "measured, doubtful"], "u (m/s)", "τspeed")
    expect(svg["yaw_resistance"], ["95 % confidence band", "fit", "measured", "measured, doubtful"], "r (rad/s)", "τturn (m)")
    panels = texts(svg["log_drive_2"]).count("t (s)")
    assert panels == 1 and {"u (m/s)", "ψ (deg)", "x (m)"} <= set(texts(svg["log_drive_2"])), texts(svg["log_drive_2"])
    assert set(series(svg["log_drive_2"])) == {"measured", "predicted"}, series(svg["log_drive_2"])
    expect(svg["coastdown"], ["model", "stop, measured"], "t (s)", "u (m/s)")
    expect(svg["heading_c3_heading_steps"], MODES + ["reference"], "t (s)", "ψ (deg)")
    expect(svg["speed_c3_heading_steps"], MODES + ["reference"], "u (m/s)")
    expect(svg["forces_c3_heading_steps"], MODES * 2, "F′L", "F′R")
    expect(svg["steering_c3_heading_steps"], MODES * 2, "δcmd (deg)", "δ (deg)")
    expect(svg["path_c10_obstacle_between_waypoints"], MODES + ["waypoints"], "x (m)", "y (m)")
    expect(svg["heading_c10_obstacle_between_waypoints"], MODES + ["reference"] * 3, "ψ (deg)")
    expect(svg["distribution_c3_heading_steps_settling_time_s"], ["sample", "median, 5 to 95 %"] * 3, "settling time (s)", *MODES)
    expect(svg["tuning_history"], ["robust", "nominal", "the paper's gains"], "evaluation", "objective, best so far")
    assert "obstacles" in texts(svg["path_c10_obstacle_between_waypoints"]), texts(svg["path_c10_obstacle_between_waypoints"])
    assert any(name.startswith("differences_c3_heading_steps_") for name in svg), svg.keys()
    assert "surge_residuals" in svg and "yaw_residuals" in svg, svg.keys()
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
        figures = check_content(at / "new/figures")
        written = {pathlib.Path(path).name for path in told["written"]}
        assert written == {"report.html"} | {f"{name}.{kind}" for name in figures for kind in ["svg", "pdf"]}, written
        assert not told["findings"], told["findings"]

        awmr("report", out, "--figures", at / "again")
        for path in (at / "again").iterdir():
            assert path.read_bytes() == (at / "new/figures" / path.name).read_bytes(), path

        # Figures without data are listed and not drawn.
        alone = at / "alone"
        alone.mkdir()
        awmr("identify", "--vehicle", SOURCE / "configs/paper/vehicle.json", "--surge", SOURCE / "datasets/paper/surge.csv",
             "-o", alone / "model.json")
        told = json.loads(awmr("report", alone, "--figures", alone / "figures", "--json").stdout)
        assert {path.name for path in (alone / "figures").iterdir()} == {
            f"surge_{what}.{kind}" for what in ["resistance", "residuals"] for kind in ["svg", "pdf"]}
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
    print(f"{len(figures)} figures looked at")


main()
