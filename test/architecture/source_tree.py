"""The files of a source tree and what they include."""

import os
import re

SOURCES = (".hpp", ".cpp", ".h", ".c")
TEXTS = SOURCES + (".idl", ".py", ".cmake", ".txt", ".md", ".xml", ".json", ".sh", ".in", "")
# What builds and tools leave behind, in any folder.
IGNORED = {".git", "build", "__pycache__", ".cache"}

_INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


class SourceTree:
    """Paths are relative to the root, with slashes."""

    def __init__(self, root):
        self.root = root

    def files(self, endings=TEXTS, below=""):
        for folder, folders, names in os.walk(os.path.join(self.root, below)):
            folders[:] = sorted(f for f in folders if f not in IGNORED and not f.startswith("build-"))
            for name in sorted(set(names) - IGNORED):  # in a further work tree, .git is a file
                if os.path.splitext(name)[1] in endings:
                    yield os.path.relpath(os.path.join(folder, name), self.root)

    def text(self, path):
        with open(os.path.join(self.root, path), encoding="utf-8", errors="replace") as stream:
            return stream.read()

    def exists(self, path):
        return os.path.exists(os.path.join(self.root, path))

    def includes(self, path):
        """(line, included path, whether in quotes) of each #include."""
        text = self.text(path)
        for found in _INCLUDE.finditer(text):
            yield text.count("\n", 0, found.start(2)) + 1, found.group(2), found.group(1) == '"'


def within(path, folders):
    return any(path == folder or path.startswith(folder + "/") for folder in folders)
