#!/usr/bin/python3
"""usage: aslib.py FOLDER   (needs python3-yaml)

Prints a scenario of ASlib as JSON, with the members of Scenario in scenario.hpp. If the scenario cannot be replayed, it prints the
file, the line if there is one, the cause and the remedy, and the exit code is 1.
"""
import json
import math
import re
import sys
from pathlib import Path

import yaml

MOST_SECONDS = 1e8  # ten times as many fit into a Duration
KEYS = ("instance_id", "repetition")
TYPES = {"numeric": float, "real": float, "integer": float, "string": str, "date": str}
QUOTED = r"""'(?:\\.|[^'\\])*'|"(?:\\.|[^"\\])*\""""
ATTRIBUTE = re.compile(rf"@attribute\s*({QUOTED}|[^\s{{]*)\s*(.*)", re.IGNORECASE)
VALUE = {end: re.compile(rf"\s*(?:({QUOTED})|([^,{end}]*))\s*") for end in ("", "}")}


class Refused(Exception):
    """What is told to the person who wrote the scenario."""


def unquoted(text):
    return re.sub(r"\\(.)", r"\1", text[1:-1]) if text[:1] in ("'", '"') else text


def values(text, end, refuse):
    """The values up to `end`, None for a `?` that is not quoted; and the text behind them."""
    found, at = [], 0
    while True:
        match = VALUE[end].match(text, at)
        plain = (match[2] or "").strip()
        if match[1]:
            found.append(unquoted(match[1]))
        elif plain[:1] in ("'", '"') and plain:
            refuse("a quote is not closed", f"end the value with {plain[0]}")
        elif not plain:
            refuse("a value is empty", "write ? for one that is missing")
        else:
            found.append(None if plain == "?" else plain)
        at = match.end()
        if text[at : at + 1] != ",":
            return found, text[at:]
        at += 1


