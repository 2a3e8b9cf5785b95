#!/usr/bin/python3 -B
"""Draws what bench/run measured, nanoseconds per body and step against bodies: bench/plot.py RESULTS.csv"""

import csv
import pathlib
import sys

import matplotlib
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, NullFormatter

matplotlib.use("Agg")
plt.rcParams.update({
    "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans", "Helvetica Neue", "Arial"], "font.size": 10,
    "text.color": "#3c4350", "axes.edgecolor": "#8a93a0", "axes.labelcolor": "#3c4350", "axes.spines.top": False,
    "axes.spines.right": False, "xtick.color": "#8a93a0", "ytick.color": "#8a93a0", "xtick.labelcolor": "#3c4350",
    "ytick.labelcolor": "#3c4350", "grid.color": "#dfe3e8", "grid.linewidth": 0.8, "axes.axisbelow": True,
    "figure.dpi": 72,
    "svg.fonttype": "none", "svg.hashsalt": "carom",  # text stays text, and equal figures give equal files
})
INK = "#171a20"
# Colours that colour-blind readers tell apart; markers and labels say the same once more.
WORKLOADS = {"gas": ("#d1570b", "o"), "dense_gas": ("#1c6fbf", "s"), "cooling": ("#23806a", "^"),
             "polydisperse": ("#8a4fa3", "D"), "bullets": ("#a8860b", "v"), "open_space": ("#5b6472", "P"),
             "pile": ("#b0307a", "X")}
PEERS = {"Bullet": ("#1c6fbf", "s"), "ODE": ("#8a4fa3", "D")}
BYTES_PER_BODY = 100  # about what a step of gas must move at least


def curve(axes, rows, colour, marker, dashed=False):
    """Draws the medians, and down to the least as a band. Returns where the curve ends."""
    rows = sorted(rows, key=lambda row: int(row["bodies"]))
    bodies = [int(row["bodies"]) for row in rows]
    medians = [float(row["ns_per_body_step"]) for row in rows]
    least = [float(row["ns_per_body_step_min"]) for row in rows]
    axes.fill_between(bodies, least, medians, color=colour, alpha=0.15, linewidth=0)
    axes.plot(bodies, medians, color=colour, linewidth=2, linestyle="--" if dashed else "-", marker=marker,
              markersize=5, markeredgecolor="white", markeredgewidth=0.7)
    return bodies[-1], medians[-1]


def spread(places, distance):
    """Moves places, sorted upwards, apart until neighbours have a distance."""
    places = list(places)
    for _ in range(200):
        for i in range(1, len(places)):
            lacking = max(0, distance - (places[i] - places[i - 1]))
            places[i - 1] -= lacking / 2
            places[i] += lacking / 2
    return places


def label_ends(axes, ends):
    """Writes the curves' names at the right edge, as near to the curves' ends as other names let it."""
    ends = sorted(ends, key=lambda end: end[0][1])
    right = axes.transAxes.transform((1, 0))[0] + 10
    heights = [axes.transData.transform(end)[1] for end, _, _ in ends]
    for (end, text, colour), height in zip(ends, spread(heights, distance=15)):
        axes.annotate(text, end, xytext=(right, height), textcoords="figure pixels", color=colour, va="center",
                      annotation_clip=False, arrowprops={"arrowstyle": "-", "color": colour, "linestyle": (0, (1, 3)),
                                                         "relpos": (0, 0.5), "shrinkA": 2, "shrinkB": 5})


def prepare(axes, heading, rows):
    sizes = sorted({int(row["bodies"]) for row in rows})
    axes.set(xscale="log", yscale="log", xlabel="bodies")
    axes.set_xticks(sizes)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}".replace(",", "\u202f")))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}".replace(",", "\u202f")))
    axes.grid(True, which="major")
    axes.set_title(heading, loc="left", fontsize=11, fontweight="bold", color=INK)


def draw_engines(axes, rows):
    """gas: carom and its peers."""
    gas = [row for row in rows if row["workload"] == "gas"]
    prepare(axes, "gas: carom and others", gas)
    ends = []
    for engine, (colour, marker) in PEERS.items():
        if chosen := [row for row in gas if row["engine"] == engine]:
            ends.append((curve(axes, chosen, colour, marker), f"{engine}, {chosen[0]['precision']}", colour))
    carom = [row for row in gas if row["engine"] == "carom"]
    for precision, threads in sorted({(row["precision"], int(row["threads"])) for row in carom}):
        colour = WORKLOADS["gas"][0] if precision == "single" else INK
        chosen = [row for row in carom if (row["precision"], int(row["threads"])) == (precision, threads)]
        name = f"carom, {precision}" + (f", {threads} threads" if threads > 1 else "")
        ends.append((curve(axes, chosen, colour, "o", dashed=threads > 1), name, colour))
    return ends


def draw_workloads(axes, rows):
    """carom's workloads in double precision, with as many threads as were measured."""
    threads = max(int(row["threads"]) for row in rows)
    carom = [row for row in rows
             if (row["engine"], row["precision"], int(row["threads"])) == ("carom", "double", threads)]
    prepare(axes, f"carom's workloads, double, {threads} thread{'s' if threads > 1 else ''}", carom)
    return [(curve(axes, chosen, colour, marker), workload, colour) for workload, (colour, marker) in WORKLOADS.items()
            if (chosen := [row for row in carom if row["workload"] == workload])]


def draw_limit(axes, bandwidth):
    """The time that memory alone takes."""
    limit = BYTES_PER_BODY / bandwidth
    axes.axhline(limit, color="#8a93a0", linewidth=1.2, linestyle=":")
    axes.annotate(f"copying {BYTES_PER_BODY} bytes with one thread, {bandwidth:.3g} GB/s", (0, limit),
                  xycoords=("axes fraction", "data"), xytext=(6, 5), textcoords="offset points", fontsize=9,
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})


def draw(rows, file):
    figure, (left, right) = plt.subplots(1, 2, sharey=True, figsize=(12, 5.6))
    ends_left, ends_right = draw_engines(left, rows), draw_workloads(right, rows)
    draw_limit(left, float(rows[0]["copy_gb_per_s_1_thread"]))
    figure.suptitle("Nanoseconds per body and step", x=0.06, ha="left", fontsize=15, fontweight="bold", color=INK)
    figure.text(0.06, 0.9, f"{rows[0]['machine']}. Wall time, less is better; "
                           "lines are medians, bands reach down to the least.")
    figure.subplots_adjust(left=0.06, right=0.9, top=0.82, bottom=0.1, wspace=0.48)
    figure.canvas.draw()  # now the axes know their limits
    label_ends(left, ends_left)
    label_ends(right, ends_right)
    figure.savefig(file, metadata={"Date": None})
    plt.close(figure)


def main():
    if len(sys.argv) != 2:
        sys.exit(f"usage: {__doc__.partition(': ')[2]}")
    table = pathlib.Path(sys.argv[1])
    with open(table, newline="", encoding="utf-8") as file:
        draw(list(csv.DictReader(file)), table.with_suffix(".svg"))


if __name__ == "__main__":
    main()
