"""What two sources define under one name."""

import collections
import os
import pathlib
import re
import subprocess

_TYPE = re.compile(r"^(\d+):\s+(?!typedef )(?:(?:class|struct|union|enum) )?(.+);$")


def one_definition(libraries, build_folder, root=""):
    """A type's name that two places define: the linker and the loader keep one destructor for both.

    `libraries`: binaries with debug information; `build_folder`: what its relative paths are relative to; `root`: the
    tree, of which the compiler's cache may hold objects that were made in another clone.
    """
    places = collections.defaultdict(set)
    for library in libraries:
        for name, file, line in _types(library):
            path = _in_tree(os.path.realpath(os.path.join(build_folder, file)), root)
            if "(anonymous namespace)" not in name and not _only_declares(path, line):
                places[name].add(f"{path}:{line}")
    if not places:
        yield "no debug information: nothing could be looked at"
    for name, found in sorted(places.items()):
        if len(found) > 1:
            yield f"{name} is defined in {' and in '.join(sorted(found))}: rename one, or give it a namespace of its own"


def _in_tree(path, root):
    """The file of `root` with the same path below it as `path` has below some clone's."""
    parts = path.split("/")
    for first in range(1, len(parts)) if root else ():
        if os.path.exists(here := os.path.join(root, *parts[first:])):
            return here
    return path


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


_NAMESPACE = re.compile(r"namespace(?: ([\w:]+))? \{$|\}  // namespace")
_FUNCTION = re.compile(r"(?!return\b|using\b)[A-Za-z_][\w:<>,&*\[\] ]*[ &*>](\w+)\(")


def unity_names(build):
    """A function in the unnamed namespaces of two sources that are compiled as one: a call in one may take the other's."""
    for unity in sorted(pathlib.Path(build).glob("**/Unity")):
        places = collections.defaultdict(set)
        for source in _included(unity):
            for name in _unnamed_functions(source):
                places[name].add(source.name)
        for name, sources in places.items():
            if len(sources) > 1:
                yield f"{unity.parent.stem}: {name}() stands in the unnamed namespaces of {' and '.join(sorted(sources))}; rename one"


def _included(unity):
    for part in unity.glob("unity_*.cxx"):
        for path in map(pathlib.Path, re.findall(r'#include "(.+)"', part.read_text(encoding="utf-8"))):
            if path.exists():  # of what is generated, too
                yield path


def _unnamed_functions(source):
    """The qualified names; of namespaces and functions that begin a line, as clang-format writes them."""
    inside = []
    for line in source.read_text(encoding="utf-8").splitlines():
        if found := _NAMESPACE.match(line):
            inside.append(found.group(1) or "") if line.endswith("{") else inside.pop()
        elif "" in inside and (found := _FUNCTION.match(line)):
            yield "::".join([*filter(None, inside), found.group(1)])