class Table:
    """A file in the Attribute-Relation File Format. Attributes are found by name, whatever its case."""

    def __init__(self, path):
        self.path = path
        self.types = {}  # by name as declared: float, str, or the list of nominal values
        self.rows = None  # each with its line and its texts by name in lower case
        try:
            lines = path.read_text(encoding="utf-8-sig").split("\n")
        except OSError:
            raise Refused(f"{path} cannot be read; name a file that can") from None
        for line, text in enumerate(lines, 1):
            text = text.strip()
            if text and not text.startswith("%"):
                (self.declare if self.rows is None else self.add)(line, text)
        if self.rows is None:
            raise Refused(f"{path} has no @DATA; write it above the first row of values")

    def refuse(self, line, cause, remedy):
        raise Refused(f"{self.path}:{line}: {cause}; {remedy}")

    def declare(self, line, text):
        keyword = text.split()[0].lower().rstrip(",")  # @DATA, in CPMP-2015
        if keyword == "@attribute":
            self.declare_attribute(line, *ATTRIBUTE.match(text).groups())
        elif keyword == "@data":
            if not self.types:
                self.refuse(line, "no attribute is declared", "write an @ATTRIBUTE per column above @DATA")
            self.rows = []
        elif keyword != "@relation":
            self.refuse(line, f"'{keyword}' is no declaration of ARFF", "write @RELATION, @ATTRIBUTE or @DATA, and rows below @DATA")

    def declare_attribute(self, line, name, kind):
        name = unquoted(name)
        if not name:
            self.refuse(line, "an attribute has no name", "write @ATTRIBUTE NAME TYPE")
        if self.find(name):
            self.refuse(line, f"attribute '{name}' is declared twice", "rename or remove one of them")
        if kind.startswith("{"):
            self.types[name], rest = values(kind[1:], "}", lambda *what: self.refuse(line, *what))
            if not rest.startswith("}"):
                self.refuse(line, "a list of nominal values is not closed", "separate the values by commas, and end it with }")
        else:
            kind = (kind.split() or [""])[0].lower()
            if kind not in TYPES:
                remedy = "use NUMERIC, REAL, INTEGER, STRING, DATE or a list of values in braces"
                self.refuse(line, f"type '{kind}' is not supported", remedy)
            self.types[name] = TYPES[kind]

    def add(self, line, text):
        if text.startswith("{"):
            self.refuse(line, "sparse rows are not supported", "write a value per attribute")
        cells, rest = values(text, "", lambda *what: self.refuse(line, *what))
        if rest:
            self.refuse(line, "text follows a quoted value", "write a comma between values")
        if len(cells) != len(self.types):
            cause = f"the row has {len(cells)} values, but {len(self.types)} attributes are declared"
            self.refuse(line, cause, "write one value per attribute, and quotes around values with commas")
        for (name, kind), cell in zip(self.types.items(), cells):
            if cell is not None and isinstance(kind, list) and cell not in kind:
                remedy = "write one that its declaration lists, or add it there"
                self.refuse(line, f"attribute '{name}' has no value '{cell}'", remedy)
            if cell is not None and kind is float:
                try:
                    float(cell)
                except ValueError:
                    cause = f"'{cell}' is no number, as attribute '{name}' must be"
                    self.refuse(line, cause, "write a number, or ? if it is missing")
        self.rows.append((line, dict(zip(map(str.lower, self.types), cells))))

    def find(self, name):
        return next((each for each in self.types if each.lower() == name.lower()), None)

    def column(self, name):
        found = self.find(name)
        if found is None:
            raise Refused(f"{self.path} has no attribute '{name}'; declare it with @ATTRIBUTE")
        return found

    def text(self, row, name):
        found = row[1][self.column(name).lower()]
        if found is None:
            self.refuse(row[0], f"'{name}' is missing", "write it, since every row needs it")
        return found

    def number(self, row, name, default=None):
        """A nominal value counts by its place in the declaration; default for text and for what is missing or not finite."""
        name = self.column(name)
        kind, cell = self.types[name], row[1][name.lower()]
        if cell is None or kind is str:
            return default
        found = kind.index(cell) if isinstance(kind, list) else float(cell)
        return found if math.isfinite(found) else default

    def means(self, columns):
        """By instance and column, over the repetitions."""
        found = {}
        for row in self.rows:
            for column in columns:
                value = self.number(row, column)
                if value is not None:
                    found.setdefault(self.text(row, "instance_id"), {}).setdefault(column, []).append(value)
        return {name: {column: sum(each) / len(each) for column in columns if (each := of.get(column))} for name, of in found.items()}


