#!/usr/bin/python3
"""The rival of skein-select: per algorithm a random forest that predicts its PAR10 from the features of an instance.

usage: random_forest.py SCENARIO...   (ASlib folders; needs python3-sklearn and python3-yaml)

Replays the folds of cv.arff, repetition 1. Missing features are the training mean. The cost of the features is charged;
an instance that they solved counts as solved at their cost. Prints the gap closed per seed, and the median.
"""
import statistics
import sys
from pathlib import Path

import aslib
import numpy
from sklearn.ensemble import RandomForestRegressor

SEEDS = range(1, 6)
TREES = 500
PENALTY = 10


class Scenario:
    def __init__(self, folder):
        scenario = aslib.read(folder)
        instances = sorted(scenario["instances"], key=lambda each: each["name"])
        self.cutoff = scenario["cutoff_s"]
        self.folds = numpy.array([each["fold"] for each in instances])
        self.par10 = numpy.array([[run["time_s"] if run["solved"] else PENALTY * self.cutoff for run in each["runs"]] for each in instances])
        columns = list(dict.fromkeys(name for each in instances for name, _ in each["features"]))
        self.features = numpy.array([[dict(each["features"]).get(name, numpy.nan) for name in columns] for each in instances])
        self.cost = numpy.array([each["features_cost_s"] for each in instances])
        self.presolved = numpy.array([each["presolved"] for each in instances])


def filled(values, train):
    """Missing features as the training mean; 0 where no training instance has one."""
    known = numpy.where(numpy.isfinite(values[train]), values[train], numpy.nan)
    count = numpy.maximum(1, numpy.sum(~numpy.isnan(known), axis=0))
    return numpy.where(numpy.isfinite(values), values, numpy.nansum(known, axis=0) / count)


def choices(scenario, seed):
    """The column of the algorithm with the least predicted PAR10, per instance."""
    chosen = numpy.zeros(len(scenario.folds), dtype=int)
    for fold in sorted(set(scenario.folds)):
        train, test = scenario.folds != fold, scenario.folds == fold
        features = filled(scenario.features, train).astype(numpy.float32)
        predicted = []
        for column in range(scenario.par10.shape[1]):
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
