#!/usr/bin/env python3
"""release_checks.py ROOT [VERSION]: whether texts, numbers and symbols are those of a release, by CONTRIBUTING.md, "Releases".

The first check that fails ends it, with the cause and the remedy. The clone's tags tell the last release. Changes nothing.
"""

import datetime
import pathlib
import re
import subprocess
import sys

ABI = "include/skein/detail/abi.hpp"
WIRE = "brokerless_discovery/table.hpp"
SYMBOLS = "debian/libskein0.symbols"
DESCRIPTION = "idl/skein/discovery.idl"
# Where texts name the version that a user gets.
NAMING = {"README.md": r"\bVersion (\d+\.\d+\.\d+)", "SHIPPING.md": r"\blocalhost/skein:(\d+\.\d+\.\d+)"}


class Failure(Exception):
    def __init__(self, cause, remedy):
        super().__init__(cause)
        self.remedy = remedy


def parts(version):
    return tuple(map(int, version.split(".")))


def series(version):
    """What may break its users only as a whole: before 1.0 the second number, from then on the first."""
    return parts(version)[:2] if parts(version)[0] == 0 else parts(version)[:1]


class Tree:
    """The files of a commit, or of the working tree."""

    def __init__(self, root, commit=None):
        self.root, self.commit = pathlib.Path(root), commit

    def git(self, *words):
        return subprocess.run(["git", *words], cwd=self.root, check=True, stdout=subprocess.PIPE, text=True).stdout.strip()

    def text(self, path):
        if self.commit:
            return self.git("show", f"{self.commit}:{path}")
        file = self.root / path
        if not file.exists():
            raise Failure(f"there is no {path}", "take it back from the last release, or write it")
        return file.read_text(encoding="utf-8")

    def find(self, path, pattern, what):
        if found := re.search(pattern, self.text(path), re.MULTILINE):
            return found.group(1)
        raise Failure(f"{path} does not give {what}", f"write it there, as this pattern finds it: {pattern}")

    @property
    def version(self):
        return self.find("CMakeLists.txt", r"^project\(skein VERSION (\d+\.\d+\.\d+)\b", "the version")

    @property
    def abi(self):
        return int(self.find(ABI, r"^#define SKEIN_ABI (\d+)$", "the number of the binary interface"))

    @property
    def wire(self):
        return int(self.find(WIRE, r'\bkWire = "(\d+)";', "the number of the wire"))

    @property
    def soversion(self):
        return int(self.find(SYMBOLS, r"^libskein\.so\.(\d+) ", "the libraries' SOVERSION"))

    @property
    def symbols(self):
        """Of all libraries. The pattern at each library's end is none, and the version in which a symbol came does not count."""
        listed = set(re.findall(r"^ (\S.*) \S+$", self.text(SYMBOLS), re.MULTILINE))
        return {re.sub(r"@libskein(\w*)\.so\.\d+", r"@libskein\1", symbol) for symbol in listed if not symbol.startswith("(symver|optional)")}

    @property
    def description(self):
        """The members of the record by which peers of all versions find each other."""
        body = self.find(DESCRIPTION, r"struct ServiceDescription \{([^}]*)\}", "the struct ServiceDescription")
        return [" ".join(line.split("//")[0].split()) for line in body.splitlines() if line.split("//")[0].strip()]

    def released(self):
        """{version: tag} of all releases whose tags are here."""
        return {tag[1:]: tag for tag in self.git("tag", "--list").splitlines() if re.fullmatch(r"v\d+\.\d+\.\d+", tag)}

    def last_release(self):
        """(version, tree) of the newest one that this commit contains."""
        tags = self.git("tag", "--merged", "HEAD").splitlines()
        versions = [version for version, tag in self.released().items() if tag in tags]
        newest = max(versions, key=parts, default=None)
        return newest, newest and Tree(self.root, f"v{newest}")


def clean(tree, _):
    if changed := tree.git("status", "--porcelain"):
        raise Failure("files differ from the last commit:\n" + changed, "commit them, or take them away")
    return "the tree is clean"


def on_main(tree, _):
    names = tree.git("for-each-ref", "--format=%(refname)", "refs/remotes/origin/HEAD", "refs/heads/main").splitlines()
    if not names:
        raise Failure("this clone has neither origin/HEAD nor a branch main", "git remote set-head origin --auto")
    main, head = tree.git("rev-parse", f"{names[-1]}^{{commit}}"), tree.git("rev-parse", "HEAD")
    if main != head:
        raise Failure(f"{head[:12]} is checked out, and {names[-1]} is {main[:12]}", "git fetch, and release the tip of main")
    return f"{head[:12]} is main's tip"


def one_version(tree, version):
    heading = re.search(r"^## (.*)$", tree.text("CHANGELOG.md"), re.MULTILINE)
    said = {
        "CMakeLists.txt": tree.version,
        "CHANGELOG.md": heading.group(1).split()[0].rstrip(",") if heading else "nothing",
        "debian/changelog": tree.find("debian/changelog", r"\A\w+ \(([^)]*)\)", "a version"),
        **{f"{path}, in '{found.group()}'": found.group(1) for path, pattern in NAMING.items() for found in re.finditer(pattern, tree.text(path))},
    }
    for place, other in said.items():
        if other != version:
            raise Failure(f"{version} is to be released, and {place} is of {other}", f"make both the same: {', '.join(said)}")
    return f"all files are of {version}"