class Description:
    """What description.txt says."""

    def __init__(self, path):
        self.path = path
        try:
            text = path.read_text(encoding="utf-8")
        except OSError:
            raise Refused(f"{path} cannot be read; name an ASlib folder") from None
        # Published scenarios write `key: ?` for what is not known, which in YAML begins a key.
        self.text = re.sub(r"(:|^\s*-)\s*\?\s*$", r"\1 '?'", text, flags=re.MULTILINE)
        try:
            self.root = yaml.load(self.text, yaml.BaseLoader)  # which leaves numbers as texts
        except yaml.MarkedYAMLError as error:
            raise Refused(f"{path}:{error.problem_mark.line + 1}: it is no YAML: {error.problem}; correct it") from None
        if not isinstance(self.root, dict):
            raise Refused(f"{path}:1: it has no keys; write `scenario_id: NAME` and so on")
        self.read_steps()

    def refuse(self, key, cause, remedy):
        lines = self.text.split("\n")
        line = next((f":{number}" for number, text in enumerate(lines, 1) if re.match(rf"\s*{re.escape(key)}\s*:", text)), "")
        raise Refused(f"{self.path}{line}: {cause}; {remedy}")

    def list(self, key, of=None):
        """A list, the keys of a map, or a text with commas, without those that are not known."""
        found = (self.root if of is None else of).get(key, "")
        found = found.split(",") if isinstance(found, str) else [each for each in found if isinstance(each, str)]
        return [each.strip() for each in found if each.strip() not in ("", "?")]

    def runtime(self):
        types = [each.lower() for each in self.list("performance_type")]
        if "runtime" not in types:
            remedy = "only scenarios that measure a runtime can be replayed in time"
            self.refuse("performance_type", "no performance_type is 'runtime'", remedy)
        return (self.list("performance_measures") + ["runtime"] * len(types))[types.index("runtime")]

    def cutoff_s(self):
        try:
            cutoff = float(self.list("algorithm_cutoff_time")[0])
            if 0 < cutoff <= MOST_SECONDS:
                return cutoff
        except (IndexError, ValueError):
            pass
        remedy = "write the seconds after which a run was stopped: a positive number up to 1e8"
        self.refuse("algorithm_cutoff_time", "algorithm_cutoff_time is no time", remedy)

    def algorithms(self):
        """Empty if it lists none."""
        split = self.list("algorithms_deterministic") + self.list("algorithms_stochastic")
        return set(self.list("metainfo_algorithms") or split)

    def read_steps(self):
        """The default steps, or else all, and those that they require: self.used; and what these provide."""
        steps = self.root.get("feature_steps") or {}
        if steps == "?":
            steps = {}
        if not isinstance(steps, dict):
            remedy = "write `NAME:` per step, and below it `provides:` and a list of features"
            self.refuse("feature_steps", "feature_steps has no names", remedy)
        for name, step in steps.items():
            if not isinstance(step, dict):
                remedy = "write `provides:` and a list of features below it"
                self.refuse(name, f"feature step '{name}' does not say what it provides", remedy)
        # Steps of features of algorithms stand among the default ones.
        self.of_algorithms = self.list("algorithm_feature_steps")
        waiting = [each for each in self.list("default_steps") if each in steps or each not in self.of_algorithms]
        self.used, self.provided = [], set()
        waiting = waiting or list(steps)
        while waiting:
            name = waiting.pop(0)
            if name in self.used:
                continue
            if name not in steps:
                cause = f"feature step '{name}' is used, but feature_steps does not have it"
                self.refuse("feature_steps", cause, "add it there, or correct default_steps and requires")
            self.used.append(name)
            self.provided.update(self.list("provides", steps[name]))
            waiting += self.list("requires", steps[name])
        self.has_steps = bool(steps)


