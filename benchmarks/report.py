#!/usr/bin/python3
"""usage: report.py FOLDER   (needs python3-matplotlib)

Makes FOLDER/report.html of what a run of skein_bench wrote: results.json, goals.md and run.json. The page refers to nothing
outside of itself. Prints each comparison that has a goal or failed.
"""
import base64
import html
import io
import itertools
import json
import statistics
import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams.update({"svg.fonttype": "none", "font.size": 8, "axes.grid": True, "grid.color": "#e6eaf0", "axes.axisbelow": True})
import matplotlib.pyplot as plt  # noqa: E402

COLOURS = {"fastdds": "#0b6bcb", "cyclonedds": "#0a8f5b", "fastdds-cyclonedds": "#c4581a", "cyclonedds-fastdds": "#8a3ab9"}
TAIL = {"p50": "50 %", "p90": "90 %", "p95": "", "p99": "99 %", "p999": "99.9 %"}
STYLE = """
body{font:15px/1.5 system-ui,sans-serif;color:#1d2430;background:#fff;max-width:1540px;margin:2em auto;padding:0 1em}
h1{font-size:1.6em;margin-bottom:0}h2{margin-top:1.8em;border-bottom:1px solid #dde2ea;padding-bottom:.2em}
h3{font-size:1em;margin:.9em 0 .2em}ul{margin:.2em 0}img{display:block;max-width:100%}
table{border-collapse:collapse;font-size:12.5px;margin-top:.5em}td,th{padding:2px 8px;text-align:right;white-space:nowrap}
td:nth-child(-n+3),th:nth-child(-n+3),.goals td,.goals th{text-align:left}tbody tr:nth-child(odd){background:#f6f8fb}
.good{color:#0a8f5b}.bad{color:#c0392b;font-weight:600}.skipped{color:#b36b00;text-align:left}
.note,summary{color:#44506a}summary{cursor:pointer}
"""
METHOD = """Every contender is a provider and a client in processes of their own, both on this machine. All of
them are alive during the whole run and take short turns in a new random order each round; nothing is compared
across runs. <b>Raw</b> is the vendor's own API with the same transport settings and the same threading contract
(nothing of the user's runs on the vendor's threads but a notification; the server answers from a thread of its own),
and encodes with Fast CDR. A mixed pair is compared with the slower vendor's raw call, and for information with a raw
mixed pair. The service is the same function everywhere: it returns a copy of what it gets. Times are round trips as
the caller sees them; the content travels both ways. Both processes of a contender stand on the same cores as
their rivals', either sharing one or on one each: where the scheduler may choose, its whim rules at small sizes."""


def time_text(time_us):
    for unit, factor in (("s", 1e6), ("ms", 1e3), ("µs", 1)):
        if time_us >= factor:
            break
    return f"{time_us / factor:.3g} {unit}"


def size_text(size):
    return f"{size >> 20} MiB" if size >= 1 << 20 else f"{size >> 10} KiB" if size >= 1 << 10 else f"{size} B"


class Row:
    """A comparison of results.json."""

    def __init__(self, values):
        self.values = values
        self.parameters = values["parameters"]
        self.claim, self.subject, self.rival = values["claim"], values["subject"], values["rival"]
        self.failed = "failed" in values
        self.absence = values.get("failed") or values.get("skipped")
        self.goal = values.get("goal")
        self.p50, self.p99 = values["ratio_p50"], values["ratio_p99"]
        self.size, self.placement = self.parameters.get("size_bytes"), self.parameters.get("placement")
        # One of many rivals, at fixed placements.
        beside_raw = self.subject.startswith("raw") or self.rival.startswith("raw")
        self.is_of_matrix = bool(self.placement) and not beside_raw and self.claim != "a call over DDS"

    def figure(self, name):
        return self.values[f"{name}_{self.values['unit']}"]

    def text(self, name):
        unit = self.values["unit"]
        return time_text(self.figure(name)) if unit == "us" else f"{self.figure(name):.0f} {unit}"

    def samples(self, prefix=""):
        return self.values.get(prefix + "values") or [self.figure(prefix + name) for name in TAIL]

    def strain(self):
        """How far beyond its limits: over 1 it misses them."""
        return max(self.p50 / self.values["goal_p50"], self.p99 / self.values["goal_p99"] if "goal_p99" in self.values else 0)

    def variant(self):
        """What tells it from others of its claim, placement aside: `1 KiB`, `32 clients`."""
        words = [size_text(value) if name == "size_bytes" else f"{json.dumps(value)} {name.replace('_', ' ')}"
                 for name, value in sorted(self.parameters.items()) if name != "placement"]
        return ", ".join(words)

    def place(self):
        if self.placement:
            return f"{self.variant()}, {self.placement}"
        if self.size is not None:
            return size_text(self.size)
        peers = self.parameters.get("peers")
        return f"{peers} peers, a process each" if peers is not None else self.parameters.get("where", "")

    def name(self):
        return ", ".join(filter(None, [self.claim, self.place(), self.subject]))


