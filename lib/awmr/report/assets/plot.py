#!/usr/bin/env python3
"""Draws the figures of `awmr report --figures` with matplotlib, each as NAME.svg and NAME.pdf, 150 mm wide.

usage: plot.py [NAME...]    all figures of figures.json by default

Reads figures.json and NAME.csv in the folder of this file and writes there. The same data give the same bytes. Edit
STYLES and RC for another style. Debian: apt install python3-matplotlib.
"""
import csv
import json
import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).resolve().parent
MM = 1 / 25.4
WIDTH_MM, HEIGHT_MM, PANEL_MM, ROW_MM = 150, 100, 20, 8
RC = {"font.family": "DejaVu Sans", "font.size": 9, "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.5,
      "axes.axisbelow": True, "axes.formatter.useoffset": False, "svg.fonttype": "none", "svg.hashsalt": "awmr", "pdf.fonttype": 42,
      "legend.frameon": False, "figure.constrained_layout.use": True}
# Colours of Okabe and Ito, "Color Universal Design" (2008), which colour-blind readers can distinguish. In grey print,
# widths, dashes and marks distinguish the series. Wide lines are drawn first, so that thin lines on them are visible.
STYLES = {
    "measured": {"color": "#000000", "linewidth": 1.0, "marker": "o", "fill": "#e1e1e1"},
    "doubtful": {"color": "#d55e00", "linewidth": 1.0, "marker": "D", "fill": "#f7ded0"},
    "model": {"color": "#0072b2", "linewidth": 1.4, "marker": "o", "fill": "#cce2f0"},
    "predicted": {"color": "#d55e00", "linewidth": 1.2, "dashes": (4, 1.5), "marker": "o", "fill": "#f7ded0"},
    "differential": {"color": "#56b4e9", "linewidth": 2.6, "marker": "o", "fill": "#dbeffb"},
    "steering": {"color": "#d55e00", "linewidth": 1.5, "dashes": (5, 2.5), "marker": "D", "fill": "#f7ded0"},
    "combined": {"color": "#00503c", "linewidth": 1.0, "marker": "s", "fill": "#ccdcd8"},
    "reference": {"color": "#000000", "linewidth": 0.8, "dashes": (1, 2), "marker": "s", "fill": "#e1e1e1"},
    "minor": {"color": "#8c8c8c", "linewidth": 1.0, "marker": "o", "fill": "#ebebeb"},
}
ORDER = list(STYLES)  # drawing order: later ones are on top
OBSTACLE = "#c8c8c8"


def math_text(text):
    """Matplotlib text of a label: "u_{max}" gets a subscript, "10^{3}" an exponent; a dollar sign stays a dollar sign."""
    return re.sub(r"([_^])\{([^}]*)\}", r"$\1{\\mathrm{\2}}$", text.replace("$", r"\$"))


def label_of(axis):
    return math_text(axis["quantity"] + (f" ({axis['unit']})" if axis["unit"] else ""))


def read_series(name):
    """Columns of NAME.csv by (panel, series): {"x": [...], "y": [...], "low": [...], "high": [...]}."""
    found = {}
    with open(HERE / f"{name}.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            columns = found.setdefault((int(row["panel"]), int(row["series"])), {key: [] for key in ("x", "y", "low", "high")})
            for key, values in columns.items():
                if row[key]:
                    values.append(float(row[key]))
    return found


def draw(axes, series, data):
    style = STYLES[series["role"]]
    line = {"color": style["color"], "linewidth": style["linewidth"], "zorder": 2 + 0.1 * ORDER.index(series["role"]),
            "label": math_text(series["name"]) or "_"}
    mark = {**line, "linestyle": "none", "marker": style["marker"], "markersize": 4}
    shape = series["shape"]
    if shape == "line":
        drawn, = axes.plot(data["x"], data["y"], **line)
        if "dashes" in style:
            drawn.set_dashes(style["dashes"])
    elif shape == "points":
        axes.plot(data["x"], data["y"], **mark)
    elif shape == "band":
        axes.fill_between(data["x"], data["low"], data["high"], color=style["fill"], linewidth=0, zorder=1, label=line["label"])
    elif shape == "ticks":
        axes.plot(data["x"], data["y"], **{**mark, "marker": "|", "markersize": 9})
    else:  # ranges
        axes.hlines(data["y"], data["low"], data["high"], color=style["color"], linewidth=1.2, zorder=line["zorder"])
        axes.plot(data["x"], data["y"], **mark)


def legend(panels):
    """Adds a legend above the plots, where it covers no data. A single entry gets no legend, because the axes name it."""
    entries = {}
    for axes in panels:
        for handle, name in zip(*axes.get_legend_handles_labels()):
            entries.setdefault(name, handle)
    if len(entries) > 1:
        panels[0].legend(entries.values(), entries.keys(), loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=min(len(entries), 4))


def plot(figure):
    panels = figure["panels"]
    rows = sum(len(panel["y"]["rows"]) for panel in panels)
    height = 30 + ROW_MM * rows if rows else HEIGHT_MM + PANEL_MM * (len(panels) - 1)
    paper, all_axes = plt.subplots(len(panels), 1, sharex=True, squeeze=False, figsize=(WIDTH_MM * MM, height * MM))
    all_axes = list(all_axes[:, 0])
    data = read_series(figure["name"])
    for p, (axes, panel) in enumerate(zip(all_axes, panels)):
        for s, series in enumerate(panel["series"]):
            draw(axes, series, data.get((p, s), {"x": [], "y": [], "low": [], "high": []}))
        axes.set_ylabel(label_of(panel["y"]))
        if panel["y"]["rows"]:
            axes.set_yticks(range(len(panel["y"]["rows"])), panel["y"]["rows"])
            axes.set_ylim(len(panel["y"]["rows"]) - 0.5, -0.5)
        if panel["y"]["zero"]:
            axes.axhline(0, color="black", linewidth=0.6, zorder=1.5)
        if figure["x"]["zero"]:
            axes.axvline(0, color="black", linewidth=0.6, zorder=1.5)
    for circle in figure["circles"]:
        all_axes[0].add_patch(plt.Circle((circle["x"], circle["y"]), circle["radius"], color=OBSTACLE, linewidth=0, label="obstacles"))
    if figure["equal_axes"]:
        all_axes[0].set_aspect("equal", adjustable="datalim")
        all_axes[0].autoscale_view()
    all_axes[-1].set_xlabel(label_of(figure["x"]))
    legend(all_axes)
    paper.savefig(HERE / f"{figure['name']}.svg", metadata={"Date": None, "Title": figure["meaning"]})
    paper.savefig(HERE / f"{figure['name']}.pdf", metadata={"CreationDate": None, "Title": figure["meaning"]})
    plt.close(paper)


def main():
    figures = {figure["name"]: figure for figure in json.loads((HERE / "figures.json").read_text(encoding="utf-8"))["figures"]}
    names = sys.argv[1:] or list(figures)
    for name in names:
        if name not in figures:
            sys.exit(f"plot.py: there is no figure {name}; figures.json has: {', '.join(figures)}")
    with plt.rc_context(RC):
        for name in names:
            plot(figures[name])
    print(f"drew {len(names)} figures in {HERE}")


main()
