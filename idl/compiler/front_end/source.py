"""An IDL file after the preprocessor: one text, of which each position is known by file, line and column."""

import bisect
import os
import re
import resource
import subprocess
import tempfile
from dataclasses import dataclass

from report import Place, suggestion

_MARKER = re.compile(r'# (\d+) "((?:[^"\\]|\\.)*)"((?: \d)*)$')
_PRAGMA = re.compile(r"\s*#\s*pragma\b(.*)$")
_COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?(?:\*/|\Z)|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
# How the preprocessor writes letters beyond ASCII in names; behind `_COMMENT_OR_TEXT`, where it leaves them.
_LETTER = re.compile(_COMMENT_OR_TEXT.pattern + r"|\\U([0-9a-fA-F]{8})", re.DOTALL)
_INCLUDE = re.compile(r'\s*#\s*include\s*["<]([^">]*)[">]')
_DIRECTIVES = "include define undef if ifdef ifndef elif else endif pragma error".split()
_FINDING = re.compile(r"(.+?):(\d+):(?:(\d+):)? (?:fatal )?error: (.*)$")
_ENTER, _LEAVE = " 1", " 2"
LARGEST = 2 << 20  # bytes of a file with all that it includes; the largest known to us have some 500,000
_MOST_MEMORY = 1 << 30  # bytes for the preprocessor, which reads whole files


@dataclass(frozen=True)
class Comment:
    text: str
    first: Place
    last: Place
    begin: int  # offsets in the source's text
    end: int
    behind: bool  # something else stands before it on its line


@dataclass(frozen=True)
class Pragma:
    text: str  # behind `#pragma`
    place: Place
    offset: int


