"""What an IDL file includes, directly and indirectly."""

import os
import re
import subprocess

from omniidl import main

_MARKER = re.compile(r'^# \d+ "([^"]+)"(?: (\d))?$', re.MULTILINE)
_ENTER, _LEAVE = "1", "2"


class Includes:
    """The files below `path`. The preprocessor gives their names as they are written, not where it found them."""

    def __init__(self, path):
        self.found = {path: os.path.abspath(path)}  # name as written: path
        self.direct = []  # names as written
        flags = [flag[:2] + flag[2:].strip().strip('"') for flag in main.preprocessor_args if flag[:2] in ("-I", "-D", "-U")]
        self._folders = [os.path.dirname(os.path.abspath(path))]
        self._folders += [os.path.abspath(flag[2:]) for flag in flags if flag.startswith("-I")]
        done = subprocess.run(["omniidl", "-E", *flags, path], stdout=subprocess.PIPE, check=True)
        self._read(path, done.stdout.decode("latin-1"))

    def _read(self, path, text):
        around = [path]
        for name, flag in _MARKER.findall(text):
            if flag == _ENTER:
                if len(around) == 1 and name not in self.direct:
                    self.direct.append(name)
                self.found.setdefault(name, self._find(name, self.found[around[-1]]))
                around.append(name)
            elif flag == _LEAVE:
                around.pop()

    def _find(self, name, includer):
        paths = [os.path.join(folder, name) for folder in [os.path.dirname(includer), *self._folders]]
        return next((path for path in paths if os.path.isfile(path)), name)

    def resolve(self, name):
        """The path of a file that the preprocessor calls `name`."""
        return name if os.path.isabs(name) else self.found.get(name, name)

    def write_depfile(self, depfile, outputs):
        """Sources and this compiler itself: a change of either makes the outputs anew."""
        here = os.path.dirname(os.path.abspath(__file__))
        compiler = sorted(os.path.join(here, name) for name in os.listdir(here) if name.endswith(".py"))
        inputs = sorted(set(self.found.values())) + compiler
        targets = " ".join(_escaped(os.path.abspath(name)) for name in outputs)
        with open(depfile, "w", encoding="utf-8") as stream:
            stream.write(targets + ":" + "".join(f" \\\n  {_escaped(name)}" for name in inputs) + "\n")


def _escaped(name):
    return name.replace("$", "$$").replace(" ", "\\ ").replace("#", "\\#")