def escaped(text):
    return html.escape(str(text))


def colour_of(name):
    return COLOURS.get(name.partition(" ")[2], "#777777")


def table(head, rows):
    """Each cell is text, or a pair of text and class."""
    def cell(content):
        text, kind = content if isinstance(content, tuple) else (content, "")
        return f"<td class='{kind}'>{escaped(text)}</td>"

    body = "".join(f"<tr>{''.join(map(cell, row))}</tr>" for row in rows)
    return f"<table><thead><tr>{''.join(f'<th>{escaped(each)}</th>' for each in head)}</tr></thead><tbody>{body}</tbody></table>"


def items(title, lines):
    lines = "".join(f"<li>{escaped(line)}</li>" for line in lines or ["Nowhere."])
    return f"<h3>{escaped(title)}</h3><ul>{lines}</ul>"


def section(title, *parts):
    return f"<section><h2>{escaped(title)}</h2>{''.join(parts)}</section>"


def grouped(rows, key):
    """Lists by key, in the order in which they first appear."""
    groups = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups


def picture(figure):
    """The figure within the page."""
    file = io.BytesIO()
    figure.savefig(file, format="svg", metadata={"Date": None}, bbox_inches="tight")
    plt.close(figure)
    return f"<img alt='' src='data:image/svg+xml;base64,{base64.b64encode(file.getvalue()).decode()}'>"


def panels(count, width=3.7, height=2.6):
    figure, axes = plt.subplots(1, count, figsize=(width * count, height), squeeze=False, layout="constrained")
    return figure, axes[0]


def times(axis):
    axis.set_major_formatter(lambda value, _: time_text(value))

    def between(value, _):
        low, high = axis.get_view_interval()
        return time_text(value) if f"{value:e}"[0] in ("25" if high > 8 * low else "23456789") else ""

    axis.set_minor_formatter(between)


def goals_section(rows, markdown):
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in markdown.splitlines()[2:]]
    measured = grouped((row for row in rows if row.goal and not row.absence), lambda row: row.goal)
    body = []
    for goal, limit, ratios, verdict in lines:
        worst = max(measured.get(goal, []), key=Row.strain, default=None)
        medians = f"{worst.text('p50')} against {worst.text('rival_p50')}" if worst else ""
        where = "; ".join(filter(None, [f"{worst.subject} beside {worst.rival}", worst.place()])) if worst else ""
        kind = {"met": "good", "missed": "bad"}.get(verdict.split()[0].strip(":"), "skipped")
        body.append([goal, limit, ratios, medians, where, (verdict, kind)])
    return section("Goals", "<div class='goals'>", table(["goal", "limit", "worst in this run", "medians", "where", "comparisons that meet it"], body), "</div>")


def sentence(row):
    return (f"{row.name()}: p50 {row.text('p50')} against {row.text('rival_p50')} of {row.rival}: {row.p50:.2f}×; p99 {row.p99:.2f}×")


def verdict_section(rows):
    beyond, slower, without_goal, faster, absent = [], [], [], [], {True: set(), False: set()}
    for row in rows:
        if row.absence:
            absent[row.failed].add(f"{row.claim}, {row.subject} beside {row.rival}: {row.absence}")
        elif row.goal and not row.is_of_matrix:
            (beyond if row.strain() > 1 else slower if row.p50 > 1 else faster).append(sentence(row))
        elif not row.goal and row.p50 > 1 and row.subject.startswith("skein") and row.rival.startswith("raw"):
            without_goal.append(sentence(row))
    parts = [items("Skein misses its goal", beyond), items("Skein loses, within its goal", slower),
             items("Skein loses, where there is no goal", without_goal), items("Skein is level or ahead", faster)]
    losing, winning = [], []
    for what, of in grouped((row for row in rows if row.is_of_matrix and row.goal and not row.absence), Row.name).items():
        beside = [(row.p50 > row.values["goal_p50"], f"{row.rival} ({row.p50:.2f}×)") for row in of]
        behind, ahead = (", ".join(text for lost, text in beside if lost == wanted) for wanted in (True, False))
        told = "; ".join(filter(None, [behind and f"behind {behind}", ahead and f"ahead of {ahead}"]))
        (losing if behind else winning).append(f"{what} is {told}")
    if losing or winning:
        parts += ["<h3>Beside others (Skein's median by theirs, or by the goal's)</h3>", items("Skein loses", losing), items("Skein wins", winning)]
    parts += [items(title, sorted(absent[failed])) for title, failed in (("Failed, and not measured", True), ("Not measured here", False)) if absent[failed]]
    return section("Where Skein loses", *parts)


