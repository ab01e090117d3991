"""additions.py count | try KIND [--build FOLDER]

What it takes to add something: addition_kinds/KIND.py holds the edits that add a dummy, each of which is one place. `count` prints how many
places each kind touches; the exit code is 1 if one touches more than its MOST, or if an edit does not fit the tree. `try` edits a copy of the
files, which it makes in the folder of the build, builds the kind's TARGETS there, and runs its TESTS.
"""

import argparse
import dataclasses
import glob
import os
import runpy
import shutil
import signal
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
KINDS = os.path.join(HERE, "addition_kinds", "*.py")


@dataclasses.dataclass(frozen=True)
class Edit:
    """Inserts `text` after, or before, what stands once in the file."""

    path: str
    text: str
    after: str = ""
    before: str = ""

    def applied_to(self, old):
        anchor = self.after or self.before
        if (found := (old or "").count(anchor)) != 1:
            raise ValueError(f"{self.path}: has {found} times: {anchor!r}")
        return old.replace(anchor, anchor + self.text if self.after else self.text + anchor)


@dataclasses.dataclass(frozen=True)
class NewFile:
    path: str
    text: str

    def applied_to(self, old):
        if old is not None:
            raise ValueError(f"{self.path}: exists already")
        return self.text


def edited(root, edits):
    """The texts of the files that the edits touch, by path. Raises ValueError for an edit that does not fit."""
    texts = {}
    for edit in edits:
        whole = os.path.join(root, edit.path)
        if edit.path not in texts and os.path.exists(whole):
            with open(whole, encoding="utf-8") as stream:
                texts[edit.path] = stream.read()
        texts[edit.path] = edit.applied_to(texts.get(edit.path))
    return texts


def count(root, kinds):
    """A kind that touches more places than it may, or an edit that does not fit. Prints the places of each kind."""
    if not kinds:
        yield f"{KINDS}: there are none"
    for name, kind in kinds.items():
        print(f"{name}: {len(kind['EDITS'])} places")
        if len(kind["EDITS"]) > kind["MOST"]:
            yield f"{name}: {len(kind['EDITS'])} places, and {kind['MOST']} are allowed"
        try:
            edited(root, kind["EDITS"])
        except ValueError as error:
            yield f"{name}: {error}"


def attempt(root, paths, build, name, kind):
    """Tries a kind in a copy of the files `paths`. Returns the exit code of the first command that fails, or 0."""
    copy = os.path.join(build, "addition_of_" + name)
    shutil.rmtree(copy, ignore_errors=True)  # of a run that was killed
    try:
        texts = edited(root, kind["EDITS"])
        for path in (*paths, *texts):
            os.makedirs(os.path.dirname(os.path.join(copy, path)), exist_ok=True)
        for path in paths:
            shutil.copy2(os.path.join(root, path), os.path.join(copy, path))
        for path, text in texts.items():
            with open(os.path.join(copy, path), "w", encoding="utf-8") as stream:
                stream.write(text)
        for command in (["cmake", "--preset", "default"], ["cmake", "--build", "build", "--target", *kind["TARGETS"]],
                        ["ctest", "--test-dir", "build", "--no-tests=error", "--output-on-failure", "-R", kind["TESTS"]]):
            if code := subprocess.run(command, cwd=copy).returncode:
                return code
        return 0
    finally:
        shutil.rmtree(copy, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command", choices=("count", "try"))
    parser.add_argument("kind", nargs="?")
    parser.add_argument("--build", default=os.path.join(ROOT, "build"))
    arguments = parser.parse_args()
    kinds = {os.path.basename(path)[:-len(".py")]: runpy.run_path(path) for path in sorted(glob.glob(KINDS))}
    if arguments.command == "count":
        violations = list(count(ROOT, kinds))
        for violation in violations:
            print(violation)
        return 1 if violations else 0
    if arguments.kind not in kinds:
        parser.error(f"there is no kind '{arguments.kind}'; known are {', '.join(kinds)}")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that the copy goes
    files = subprocess.run(["git", "ls-files", "-z", "-co", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return attempt(ROOT, files.rstrip("\0").split("\0"), arguments.build, arguments.kind, kinds[arguments.kind])


if __name__ == "__main__":
    sys.exit(main())
