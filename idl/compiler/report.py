"""What the compiler has to say: each finding with its place, the line itself, and a mark below it."""

import difflib
import re
import sys
from dataclasses import dataclass


@dataclass(frozen=True)
class Place:
    file: str
    line: int  # from 1
    column: int = 0  # from 1, in characters of the file's own line; 0: the whole line

    def __str__(self):
        return f"{self.file}:{self.line}"


_MOST_ERRORS = 500
_LONGEST_LINE = 400  # characters of a line that are shown
# As src/core/printable.cpp has them: controls without the tab, what turns the direction of writing, ends of lines, bytes that are no UTF-8.
_UNSHOWN = re.compile("[\x00-\x08\x0a-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")


def printable(text):
    """Text of a file, or a file's name, as it may be written to a terminal."""
    return _UNSHOWN.sub(lambda found: "".join(f"\\x{byte:02x}" for byte in found[0].encode("utf-8", "surrogateescape")), text)


class TooManyErrors(Exception):
    pass


class Report:
    """Writes findings as they come, each once, and counts the errors."""

    def __init__(self):
        self.errors = 0
        self.source = None  # shows the lines, once it is there
        self._said = set()

    def error(self, place, reason):
        if self._say(place, "error", reason):
            self.errors += 1
            if self.errors == _MOST_ERRORS:
                self._say(place, "error", f"these were {_MOST_ERRORS} errors; what follows was not looked at")
                raise TooManyErrors

    def warning(self, place, reason):
        self._say(place, "warning", reason)

    def _say(self, place, kind, reason):
        """Whether it is new."""
        if (place, kind, reason) in self._said:
            return False
        self._said.add((place, kind, reason))
        column = f":{place.column}" if place.column else ""
        said = printable(f"{place}{column}: {kind}: {reason}") + "\n"
        line = self.source.line(place) if self.source else ""
        if place.column and line:
            begin = max(0, place.column - _LONGEST_LINE // 2) if len(line) > _LONGEST_LINE else 0
            # Tabs stay tabs, so that the mark stands below its character.
            indent = "".join("\t" if character == "\t" else " " for character in printable(line[begin : place.column - 1]))
            said += f"{printable(line[begin : begin + _LONGEST_LINE])}\n{indent}^\n"
        sys.stderr.write(said)
        return True


# Types of other languages that people write, and what IDL has for them.
_FOREIGN = {
    "int": "'long' or 'int32'",
    "uint": "'unsigned long' or 'uint32'",
    "unsigned": "'unsigned long' or 'uint32'",
    "bool": "'boolean'",
    "byte": "'octet'",
    "float32": "'float'",
    "float64": "'double'",
    "vector": "'sequence<TYPE>'",
    "list": "'sequence<TYPE>'",
    "wchar_t": "'wchar'",
    "u16string": "'wstring'",
}
_FOREIGN |= {f"{sign}int{bits}_t": f"'{sign}int{bits}'" for sign in ("", "u") for bits in (8, 16, 32, 64)}


def native(name):
    """What to write in place of a type of another language; empty for other names."""
    return _FOREIGN.get(str(name), "")


_MOST_COMPARED = 1000


def nearest(name, known):
    """The name that was probably meant; empty without one."""
    return next(iter(difflib.get_close_matches(name, list(known)[:_MOST_COMPARED], 1)), "") if len(name) <= 256 else ""


def suggestion(name, known):
    near = nearest(name, known)
    return f" (did you mean '{near}'?)" if near else ""
