#!/usr/bin/env python3
"""run_tests.py PRESET [--long | --changed[=COMMIT]] [CTEST ARGUMENTS…]: runs tests by ctest, by the law of their class.

A test of class `real` that fails runs again, alone, twice at most; where it then passes it is a suspect, and listed at the end. Never run
again: a test of class `logic` or `long`, a crash, a sanitizer's report, a broken INVARIANT, and more tests than fail by luck. Those of
test/SUSPECTS.md's quarantine run and are reported, but do not block.

Left out are tests of class `long`, unless -R or -L names them. --long runs these, and those that can be lengthened. --changed leaves out
what the files that differ from COMMIT, or else from the last landed commit, cannot break.
"""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as xml

import affected_tests
from cores import Cores, stacks

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "architecture"))
from source_tree import SourceTree  # noqa: E402

CLASSES = {"logic", "real", "long"}
MOST_REPEATS = 2
MOST_UNLUCKY = 5
MOST_QUARANTINED = 3
# What a test's output says where running it again would hide a defect. The first two are expected of tests that expect cores.
_CRASHES = re.compile(r"^died by a signal in: |^terminate called |Assertion .* failed|^(free|malloc|double free|corrupted)\b.*:", re.MULTILINE)
_DEFECTS = {
    "a broken invariant": re.compile(r"\bINVARIANT\("),
    "a sanitizer's report": re.compile(r"\b(Address|Leak|Thread|UndefinedBehavior)Sanitizer\b|runtime error: "),
}
# How ctest names the end of a test that only failed; all else is a signal.
_PLAIN_ENDS = {"Failed", "Timeout", "Not Run"}
_WHAT_FAILED = re.compile(r"FAILED:|died by a signal in:|Sanitizer:|runtime error:|Error|error:")


class Test:
    def __init__(self, described, build):
        properties = {entry["name"]: entry["value"] for entry in described.get("properties", [])}
        self.name = described["name"]
        labels = properties.get("LABELS", [])
        classes = CLASSES & set(labels)
        floors = [label for label in labels if label.startswith("floor_")]
        if len(classes) != 1 or len(floors) != 1:
            raise ValueError(f"test {self.name} has the labels {labels}; each has one class of {sorted(CLASSES)} and one floor:"
                             " see skein_test_class in test/CMakeLists.txt")
        self.kind = classes.pop()
        self.floor = int(floors[0].removeprefix("floor_"))
        self.expects_cores = "expects_cores" in labels
        self.folder = _folder(properties.get("WORKING_DIRECTORY", ""), build)


def _folder(binary_directory, build):
    """test/AREA of the build, as AREA; benchmarks as it is."""
    below = os.path.relpath(os.path.realpath(binary_directory), os.path.realpath(build))
    parts = [part for part in pathlib.PurePath(below).parts if part != "test"]
    return parts[0] if parts else "test"


class Failure:
    """What is known of a test that failed: how it ended, what it said (None where that was lost), and on how busy a machine."""

    def __init__(self, test, end, output, load):
        self.test, self.end, self.output, self.load = test, end, output, load

    def defect(self, crashed):
        """Why it may not run again; None where it may. Processes of the tests in `crashed` died by signals that nobody expected."""
        if self.end not in _PLAIN_ENDS:
            return f"a crash ({self.end})"
        if self.output is None:
            return "its output was lost"
        for what, pattern in _DEFECTS.items():
            if pattern.search(self.output):
                return what
        if not self.test.expects_cores and _CRASHES.search(self.output):
            return "a crash"
        return "a crash of one of its processes" if self.test.name in crashed else None

    def first_words(self):
        """Where it failed, in one line."""
        lines = (self.output or "").splitlines()
        for number, line in enumerate(lines):
            if _WHAT_FAILED.search(line):
                return " ".join(part.strip() for part in lines[number:number + 2])[:160]
        return self.end

    def seed(self):
        """The environment in which it draws the same chances again."""
        said = re.search(r"SKEIN_SEED=(\d+)", self.output or "")
        return {"SKEIN_SEED": said.group(1)} if said else {}


