#!/usr/bin/python3
"""The rival of skein-select: per algorithm a random forest that predicts its PAR10 from the features of an instance.

usage: random_forest.py SCENARIO...   (ASlib folders; needs python3-sklearn and python3-yaml)

Replays the folds of cv.arff, repetition 1. Missing features are the training mean. The cost of the features is charged;
an instance that they solved counts as solved at their cost. Prints the gap closed per seed, and the median.
"""
import statistics
import sys
from pathlib import Path

import numpy
import yaml
from sklearn.ensemble import RandomForestRegressor

SEEDS = range(1, 6)
TREES = 500
PENALTY = 10


def split(line, separator):
    """Splits at `separator` (a comma, or None for white space), but not within quotes."""
    parts, current, quote, escaped = [], "", "", False
    for letter in line.strip():
        if escaped:
            current, escaped = current + letter, False
        elif quote and letter == "\\":
            escaped = True
        elif quote:
            if letter == quote:
                quote = ""
            else:
                current += letter
        elif letter in "'\"" and not current.strip():
            current, quote = "", letter
        elif letter == separator or (separator is None and letter.isspace()):
            parts.append(current.strip())
            current = ""
        else:
            current += letter
    return parts + [current.strip()]


def read_arff(path):
    """The rows as dictionaries by attribute, `?` as None."""
    names, rows, in_data = [], [], False
    for line in path.read_text(encoding="utf-8-sig").splitlines():
        line = line.strip()
        if not line or line.startswith("%"):
            continue
        if in_data:
            rows.append({name: None if value == "?" else value for name, value in zip(names, split(line, ","))})
        elif line.lower().startswith("@attribute"):
            names.append(split(line[len("@attribute"):], None)[0])
        elif line.lower().startswith("@data"):
            in_data = True
    return names, rows


def as_list(value):
    if value is None or value in ("", "?"):
        return []
    return value if isinstance(value, list) else [each.strip() for each in str(value).split(",")]


def used_steps(description):
    """The default steps, or else all, and those that they require."""
    steps = description.get("feature_steps") or {}
    waiting, used = as_list(description.get("default_steps")) or list(steps), []
    while waiting:
        step = waiting.pop(0)
        if step not in used:
            used.append(step)
            waiting += as_list((steps.get(step) or {}).get("requires"))
    return steps, used


class Scenario:
    def __init__(self, folder):
        self.description = yaml.safe_load((folder / "description.txt").read_text())
        self.cutoff = float(self.description["algorithm_cutoff_time"])
        self.folds = self.read_folds(folder)
        self.instances = sorted(self.folds)
        self.steps, self.used = used_steps(self.description)
        self.algorithms, self.par10 = self.read_runs(folder)
        self.features = self.read_features(folder)
        self.cost = self.read_cost(folder)
        self.presolved = self.read_presolved(folder)

    @staticmethod
    def read_folds(folder):
        _, rows = read_arff(folder / "cv.arff")
        first = min(float(row["repetition"]) for row in rows)
        return {row["instance_id"]: float(row["fold"]) for row in rows if float(row["repetition"]) == first}

    def read_runs(self, folder):
        names, rows = read_arff(folder / "algorithm_runs.arff")
        measure = as_list(self.description["performance_measures"])[0]
        column = next((name for name in names if name.lower() == measure.lower()), names[3])
        algorithms = sorted({row["algorithm"] for row in rows})
        place = {instance: i for i, instance in enumerate(self.instances)}
        par10 = numpy.full((len(place), len(algorithms)), PENALTY * self.cutoff)
        for row in rows:
            if row["instance_id"] in place and row["runstatus"].lower() == "ok" and float(row[column]) < self.cutoff:
                par10[place[row["instance_id"]], algorithms.index(row["algorithm"])] = float(row[column])
        return algorithms, par10

    def read_features(self, folder):
        names, rows = read_arff(folder / "feature_values.arff")
        provided = {str(f) for step in self.used for f in as_list((self.steps.get(step) or {}).get("provides"))}
        columns = [name for name in names if name in provided or (not self.steps and name not in names[:2])]
        by_instance = {row["instance_id"]: row for row in rows}
        return numpy.array([[self.number(by_instance.get(instance, {}).get(column)) for column in columns]
                            for instance in self.instances])

    @staticmethod
    def number(text):
        return float("nan") if text is None else float(text)

    def read_cost(self, folder):
        path = folder / "feature_costs.arff"
        rows = {row["instance_id"]: row for row in read_arff(path)[1]} if path.exists() else {}
        return numpy.array([sum(float(rows.get(instance, {}).get(step) or 0) for step in self.used)
                            for instance in self.instances])

    def read_presolved(self, folder):
        path = folder / "feature_runstatus.arff"
        rows = {row["instance_id"]: row for row in read_arff(path)[1]} if path.exists() else {}
        return numpy.array([any(rows.get(instance, {}).get(step) == "presolved" for step in self.used)
                            for instance in self.instances])


def filled(values, train):
    """Missing features as the training mean; 0 where no training instance has one."""
    known = numpy.where(numpy.isfinite(values[train]), values[train], numpy.nan)
    count = numpy.maximum(1, numpy.sum(~numpy.isnan(known), axis=0))
    return numpy.where(numpy.isfinite(values), values, numpy.nansum(known, axis=0) / count)


def choices(scenario, seed):
    """The column of the algorithm with the least predicted PAR10, per instance."""
    fold_of = numpy.array([scenario.folds[instance] for instance in scenario.instances])
    chosen = numpy.zeros(len(fold_of), dtype=int)
    for fold in sorted(set(fold_of)):
        train, test = fold_of != fold, fold_of == fold
        features = filled(scenario.features, train).astype(numpy.float32)
        predicted = []
        for column in range(len(scenario.algorithms)):
            forest = RandomForestRegressor(n_estimators=TREES, random_state=seed, n_jobs=1)
            forest.fit(features[train], scenario.par10[train, column])
            predicted.append(forest.predict(features[test]))
        chosen[test] = numpy.argmin(predicted, axis=0)
    return chosen


def gap_closed(scenario, chosen):
    alone = scenario.par10[numpy.arange(len(chosen)), chosen]
    time = scenario.cost + numpy.where(scenario.presolved, 0, alone)
    score = numpy.where(time <= scenario.cutoff, time, PENALTY * scenario.cutoff).mean()
    single_best, virtual_best = scenario.par10.mean(axis=0).min(), scenario.par10.min(axis=1).mean()
    return (single_best - score) / (single_best - virtual_best)


def main():
    if len(sys.argv) < 2:
        sys.exit("usage: random_forest.py SCENARIO...")
    for folder in sys.argv[1:]:
        scenario = Scenario(Path(folder))
        gaps = []
        for seed in SEEDS:
            gaps.append(gap_closed(scenario, choices(scenario, seed)))
            print(f"{Path(folder).name} seed {seed} gap_closed {gaps[-1]:.4f}", flush=True)
        print(f"{Path(folder).name} median gap_closed {statistics.median(gaps):.4f}", flush=True)


if __name__ == "__main__":
    main()