def table_of(rows):
    names = ["p50", "p90", "p95", "p99", "p999", "rival_p50", "rival_p95", "rival_p99"]
    body = []
    for row in rows:
        start = [row.subject, row.rival, row.place()]
        if row.absence:
            body.append([*start, (f"{'failed' if row.failed else 'skipped'}: {row.absence}", "bad" if row.failed else "skipped")])
            continue
        met = [("met", "good") if row.strain() <= 1 else ("missed", "bad")] if row.goal else [""]
        body.append([*start, row.values["samples"], *map(row.text, names), f"{row.p50:.2f}", f"{row.p99:.2f}", *met])
    head = ["subject", "rival", "", "samples", *(name.replace("_", " ").replace("p999", "p99.9") for name in names), "ratio p50", "ratio p99", "goal"]
    return f"<details open><summary>All figures</summary>{table(head, body)}</details>"


def ratio_bars(rows):
    groups = grouped(rows, lambda row: row.size)
    figure, (axes,) = panels(1, 8, 2.8)
    for place, (size, of) in enumerate(sorted(groups.items())):
        width = 0.84 / len(of)
        for bar, row in enumerate(of):
            x, top = place - 0.42 + width * (bar + 0.5), min(row.p50, 4)
            axes.bar(x, top, width * 0.8, color=colour_of(row.subject), label=row.subject if place == 0 else None)
            axes.annotate(f"{row.p50:.2f}", (x, 0.02), ha="center", va="bottom", fontsize=7, color="white")
            axes.plot(x, min(row.p99, 4), "o", color="white", markeredgecolor="black", markersize=4)
    axes.axhline(1, color="#c0392b", linestyle="--", linewidth=1)
    axes.axhline(1.05, color="#c0392b", linestyle=":", linewidth=1)
    axes.set_xticks(range(len(groups)), [size_text(size) for size in sorted(groups)])
    axes.grid(axis="x", visible=False)
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
    axes.set_ylim(0, 1.1 * max(min(each, 4) for row in rows for each in (row.p50, row.p99, 1.3)))
    axes.set_title("Skein / raw (less is better; mixed pairs against the slower vendor)")
    axes.set_ylabel("bar: p50 (goal: 1.05), dot: p99\n(goal: 1.15; cut off at 4)")
    return picture(figure)


def latency_panels(rows, subjects):
    """Every contender's median by size, whether it stands as a subject or as a rival."""
    medians = {}
    for row in rows:
        medians.setdefault(row.subject, {})[row.size] = row.figure("p50")
        medians.setdefault(row.rival, {})[row.size] = row.figure("rival_p50")
    figure, axes = panels(len(subjects))
    for subject, panel in zip(subjects, axes):
        pair = subject.partition(" ")[2]
        for name, colour, style in (("unix socket", "#999999", "-"), (f"raw {pair}", "#d08700", "--"), (subject, colour_of(subject), "-")):
            if name in medians:
                panel.loglog(*zip(*sorted(medians[name].items())), style, color=colour, label=name, marker=".")
        sizes = sorted({row.size for row in rows})
        panel.set_xticks(sizes, map(size_text, sizes))
        panel.minorticks_off()
        panel.set_title(f"{pair}: median")
        panel.set_xlabel("content, each way")
        panel.legend()
        times(panel.yaxis)
    return picture(figure)


def tail_panels(rows):
    groups = sorted(grouped(rows, lambda row: row.size).items())
    figure, axes = panels(len(groups), 3)
    for (size, of), panel in zip(groups, axes):
        for row in of:
            panel.plot(range(len(TAIL)), [row.figure(name) for name in TAIL], color=colour_of(row.subject), marker=".")
            if "-" not in row.subject.partition(" ")[2]:
                rival = [row.figure(f"rival_{name}") for name in TAIL]
                panel.plot(range(len(TAIL)), rival, "--", color=colour_of(row.rival), marker=".")
        panel.set_yscale("log")
        panel.set_xticks(range(len(TAIL)), TAIL.values())
        panel.set_xlabel("share of calls that are faster; dashed: raw")
        panel.set_title(f"{size_text(size)}: the tail")
        times(panel.yaxis)
    return picture(figure)


