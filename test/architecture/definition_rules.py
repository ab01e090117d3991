"""What debug information tells of the types in several binaries together."""

import collections
import os
import re
import subprocess

_TYPE = re.compile(r"^(\d+):\s+(?!typedef )(?:(?:class|struct|union|enum) )?(.+);$")


def one_definition(libraries, build_folder):
    """A type's name that two places define: the linker and the loader keep one destructor for both.

    `libraries`: binaries with debug information; `build_folder`: what its relative paths are relative to.
    """
    places = collections.defaultdict(set)
    for library in libraries:
        for name, file, line in _types(library):
            path = os.path.realpath(os.path.join(build_folder, file))
            if "(anonymous namespace)" not in name and not _only_declares(path, line):
                places[name].add(f"{path}:{line}")
    if not places:
        yield "no debug information: nothing could be looked at"
    for name, found in sorted(places.items()):
        if len(found) > 1:
            yield f"{name} is defined in {' and in '.join(sorted(found))}: rename one, or give it a namespace of its own"


def _types(library):
    """(name, file, line) of each type of Skein's in the debug information."""
    ran = subprocess.run(["gdb", "--batch", "--nx", "-ex", "set language c++", "-ex", "info types ^skein::", library],
                         text=True, capture_output=True, check=True)
    file = ""
    for row in ran.stdout.splitlines():
        if row.startswith("File "):
            file = row.removeprefix("File ").removesuffix(":")
        elif found := _TYPE.match(row):
            yield found.group(2), file, int(found.group(1))


def _only_declares(path, line):
    """Whether an enumeration is declared there without its enumerators, which debug information tells as a definition."""
    try:
        with open(path, encoding="utf-8") as stream:
            text = stream.readlines()[line - 1]
    except (OSError, IndexError):
        return False
    return re.match(r"\s*enum\b[^{]*;", text) is not None
