"""Which tests a change can break: a change on one floor cannot break the floors below, since includes never point upward."""

import os
import re
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "architecture"))
import include_rules  # noqa: E402

# What tests read as text, and no program is built of.
_TEXTS = re.compile(r".*\.md$|LICENSE$|Doxyfile$|\.clang-(format|tidy)$")
_HOLDS_TESTS = re.compile(r"^\s*(TEST_CASE|TEST_CASE_METHOD|TEMPLATE_TEST_CASE|SCENARIO)\b", re.MULTILINE)
# Whose tests look at the whole tree, whatever has changed in it.
_LOOK_AT_ALL = {"architecture", "guide"}
_TOP = 8


def last_landed(root):
    """The commit where this branch has left the one that changes land on."""
    for landing in ("origin/HEAD", "origin/main", "main"):
        base = _git(root, "merge-base", "HEAD", landing)
        if base.returncode == 0:
            return base.stdout.strip()[:12]
    raise ValueError("which commit landed last is not known here, as there is neither origin nor main: say --changed=COMMIT")


def changed_files(root, since):
    """Those that differ from a commit, and those that are new."""
    difference = _git(root, "diff", "--name-only", "--no-renames", since, "--")
    if difference.returncode != 0:
        raise ValueError(f"git knows no commit '{since}': {difference.stderr.strip()}")
    return difference.stdout.split() + _git(root, "ls-files", "--others", "--exclude-standard").stdout.split()


def _git(root, *arguments):
    return subprocess.run(["git", "-C", root, *arguments], capture_output=True, text=True, check=False)


class Affected:
    """What a change of some files can break: tests from a floor on, and tests of some folders."""

    def __init__(self, tree, files):
        self.floor = _TOP + 1
        self.folders = set(_LOOK_AT_ALL)
        for path in files:
            self._add(tree, path)

    def breaks(self, floor, folder):
        return floor >= self.floor or folder in self.folders

    def _add(self, tree, path):
        top = path.split("/")[0]
        if top in ("examples", "mission_profiles"):  # texts, too, which tests hold to the code
            self.floor = min(self.floor, 7)
        elif top == "benchmarks":  # its text, too
            self.folders.add("benchmarks")
        elif _TEXTS.match(path):
            return
        elif top == "test" and path.count("/") > 1 and tree.exists(path) and _HOLDS_TESTS.search(tree.text(path)):
            self.folders.add(path.split("/")[1])
        elif top == "idl":
            self.floor = min(self.floor, 1)
        else:
            module = include_rules.module_of(path) if top in ("include", "src", "brokerless_discovery") else None
            self.floor = min(self.floor, int(include_rules.floor_of(module)) if module else 0)