def newer(tree, version):
    if version in tree.released():
        raise Failure(f"{version} was released: there is the tag v{version}", "give the release a new version")
    last, _ = tree.last_release()
    if last and parts(version) <= parts(last):
        raise Failure(f"{version} is not newer than {last}, the last release", "give the release a version beyond it")
    return f"newer than {last}, the last release" if last else "the first release: there is no tag v… yet"


def dated(tree, version):
    entry = re.search(rf"^## {re.escape(version)}\b(.*)\n((?:(?!## ).*\n?)*)", tree.text("CHANGELOG.md"), re.MULTILINE)
    heading, body = entry.groups()
    try:
        datetime.date.fromisoformat(heading.strip(" ()"))
    except ValueError:
        raise Failure(f"CHANGELOG.md has '## {version}{heading}', and no day", f"write the day of the release: ## {version} (YYYY-MM-DD)") from None
    if left := re.search(r"\bTODO\b|\bunreleased\b", body, re.IGNORECASE):
        raise Failure(f"CHANGELOG.md says '{left.group()}' of {version}", "finish the section")
    if not re.search(r"^- ", body, re.MULTILINE):
        raise Failure(f"CHANGELOG.md does not say what {version} brings", "list below Added, Changed, Fixed, Removed what users notice")
    for name, number in (("Wire", tree.wire), ("ABI", tree.abi), ("SOVERSION", tree.soversion)):
        told = re.search(rf"\*{name}\*: (\d+)", body)
        if not told or int(told.group(1)) != number:
            raise Failure(f"CHANGELOG.md says {told.group(1) if told else 'nothing'} of {version}'s {name}, which is {number}",
                          f"write *{name}*: {number} there")  # fmt: skip
    distribution = tree.find("debian/changelog", r"\A\w+ \([^)]*\) (\S+);", "a distribution")
    if distribution == "UNRELEASED":
        raise Failure("debian/changelog says UNRELEASED", "dch --release")
    return "CHANGELOG.md and debian/changelog say what it is"


def library_numbers(tree, version):
    if (major := parts(version)[0]) != tree.soversion:
        raise Failure(f"the libraries' SOVERSION is {major}, and {SYMBOLS} is of {tree.soversion}",
                      f"name the packages libskein{major} and libskein-mission{major}, their files in debian/, too, and list the symbols anew")  # fmt: skip
    listed = {int(number) for number in re.findall(r"\bskein-abi-(\d+)$", tree.text(SYMBOLS), re.MULTILINE)}
    if listed != {tree.abi}:
        raise Failure(f"SKEIN_ABI is {tree.abi}, and {SYMBOLS} is of {', '.join(map(str, sorted(listed))) or 'none'}",
                      "make it anew: debian/list-symbols says how")  # fmt: skip
    return f"SOVERSION {tree.soversion}, SKEIN_ABI {tree.abi}, wire {tree.wire}"


def kept_promises(tree, version):
    last, old = tree.last_release()
    if not last:
        return "nothing was promised before"
    for name, number, before in (("SKEIN_ABI", tree.abi, old.abi), ("the wire's number", tree.wire, old.wire)):
        if number < before:
            raise Failure(f"{name} is {number}, and was {before} in {last}", "numbers only grow: give it the next free one")
    gone = sorted(old.symbols - tree.symbols)
    if gone and tree.abi == old.abi:
        raise Failure(f"{len(gone)} symbols of {last} are gone, and SKEIN_ABI is still {tree.abi}; the first: {gone[0]}",
                      f"bring them back, or count SKEIN_ABI up in {ABI} and make {SYMBOLS} anew")  # fmt: skip
    known = old.description
    if tree.description[: len(known)] != known:
        raise Failure(f"the members that ServiceDescription had in {last} are not its first ones", f"append to it alone, in {DESCRIPTION}:"
                      " by it peers of all versions tell each other the number of their wire")  # fmt: skip
    broken = [name for name, grown in (("SKEIN_ABI", tree.abi > old.abi), ("the wire's number", tree.wire > old.wire)) if grown]
    if broken and series(version) == series(last):
        first, second, *_ = parts(last)
        raise Failure(f"{' and '.join(broken)} grew since {last}, and {version} looks as if nothing broke",
                      f"give the release the version {f'0.{second + 1}.0' if first == 0 else f'{first + 1}.0.0'}")  # fmt: skip
    return f"{' and '.join(broken)} grew since {last}, as {version} may" if broken else f"what {last} promised is kept"


CHECKS = (clean, on_main, one_version, newer, dated, library_numbers, kept_promises)


def main(root, version=None):
    tree = Tree(root)
    try:
        version = version or tree.version
        if not re.fullmatch(r"\d+\.\d+\.\d+", version):
            raise Failure(f"'{version}' is no version", "write three numbers, as 0.2.0")
        for check in CHECKS:
            print("ok: " + check(tree, version), flush=True)
    except Failure as failure:
        sys.exit(f"failed: {failure}\nremedy: {failure.remedy}")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(*sys.argv[1:])
