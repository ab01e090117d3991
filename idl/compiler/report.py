"""What the compiler has to say: each finding with its place, the line itself, and a mark below it."""

import difflib
import sys
from dataclasses import dataclass


@dataclass(frozen=True)
class Place:
    file: str
    line: int  # from 1
    column: int = 0  # from 1, in characters of the file's own line; 0: the whole line

    def __str__(self):
        return f"{self.file}:{self.line}"


class Report:
    """Writes findings as they come, each once, and counts the errors."""

    def __init__(self):
        self.errors = 0
        self.source = None  # shows the lines, once it is there
        self._said = set()

    def error(self, place, reason):
        if self._say(place, "error", reason):
            self.errors += 1

    def warning(self, place, reason):
        self._say(place, "warning", reason)

    def _say(self, place, kind, reason):
        """Whether it is new."""
        if (place, kind, reason) in self._said:
            return False
        self._said.add((place, kind, reason))
        column = f":{place.column}" if place.column else ""
        said = f"{place}{column}: {kind}: {reason}\n"
        line = self.source.line(place) if self.source else ""
        if place.column and line:
            # Tabs stay tabs, so that the mark stands below its character.
            indent = "".join("\t" if character == "\t" else " " for character in line[: place.column - 1])
            said += f"{line}\n{indent}^\n"
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


def suggestion(name, known):
    near = difflib.get_close_matches(name, known, 1)
    return f" (did you mean '{near[0]}'?)" if near else ""
