"""What the compiler has to say: refusals (file:line: error: reason) and warnings."""

import difflib
import sys


class Report:
    """Says findings at once; a file with a single refusal gets no output at all. `resolve` makes paths of the names
    that the preprocessor gives to included files."""

    def __init__(self, resolve):
        self.refused = False
        self._resolve = resolve
        self._said = set()

    def error(self, place, reason):
        self.refused = True
        self._say(place, "error", reason)

    def warning(self, place, reason):
        self._say(place, "warning", reason)

    def where(self, place):
        return f"{self._resolve(place[0])}:{place[1]}"

    def _say(self, place, kind, reason):
        line = f"{self.where(place)}: {kind}: {reason}"
        if line not in self._said:
            self._said.add(line)
            sys.stderr.write(line + "\n")


def suggestion(name, known):
    near = difflib.get_close_matches(name, known, 1)
    return f" (did you mean '{near[0]}'?)" if near else ""
