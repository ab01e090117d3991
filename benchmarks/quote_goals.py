#!/usr/bin/env python3
"""quote_goals.py FOLDER [README]: puts what a run of skein_bench has measured into the table of goals in benchmarks/README.md.

FOLDER has the run's goals.md, which skein_bench makes of the same comparisons as results.json. A goal that the run did not
measure keeps its row of an earlier run.
"""

import datetime
import os
import pathlib
import re
import sys

HEAD = "| goal | limit | worst | comparisons that meet it | run of |\n|---|---|---|---|---|\n"
_TABLE = re.compile(r"^\| goal \|.*?(?=^[^|]|\Z)", re.MULTILINE | re.DOTALL)


def rows(table):
    """The cells of each row but the head, by the goal's text."""
    cells = ([cell.strip() for cell in line.strip().strip("|").split("|")] for line in table.splitlines()[2:] if line.startswith("|"))
    return {row[0]: row for row in cells}


def merged(quoted, measured, date):
    """The table that was quoted, with the rows that were measured."""
    before = rows(quoted)
    lines = []
    for goal, row in rows(measured).items():
        if row[3] == "not measured":
            row = before.get(goal, [*row, ""])
        else:
            row = [*row, date]
        lines.append("| " + " | ".join(row) + " |\n")
    return HEAD + "".join(lines)


def main(folder, readme=pathlib.Path(__file__).parent / "README.md"):
    goals = pathlib.Path(folder) / "goals.md"
    readme = pathlib.Path(readme)
    text = readme.read_text(encoding="utf-8")
    table = _TABLE.search(text)
    if not table:
        sys.exit(f"{readme} has no table of goals")
    date = datetime.date.fromtimestamp(os.path.getmtime(goals)).isoformat()
    new = merged(table.group(), goals.read_text(encoding="utf-8"), date)
    readme.write_text(text[: table.start()] + new + text[table.end() :], encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(*sys.argv[1:])
