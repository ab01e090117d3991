#!/usr/bin/env python3
"""Flies the reconnaissance mission with several seeds, on each DDS vendor and on both in turn, and prints a line for each.

    seeds.py [--seeds 20] [--profile FILE] [--skein PROGRAM] [ARGUMENTS of skein launch]

The reports of all flights stay in the folder that is named at the end. Ends with 0 if all have passed, else with 1."""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

VENDORS = (("fastdds", "cyclonedds"), ("fastdds", "fastdds"), ("cyclonedds", "cyclonedds"))
COLUMNS = ("seed", "vendors", "verdict", "targets", "coarsest", "tracked", "P_s", "misses", "min")
WIDTHS = (4, 22, 10, 7, 8, 8, 6, 6, 5)


def line(values):
    return "  ".join(f"{value:>{width}}" for value, width in zip(values, WIDTHS)).rstrip()


def fly(skein, profile, seed, arguments, folder):
    """The report of a flight, or nothing where it was not flown; and its exit code."""
    vendor_a, vendor_b = VENDORS[(seed - 1) % len(VENDORS)]
    results = folder / f"seed_{seed}"
    with open(folder / f"seed_{seed}.log", "w", encoding="utf-8") as log:
        code = subprocess.run(
            [skein, "launch", profile, "--variable", f"seed={seed}", "--variable", f"vendor_a={vendor_a}", "--variable", f"vendor_b={vendor_b}",
             "--set", f"ground_station.Results={results}", *arguments], stdout=log, stderr=subprocess.STDOUT, check=False).returncode
    report = results.with_suffix(".json")
    return code, json.loads(report.read_text(encoding="utf-8")) if report.exists() else None


def told(seed, code, report):
    vendors = "+".join(dict.fromkeys(VENDORS[(seed - 1) % len(VENDORS)]))
    if report is None:
        return line((seed, vendors, f"exit {code}", "", "", "", "", "", ""))
    collected = [target for target in report["targets"] if target["collected_s"] is not None]
    coarsest = max((target["achieved_sample_m"] for target in collected), default=0)
    misses = report["lost_samples"] + sum(decision["late"] for decision in report["decisions"])
    verdict = report["verdict"] if code == 0 else f"{report['verdict']} ({code})"
    return line((seed, vendors, verdict, f"{len(collected)}/{len(report['targets'])}", f"{coarsest:.2f} m", f"{report['tracked_s']:.0f} s",
                 f"{report['survival']:.3f}", misses, f"{report['duration_s'] / 60:.1f}"))


def main():
    here = pathlib.Path(__file__).resolve().parent
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=20, help="how many, from 1")
    parser.add_argument("--profile", default=here.parent.parent / "mission_profiles" / "reconnaissance" / "reconnaissance.xml")
    parser.add_argument("--skein", default="skein", help="the program, by default as PATH has it")
    options, arguments = parser.parse_known_args()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="reconnaissance-"))
    print(line(COLUMNS), flush=True)
    passed = 0
    for seed in range(1, options.seeds + 1):
        code, report = fly(options.skein, options.profile, seed, arguments, folder)
        passed += code == 0
        print(told(seed, code, report), flush=True)
        if code in (64, 71, 78):
            print((folder / f"seed_{seed}.log").read_text(encoding="utf-8"), file=sys.stderr)
            break
    print(f"{passed} of {options.seeds} passed; reports and logs: {folder}")
    sys.exit(0 if passed == options.seeds else 1)


if __name__ == "__main__":
    main()