class Source:
    """`text` has blanks where comments, pragmas and the preprocessor's marks stood. What the preprocessor says is reported, and the
    text is what it made before it gave up."""

    def __init__(self, path, folders, definitions, report):
        command = ["cpp", "-x", "c", "-C", "-undef", "-nostdinc", "-w", "-fdiagnostics-plain-output", "-D__SKEIN_IDL__"]
        command += ["-I" + folder for folder in folders] + ["-D" + definition for definition in definitions]
        report.source = self
        self.path = path
        done = _preprocessed([*command, path])
        self.files = [path]  # each that was read, as the preprocessor names it
        self.direct = []  # what the main file includes: as written, as the preprocessor names it, place of the directive, offset
        self.included = {}  # file: what it includes, directly or not
        self.comments = []
        self.pragmas = []
        self._lines = {}  # file: its lines
        self._solid = {}  # file and line: where its characters stand that are no blanks
        self._solid_text = {}  # the same of a line of the text
        self._places = []  # of each line of the text: file, line
        self._around = [path]
        self._entered = 0  # the line of the text where the file begins that the main file includes
        if len(done.stdout) > LARGEST:
            report.error(Place(path, 1), f"with what it includes this file has more than {LARGEST >> 20} MiB; divide it into files that include each other")
            done.stdout = b""
        self.text = self._without_comments(_with_letters("\n".join(map(self._read, map(_decoded, done.stdout.split(b"\n"))))))
        self._starts = _line_starts(self.text)
        self.direct = [(*included, self._starts[index]) for *included, index in self.direct]
        self.pragmas = [Pragma(text, Place(*self._places[index]), self._starts[index]) for index, text in self.pragmas]
        said = done.stderr.decode(errors="replace").splitlines()
        for line in said:
            if found := _FINDING.match(line):
                self._report(found, report)
        if done.returncode != 0 and report.errors == 0:
            report.error(Place(path, 1), f"the preprocessor gave up: {said[-1] if said else f'it ended with {done.returncode}'}")

    def place(self, offset):
        index = bisect.bisect_right(self._starts, offset) - 1
        end = self._starts[index + 1] - 1 if index + 1 < len(self._starts) else len(self.text)
        file, number = self._places[index]
        return Place(file, number, self._column(file, number, self._solid_before(index, offset), self.text[offset : min(end, offset + 200)]))

    def _solid_before(self, index, offset):
        """How many characters that are no blanks stand before an offset on its line of the text."""
        if index not in self._solid_text:
            end = self._starts[index + 1] if index + 1 < len(self._starts) else len(self.text)
            self._solid_text[index] = _solid(self.text[self._starts[index] : end])
        return bisect.bisect_left(self._solid_text[index], offset - self._starts[index])

    def line(self, place):
        """A line of a file as it stands there."""
        if place.file not in self._lines:
            try:
                with open(place.file, "rb") as stream:
                    self._lines[place.file] = [_decoded(line.rstrip(b"\r")) for line in stream.read(LARGEST).split(b"\n")]
            except OSError:
                self._lines[place.file] = []
        lines = self._lines[place.file]
        return lines[place.line - 1] if 0 < place.line <= len(lines) else ""

    def _read(self, line):
        """A line without what the preprocessor wrote for us; notes where it is from."""
        if found := _MARKER.match(line):
            file = re.sub(r"\\(.)", r"\1", found[2])
            self._enter(file, int(found[1]), found[3])
            self._places.append((file, int(found[1]) - 1))
            return ""
        file, number = self._places[-1] if self._places else (self.path, 0)
        self._places.append((file, number + 1))
        if found := _PRAGMA.match(line):
            self.pragmas.append((len(self._places) - 1, found[1].strip()))
            return ""
        return line

    def _enter(self, file, number, flags):
        if flags.startswith(_ENTER):
            if file not in self.files:
                self.files.append(file)
            for outer in self._around:
                self.included.setdefault(outer, set()).add(file)
            if len(self._around) == 1:
                self._entered = len(self._places)
            self._around.append(file)
        elif flags.startswith(_LEAVE) and len(self._around) > 1:
            left = self._around.pop()
            if len(self._around) == 1 and all(left != path for _, path, _, _ in self.direct):
                place = Place(self.path, number - 1)
                written = _INCLUDE.match(self.line(place))
                self.direct.append((written[1] if written else os.path.basename(left), left, place, self._entered))

    def _without_comments(self, text):
        starts = _line_starts(text)

        def where(offset):
            return Place(*self._places[bisect.bisect_right(starts, offset) - 1])

        looked = 0  # up to there, something else than comments was looked for
        last_line = -1  # where that last stood

        def blank(match):
            nonlocal looked, last_line
            begin, end = match.span()
            line = starts[bisect.bisect_right(starts, begin) - 1]
            if match[0][0] in "\"'" or text[max(looked, line) : begin].strip():
                last_line = line
            looked = end
            if match[0][0] in "\"'":
                return match[0]
            self.comments.append(Comment(match[0], where(begin), where(end - 1), begin, end, behind=last_line == line))
            return re.sub(r"[^\n]", " ", match[0])

        return _COMMENT_OR_TEXT.sub(blank, text)

    def _column(self, file, number, count, behind):
        """The preprocessor draws blanks together; characters that are none stand in the same order, unless a macro was there. `count` of
        them stand before."""
        written = self.line(Place(file, number))
        if (file, number) not in self._solid:
            self._solid[file, number] = _solid(written)
        solid = self._solid[file, number]
        rest = re.sub(r"\s", "", behind)[:8]
        if count < len(solid) and "".join(written[index] for index in solid[count : count + 8]).startswith(rest):
            return solid[count] + 1
        return 0

    def _report(self, found, report):
        reason = found[4]
        missing = re.match(r"(?P<name>.*): No such file or directory$|no include path in which to search for (?P<angled>.*)$", reason)
        if missing:
            name = missing["name"] or missing["angled"]
            reason = f"there is no file '{name}' here or in the folders given by -I; add the folder that holds it"
        elif wrong := re.match(r"invalid preprocessing directive #(\w*)$", reason):
            reason = f"there is no directive '#{wrong[1]}'{suggestion(wrong[1], _DIRECTIVES)}; a comment begins with '//' in IDL"
        elif opened := re.match(r"unterminated (#\w+)$", reason):
            reason = f"this {opened[1]} does not end; add the #endif"
        report.error(Place(os.path.normpath(found[1]), int(found[2]), int(found[3] or 0)), reason)


def _preprocessed(command):
    """What the preprocessor wrote, and no more than what is read of it: a few macros or a device may make it endless."""
    try:
        with tempfile.TemporaryFile() as said, subprocess.Popen(command, stdout=subprocess.PIPE, stderr=said, preexec_fn=_limit_memory) as running:
            text = running.stdout.read(LARGEST + 1)
            if len(text) > LARGEST:
                running.kill()
            code = running.wait()
            said.seek(0)
            return subprocess.CompletedProcess(command, code if len(text) <= LARGEST else 0, text, said.read(LARGEST))
    except FileNotFoundError:
        return subprocess.CompletedProcess(command, 127, b"", b"there is no program 'cpp' in PATH; install it (Debian's package cpp)")


def _limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (_MOST_MEMORY, _MOST_MEMORY))


def _with_letters(text):
    return _LETTER.sub(lambda found: chr(int(found[1], 16)) if found[1] else found[0], text) if "\\U" in text else text


def _solid(line):
    """Where the characters stand that are no blanks."""
    return [index for index, character in enumerate(line) if not character.isspace()]


def _line_starts(text):
    return [0] + [match.end() for match in re.finditer("\n", text)]


def _decoded(line):
    """IDL is UTF-8 by convention; older files have comments in Latin-1."""
    try:
        return line.decode("utf-8-sig")
    except UnicodeDecodeError:
        return line.decode("latin-1")