def strips(title, rows):
    """Every value as a dot, one line a contender, the median as a stroke; limits as vertical lines."""
    lines, limits = [], []
    for row in rows:
        lines.append((row.subject, colour_of(row.subject), row.samples()))
        if row.values["rival_samples"] == 1:
            limits = [(row.figure("rival_p50"), row.rival)]
        else:
            lines.append((row.rival, "#999999", row.samples("rival_")))
    figure, (axes,) = panels(1, 9, 0.9 + 0.27 * len(lines))
    for place, (_, colour, values) in enumerate(lines):
        heights = [place + (number * 7 % 11 - 5) * 0.05 for number in range(len(values))]  # so that dots do not hide dots
        axes.scatter(values, heights, s=12, color=colour, alpha=0.6, linewidths=0)
        axes.plot([statistics.median_low(values)] * 2, [place - 0.38, place + 0.38], color="#1d2430", linewidth=2)
    for at, label in limits:
        axes.axvline(at, color="#c0392b", linestyle="--", linewidth=1)
        axes.annotate(label, (at, 1), xycoords=("data", "axes fraction"), ha="center", va="bottom", color="#c0392b")
    axes.set_yticks(range(len(lines)), [name for name, _, _ in lines])
    axes.set_ylim(len(lines) - 0.5, -0.5)
    axes.set_xscale("log")
    axes.set_title(title, pad=14 if limits else 6)
    times(axes.xaxis)
    return picture(figure)


def matrix(placement, rows):
    """Medians and, in brackets, the 99th percentiles of all contenders by variant."""
    cells, variants = {}, list(dict.fromkeys(map(Row.variant, rows)))
    for row in rows:
        for name, prefix in ((row.subject, ""), (row.rival, "rival_")):
            of = cells.setdefault(name, {})
            # If one of the two was not measured, it is the rival, unless the subject never was.
            if row.variant() not in of or isinstance(of[row.variant()], Row):
                of[row.variant()] = row if row.absence else (row.figure(prefix + "p50"), row.figure(prefix + "p99"))
    best = {(variant, skein): min((cell[0] for name, of in cells.items() if name.startswith("skein") == skein
                                   and isinstance(cell := of.get(variant), tuple)), default=float("inf"))
            for variant in variants for skein in (True, False)}

    def cell_of(name, variant):
        cell = cells[name].get(variant)
        if cell is None:
            return ""
        if isinstance(cell, Row):
            return "not measured", "bad" if cell.failed else "skipped"
        other = best[variant, False]
        kind = "" if not name.startswith("skein") or other == float("inf") else "good" if cell[0] <= other else "bad"
        return f"{time_text(cell[0])} ({time_text(cell[1])})", kind

    return f"<h3>{escaped(placement)}</h3>" + table(["", *variants], [[name, *(cell_of(name, each) for each in variants)] for name in cells])


def section_of(title, rows):
    measured = [row for row in rows if not row.absence]
    if rows[0].is_of_matrix:
        note = "<p class='note'>Median, and in brackets the 99th percentile. Red: some other contender's median is shorter.</p>"
        return section(title, note, *itertools.starmap(matrix, grouped(rows, lambda row: row.placement).items()))
    pictures = []
    if rows[0].values["unit"] == "us" and rows[0].size is not None:
        with_goal = [row for row in measured if row.goal]
        if with_goal:
            pictures = [ratio_bars(with_goal), latency_panels(measured, list(dict.fromkeys(row.subject for row in with_goal))), tail_panels(with_goal)]
    elif rows[0].values["unit"] == "us":
        pictures = [strips(", ".join(filter(None, [title, place])), of) for place, of in sorted(grouped(measured, Row.place).items())]
    return section(title, *pictures, table_of(rows))


def page_of(rows, goals, run):
    # What has a plot for each placement is a section for each.
    title = lambda row: f"{row.claim}, {row.placement}" if row.placement and not row.is_of_matrix else row.claim  # noqa: E731
    remarks = "".join(f"<p class='bad'>{escaped(remark)}</p>" for remark in run["remarks"] if remark)
    sections = [goals_section(rows, goals), verdict_section(rows), *itertools.starmap(section_of, grouped(rows, title).items()),
                section("The machine", table(["", ""], run["machine"]))]
    return (f"<!doctype html><html lang='en'><head><meta charset='utf-8'><title>Skein: benchmarks</title><style>{STYLE}</style></head><body>"
            f"<h1>Skein: benchmarks</h1><p class='note'>{METHOD}</p>{remarks}{''.join(sections)}</body></html>\n")


def print_summary(rows):
    print(f"{'comparison':<100} {'rival':<24} {'p50 us':>10} {'p99 us':>10} {'p50 x':>7} {'p99 x':>7}")
    for row in rows:
        if row.absence and (row.goal or row.failed):
            print(f"{row.name():<100} {'failed' if row.failed else 'skipped'}: {row.absence}")
        elif row.goal:
            print(f"{row.name():<100} {row.rival:<24} {row.figure('p50'):>10.1f} {row.figure('p99'):>10.1f} {row.p50:>7.2f} {row.p99:>7.2f}")


def main(folder):
    rows = [Row(values) for values in json.loads((folder / "results.json").read_text(encoding="utf-8"))]
    run = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    (folder / "report.html").write_text(page_of(rows, (folder / "goals.md").read_text(encoding="utf-8"), run), encoding="utf-8")
    print_summary(rows)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]))