class Runner:
    def __init__(self, preset, root, cores):
        self.preset, self.root, self.cores = preset, root, cores
        self.build = root / ("build" if preset == "default" else f"build/{preset}")
        self.tests = {test.name: test for test in self._described()}

    def _described(self):
        shown = subprocess.run(["ctest", "--preset", self.preset, "--show-only=json-v1"], cwd=self.root,
                               capture_output=True, text=True, check=True).stdout
        return [Test(test, self.build) for test in json.loads(shown[shown.index("{"):])["tests"]]

    def crashed(self):
        """The tests of which a process died by a signal that was not expected; all of them where it is not known whose it was."""
        found = self.cores.by_test()
        if "" in found:
            return set(self.tests)
        return {name for name in found if name in self.tests and not self.tests[name].expects_cores}

    def run(self, arguments, environment=None):
        """ctest's exit code, {name: Failure} of what failed in one run, and the names of those that really ran."""
        results = self.build / "test_results.xml"
        results.unlink(missing_ok=True)
        command = ["ctest", "--preset", self.preset, "--output-junit", str(results), "--test-output-size-failed", "0", *arguments]
        with subprocess.Popen(command, cwd=self.root, stdout=subprocess.PIPE, text=True, errors="replace",
                              env=os.environ | (environment or {})) as process:
            try:
                ends, loads = _follow(process.stdout)
            except BaseException:
                process.terminate()  # which is waited for, else
                raise
        cases = list(xml.parse(results).getroot().iter("testcase")) if results.exists() else []
        outputs = {case.get("name"): case.findtext("system-out") or "" for case in cases}
        ran = {case.get("name") for case in cases if case.get("status") == "run"}
        failures = {name: Failure(self.tests[name], end, outputs.get(name), loads.get(name, "")) for name, end in ends.items()
                    if name in self.tests}
        return process.returncode, failures, ran

    def again(self, failure):
        """Runs a test that failed alone: (None, how often it ran) once it passes, else (why it failed for good, …)."""
        name = failure.test.name
        for repeat in range(1, MOST_REPEATS + 1):
            print(f"--- {name} runs again, alone ({repeat} of {MOST_REPEATS})", flush=True)
            code, failures, ran = self.run(["-R", f"^{re.escape(name)}$"], failure.seed())
            crashed = self.crashed()
            for again in failures.values():  # it, or what it needs to have run before it
                if defect := again.defect(crashed):
                    self.keep(again)
                    return f"{again.test.name} in a further run: {defect}", repeat
            if name in crashed:
                return "a crash of one of its processes in a further run", repeat
            if code == 0 and name in ran:
                return None, repeat
        return f"failed {MOST_REPEATS + 1} times", MOST_REPEATS

    def keep(self, failure):
        folder = self.root / "build" / "suspects"
        folder.mkdir(parents=True, exist_ok=True)
        log = folder / f"{failure.test.name}.{self.preset}.log"
        log.write_text(failure.output or "", encoding="utf-8")
        return log.relative_to(self.root)


def _follow(lines):
    """Passes ctest's output on: {name: how it ended} of tests that failed, by its last list of them, and {name: load} at their ends."""
    failed, loads, in_list = {}, {}, False
    for line in lines:
        sys.stdout.write(line)
        sys.stdout.flush()
        if ended := re.match(r"\s*\d+/\d+ Test\s+#\d+: (\S+) \.*\s*(\S*\*\*\*.*?)\s+[\d.]+ sec", line):
            loads[ended.group(1)] = " ".join(f"{load:.1f}" for load in os.getloadavg()[:2])
        if line.startswith("The following tests FAILED:"):
            failed, in_list = {}, True
        elif in_list and (listed := re.match(r"\s*\d+ - (\S+) \((.*)\)", line)):
            failed[listed.group(1)] = listed.group(2)
        else:
            in_list = False
    return failed, loads


def quarantined(root):
    """{test: reason} of the table below "## Quarantine" in test/SUSPECTS.md."""
    ledger = root / "test" / "SUSPECTS.md"
    if not ledger.exists():
        return {}
    table = ledger.read_text(encoding="utf-8").partition("## Quarantine")[2]
    rows = dict(re.findall(r"^\| `(\S+)` \| (.*?) \|", table, re.MULTILINE))
    if len(rows) > MOST_QUARANTINED:
        raise ValueError(f"{ledger} has {len(rows)} tests in quarantine; {MOST_QUARANTINED} are the most: mend one")
    return rows


