"""What an IDL file includes."""

import os
import re
import subprocess

from omniidl import main

_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<]([^">]+)[">]', re.MULTILINE)
_MARKER = re.compile(r'^# \d+ "([^"<]+)"', re.MULTILINE)


def direct_includes(path):
    """The names in a file's own #include lines, as written."""
    with open(path, encoding="latin-1") as stream:
        return list(dict.fromkeys(_INCLUDE.findall(stream.read())))


def all_files(path):
    """The file and all that it includes, as the preprocessor finds them."""
    flags = [flag.replace('"', "") for flag in main.preprocessor_args]
    includes = [part for flag in flags for part in flag.split(None, 1) if flag.startswith(("-I", "-D", "-U"))]
    joined = ["".join(pair) for pair in zip(includes[::2], includes[1::2])]
    text = subprocess.run(["omniidl", "-E", *joined, path], stdout=subprocess.PIPE, check=True).stdout
    found = _MARKER.findall(text.decode("latin-1"))
    return sorted({os.path.abspath(name) for name in [path, *found] if os.path.exists(name)})


def write_depfile(depfile, outputs, path):
    """Sources and this compiler itself: a change of either makes the outputs anew."""
    here = os.path.dirname(os.path.abspath(__file__))
    compiler = sorted(os.path.join(here, name) for name in os.listdir(here) if name.endswith(".py"))
    targets = " ".join(_escaped(os.path.abspath(name)) for name in outputs)
    with open(depfile, "w", encoding="utf-8") as stream:
        stream.write(targets + ":" + "".join(f" \\\n  {_escaped(name)}" for name in all_files(path) + compiler) + "\n")


def _escaped(name):
    return name.replace("$", "$$").replace(" ", "\\ ").replace("#", "\\#")