class Reader:
    def __init__(self, folder):
        self.folder = folder
        self.description = Description(folder / "description.txt")
        self.id = (self.description.list("scenario_id") or [folder.name])[0]
        self.cutoff_s = self.description.cutoff_s()
        self.runtime = self.description.runtime()
        self.notes = [f"the features of algorithms are left out: step '{each}'" for each in self.description.of_algorithms]

    def read(self):
        runs = self.read_runs()
        self.algorithms = self.choose_algorithms({by for of in runs.values() for by in of})
        folds = self.read_folds(runs)
        features = self.read_features()
        costs = self.read_costs()
        presolved = self.read_presolved()
        unknown = {"known": False, "solved": False, "late": False, "time_s": 0}
        instances = [
            {
                "name": name,
                "fold": folds[name],
                "runs": [self.summary(runs[name][by]) if by in runs[name] else unknown for by in self.algorithms],
                "features": list(features.get(name, {}).items()),
                "features_cost_s": sum(max(0.0, cost) for cost in costs.get(name, {}).values()),
                "presolved": name in presolved,
            }
            for name in runs
            if name in folds
        ]
        return {"id": self.id, "cutoff_s": self.cutoff_s, "algorithms": self.algorithms, "instances": instances, "notes": self.notes}

    def read_runs(self):
        """By instance and algorithm: of each repetition the time, and whether it solved and was late."""
        table = Table(self.folder / "algorithm_runs.arff")
        column = self.runtime_column(table)
        runs = {}
        for row in table.rows:
            of = runs.setdefault(table.text(row, "instance_id"), {}).setdefault(table.text(row, "algorithm"), {})
            repetition = table.number(row, "repetition", 1)
            if repetition in of:
                table.refuse(row[0], "this repetition of the run is there already", "remove one of them")
            time_s = table.number(row, column, self.cutoff_s)
            if time_s < 0:
                table.refuse(row[0], "the runtime is negative", "write seconds, or ? if it is missing")
            status = table.text(row, "runstatus").lower()
            late = status == "timeout" or time_s >= self.cutoff_s
            of[repetition] = (self.cutoff_s if late else time_s, status == "ok" and not late, late)
        return runs

    def runtime_column(self, table):
        """Some scenarios name the measure otherwise; it follows the algorithm."""
        names = [*table.types, None]
        after = names[names.index(table.column("algorithm")) + 1]
        return table.find(self.runtime) or (after if table.types.get(after) is float else table.column(self.runtime))

    @staticmethod
    def summary(repetitions):
        """The mean time counts, and the run is solved if all are."""
        times, solved, late = zip(*repetitions.values())
        return {"known": True, "solved": all(solved), "late": any(late), "time_s": sum(times) / len(times)}

    def choose_algorithms(self, ran):
        """Those that are listed and ran."""
        listed = self.description.algorithms() or ran
        self.notes += [f"algorithm '{each}' is left out: description.txt does not list it" for each in sorted(ran - listed)]
        self.notes += [f"algorithm '{each}' is left out: it has no run" for each in sorted(listed - ran)]
        if not ran & listed:
            path = self.folder / "algorithm_runs.arff"
            raise Refused(f"{path} has no run of an algorithm that description.txt lists; correct one")
        return sorted(ran & listed)

    def read_folds(self, runs):
        """Of the first repetition."""
        table = Table(self.folder / "cv.arff")
        first = min((table.number(row, "repetition", 1) for row in table.rows), default=1)
        folds = {}
        for row in table.rows:
            if table.number(row, "repetition", 1) != first:
                continue
            fold, name = table.number(row, "fold"), table.text(row, "instance_id")
            if fold is None:
                table.refuse(row[0], "the fold is missing", "write its number")
            if name in folds:
                table.refuse(row[0], "the instance has a fold already", "remove one of the rows")
            folds[name] = int(fold)
        self.notes += [f"instance '{each}' is left out: it has no run" for each in sorted(folds) if each not in runs]
        self.notes += [f"instance '{each}' is left out: cv.arff gives it no fold" for each in runs if each not in folds]
        if not set(folds) & set(runs):
            raise Refused(f"{table.path} has no instance of algorithm_runs.arff; give each one a fold")
        return folds

    def read_features(self):
        table = Table(self.folder / "feature_values.arff")
        provided, has_steps = self.description.provided, self.description.has_steps
        return table.means([each for each in table.types if (each in provided if has_steps else each.lower() not in KEYS)])

    def step_columns(self, table):
        """The columns of the steps that are used."""
        used = [each.lower() for each in self.description.used]
        return [each for each in table.types if each.lower() not in KEYS and (not used or each.lower() in used)]

    def read_costs(self):
        path = self.folder / "feature_costs.arff"
        if not path.exists():
            return {}
        table = Table(path)
        return table.means(self.step_columns(table))

    def read_presolved(self):
        path = self.folder / "feature_runstatus.arff"
        if not path.exists():
            return set()
        table = Table(path)
        columns = [each.lower() for each in self.step_columns(table)]
        return {
            table.text(row, "instance_id")
            for row in table.rows
            if any((row[1][column] or "").lower() == "presolved" for column in columns)
        }


def read(folder):
    return Reader(Path(folder)).read()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        print(json.dumps(read(sys.argv[1])))
    except Refused as error:
        sys.exit(print(error) or 1)