def selection(arguments, tests, root):
    """ctest's arguments for what is asked for."""
    rest = [argument for argument in arguments if not re.match(r"--long$|--changed(=|$)", argument)]
    asked = [argument for argument in arguments if argument not in rest]
    named = [argument for argument in rest if re.match(r"(-R|-L|--tests-regex|--label-regex|--rerun-failed)(=|$)", argument)]
    if len(asked) > 1 or (named and asked and asked[0] != "--long"):
        raise ValueError(f"{' '.join([*asked, *named])} exclude each other: give one of them")
    if asked == ["--long"]:
        return ["-L", "^(long|lengthened)$", "--parallel", "1", *rest]
    if asked:
        return [*_changed(asked[0].partition("=")[2], tests, root), *rest]
    if named:
        return rest
    if "-LE" in rest[:-1]:  # of several, ctest leaves out what matches them all
        given = rest.index("-LE") + 1
        return [*rest[:given], f"^long$|{rest[given]}", *rest[given + 1:]]
    return ["-LE", "^long$", *rest]


def _changed(commit, tests, root):
    since = commit or affected_tests.last_landed(str(root))
    files = affected_tests.changed_files(str(root), since)
    affected = affected_tests.Affected(SourceTree(str(root)), files)
    concerned = [test for test in tests if affected.breaks(test.floor, test.folder)]
    chosen = [test.name for test in concerned if test.kind != "long"]
    print(f"{len(files)} files differ from {since}: {len(chosen)} of {len(tests)} tests can tell, and {len(concerned) - len(chosen)} of class"
          " long, which ./dev soak runs", flush=True)
    return ["-R", f"^({'|'.join(map(re.escape, chosen))})$"]


def judge(runner, failures):
    """(suspects, what failed for good) as rows of text, and the names of the latter."""
    spared = quarantined(runner.root)
    suspects, final, unlucky = [], {}, []
    crashed = runner.crashed()
    for name, failure in failures.items():
        row = f"{name} ({runner.preset}): {failure.first_words()}; load {failure.load}; {runner.keep(failure)}"
        if defect := failure.defect(crashed):
            final[name] = f"{row}; never run again: {defect}"
        elif name in spared:
            suspects.append(f"quarantined {row}; {spared[name]}")
        elif failure.test.kind != "real":
            final[name] = f"{row}; of class {failure.test.kind}, which is not run again"
        else:
            unlucky.append((failure, row))
    for failure, row in unlucky:
        if final or len(unlucky) > MOST_UNLUCKY:
            final[failure.test.name] = f"{row}; not run again, since others failed, too"
            continue
        reason, repeats = runner.again(failure)
        if reason:
            final[failure.test.name] = f"{row}; {reason}"
        else:
            suspects.append(f"suspect {row}; passed when run again ({repeats})")
    passed = crashed - set(failures) if "" not in runner.cores.by_test() else set()
    suspects += [f"suspect {name} ({runner.preset}): passed, though one of its processes died by a signal" for name in sorted(passed)]
    return suspects, final


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    preset, arguments = sys.argv[1], sys.argv[2:]
    root = pathlib.Path(__file__).resolve().parents[2]
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # by which the kernel's pattern is set back
    with Cores() as cores:
        if not cores.collecting:
            print("run_tests.py: cores are kept by somebody else here: crashes of tests' further processes are not seen", flush=True)
        try:
            runner = Runner(preset, root, cores)
            chosen = selection(arguments, list(runner.tests.values()), root)
            quarantined(root)
        except ValueError as error:
            sys.exit(f"run_tests.py: {error}")
        begin = time.monotonic()
        code, failures, _ = runner.run(chosen)
        suspects, final = judge(runner, failures)
        crashed = runner.crashed()
        for name, found in cores.by_test().items():
            if name in final or name in crashed or name == "":
                for core in found:
                    print(stacks(core))
    took = time.monotonic() - begin
    if suspects:
        print("--- suspects, for test/SUSPECTS.md:\n" + "\n".join(suspects))
    if final:
        print("--- failed for good:\n" + "\n".join(final.values()))
    print(f"{preset}: {len(final)} failed for good, {len(suspects)} suspects, {took:.0f} s", flush=True)
    sys.exit(1 if final or (code != 0 and not failures) else 0)


if __name__ == "__main__":
    main()
