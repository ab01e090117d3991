"""What no file of the project says, what README and the guide quote, and where texts point."""

import os
import re

from source_tree import SOURCES, within

_MACHINE_PATH = re.compile(r"""(?:^|[\s"'=(,:<>`])(/(?:work|home|root|Users)/[\w.]|[A-Z]:\\\\?\w)""")
_SLEEP = re.compile(r"\b(sleep_for|sleep_until|usleep|nanosleep|time\.sleep)\b|\bsleep\s*\(|^\s*sleep\s+[\d$]", re.MULTILINE)

# The only tests that sleep, and why.
SLEEPERS = {
    "test/tools/eventually.hpp": "looks again at a condition",
    "test/languages/mission/flight.py": "looks again at a condition",
    "test/languages/python/tools.py": "looks again at a condition",
    "test/languages/table/peer.py": "looks again at a condition, and takes its time",
    "test/languages/table/table_peer_c.c": "looks again at a condition, and takes its time",
    "test/tools/stopped.hpp": "how long a process is stopped",
    "test/mission/supervise/shell_mission.hpp": "looks again at a condition",
    "test/connector/echo_service.cpp": "an operation that takes its time until it is cancelled",
    "test/dds/fastdds/fastdds_forgetting_test.cpp": "the age of what is requested: Fast DDS sends nothing again that it has just sent",
    "test/dds/conformance/suite_lifetime.cpp": "the pace of a writer that never rests",
    "test/faults/load/churn.hpp": "how long participants and endpoints live, which is what the churn varies",
    "test/faults/deaths/death_test.cpp": "an operation that takes its time until it is let go",
    "test/navigation/components/planner_process.cpp": "a planner that is slower than it declares",
    "test/faults/deaths/first_call_test.cpp": "the offset between two starts, which is what the test varies",
    "test/faults/processes.hpp": "how long a fault lasts, which is what the tests vary",
    "test/faults/matrix/tally_client.cpp": "the pace of a client that never rests",
    "test/faults/matrix/tally_peer.cpp": "an operation that takes its time",
}

# Which code of a text must stand, as it is, in files of which folders.
QUOTING = {
    "README.md": (("cpp", "idl", "python"), ("examples",)),
    "GUIDE.md": (("cpp", "idl", "xml"), ("examples", "test/guide")),
    "TROUBLESHOOTING.md": (("cpp", "idl", "xml"), ("examples", "test/guide")),
    # Each shows its main class in use.
    **{
        f"include/skein/{name}.hpp": (("cpp",), ("examples", "test/guide"))
        for name in ("call", "component_registry", "entity", "head", "loaned", "stream", "task", "topics")
    },
}


_FENCED = re.compile(r"^ *```.*?^ *```$", re.MULTILINE | re.DOTALL)
_CODE = re.compile(r"`[^`\n]*`")
_LINK = re.compile(r"\]\(([^()\s]+)\)")
# Profiles that are as they should be, which those of tests need not be.
PROFILES = ("examples", "mission_profiles", "test/guide")
_NAMED_FILE = re.compile(r'="([^"$]+\.xml)"')
_TEST_CASE = re.compile(r'\bTEST_CASE(?:_METHOD)?\s*\(\s*(?:\w+\s*,\s*)?((?:"[^"]*"\s*)+)')
WORKAROUNDS = "src/dds/WORKAROUNDS.md"
# The columns of its tables.
_COLUMNS = ["symptom", "version", "upstream", "what we do", "test", "remove when"]


def machine_paths(tree):
    """A path that exists on one machine alone."""
    for path in tree.files():
        if within(path, ["test/architecture"]):
            continue
        for number, line in enumerate(tree.text(path).splitlines(), 1):
            if found := _MACHINE_PATH.search(line):
                yield f"{path}:{number}: names a path of one machine: {found.group(1)}…"


def sleeps(tree):
    """A test that waits for time instead of a condition, or an exception that is none any more."""
    asleep = set()
    for path in tree.files((*SOURCES, ".py", ".sh", ""), "test"):
        if within(path, ["test/architecture"]):
            continue
        text = tree.text(path)
        for found in _SLEEP.finditer(text):
            asleep.add(path)
            if path not in SLEEPERS:
                line = text.count("\n", 0, found.start()) + 1
                yield f"{path}:{line}: sleeps; wait for a condition with eventually()"
    for path in SLEEPERS:
        if path not in asleep and tree.exists(path):
            yield f"{path} does not sleep any more; take it off SLEEPERS"


def quotes(tree):
    """Code that a text quotes and that no file which it may quote holds, line by line; common indentation does not count."""
    for path, (_, folders) in QUOTING.items():
        sources = [
            tree.text(source).splitlines() for folder in folders for source in tree.files((*SOURCES, ".idl", ".py", ".xml"), folder)
        ]
        quoted = _quoted_by(tree, path)
        if path.endswith(".hpp") and tree.exists(path) and not quoted:
            yield f"{path}: quotes no code"
        for language, code in quoted:
            lines = _without_margin(code.strip("\n").splitlines())
            if not any(_holds(source, lines) for source in sources):
                first = lines[0] if lines else "nothing"
                places = " or ".join(folder + "/" for folder in folders)
                yield f"{path}: its {language} code that begins with '{first}' is in no file of {places}"


def quoted_code(tree):
    """(text, language, code) of each block of code that files must hold."""
    return [(path, *block) for path in QUOTING for block in _quoted_by(tree, path)]


def _quoted_by(tree, path):
    if not tree.exists(path):
        return []
    languages = "|".join(QUOTING[path][0])
    text = tree.text(path)
    if path.endswith(".hpp"):
        text = re.sub(r"^ */// ?", "", text, flags=re.MULTILINE)
    return re.findall(rf"^```({languages})\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def _holds(source, lines):
    """Whether `lines`, which have no margin, stand in `source` one after the other."""
    if not lines:
        return False
    for at in range(len(source) - len(lines) + 1):
        if source[at].strip() == lines[0].strip() and _without_margin(source[at : at + len(lines)]) == lines:
            return True
    return False


def _without_margin(lines):
    """The lines without the blanks that they begin with in common, and without those at their ends."""
    margin = min((len(line) - len(line.lstrip(" ")) for line in lines if line.strip()), default=0)
    return [line[margin:].rstrip() for line in lines]


def named_files(tree):
    """A file that a profile names and that is not there."""
    for path in tree.files((".xml",)):
        if not within(path, PROFILES):
            continue
        for found in _NAMED_FILE.finditer(tree.text(path)):
            named = os.path.normpath(os.path.join(os.path.dirname(path), found.group(1)))
            if not tree.exists(named):
                line = tree.text(path).count("\n", 0, found.start()) + 1
                yield f"{path}:{line}: names {found.group(1)}, which does not exist"


def links(tree):
    """A link of a text to a file, a folder or a heading that is not there."""
    yield from named_files(tree)
    for path in tree.files((".md",)):
        text = _prose(tree.text(path))
        for found in _LINK.finditer(text):
            target, _, heading = found.group(1).partition("#")
            if re.match(r"[a-z]+:", target):
                continue
            line = text.count("\n", 0, found.start()) + 1
            there = os.path.normpath(os.path.join(os.path.dirname(path), target)) if target else path
            if not tree.exists(there):
                yield f"{path}:{line}: points to {target}, which does not exist"
            elif heading and there.endswith(".md") and heading not in _anchors(tree.text(there)):
                yield f"{path}:{line}: points to {target}#{heading}, but {there} has no such heading"


def workarounds(tree):
    """A row about a vendor that lacks something, or that names a test case which its file does not have."""
    if not tree.exists(WORKAROUNDS):
        return
    for line, cells in _rows(tree.text(WORKAROUNDS)):
        if cells[: len(_COLUMNS)] == _COLUMNS or set("".join(cells)) <= set("-: "):
            continue
        where = f"{WORKAROUNDS}:{line}"
        if len(cells) != len(_COLUMNS):
            yield f"{where}: has {len(cells)} columns; they are {', '.join(_COLUMNS)}"
            continue
        row = dict(zip(_COLUMNS, cells))
        for column in _COLUMNS:
            if not row[column]:
                yield f"{where}: '{column}' is empty"
        if row["what we do"] and not _LINK.search(row["what we do"]):
            yield f"{where}: 'what we do' has no link to our file"
        cases = set()
        for target in _LINK.findall(row["test"]):
            source = os.path.normpath(os.path.join(os.path.dirname(WORKAROUNDS), target))
            if tree.exists(source) and source.endswith(".cpp"):
                cases |= {"".join(re.findall(r'"([^"]*)"', name)) for name in _TEST_CASE.findall(tree.text(source))}
        for name in re.findall(r'"([^"]+)"', row["test"]):
            if name not in cases:
                yield f"{where}: names the test case \"{name}\", which no file that it links has"


def _prose(text):
    """The text with its code blanked out, line by line."""
    for pattern in (_FENCED, _CODE):
        text = pattern.sub(lambda code: re.sub(r"[^\n]", " ", code.group()), text)
    return text


def _anchors(text):
    """What a link to a heading says: lower case, without punctuation, with a dash for a blank."""
    headings = re.findall(r"^#+ +(.*?) *$", _FENCED.sub("", text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"\]\([^)]*\)", "", heading).lower()).replace(" ", "-") for heading in headings}


def _rows(text):
    """(line, cells) of each row of a text's tables."""
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("|"):
            yield number, [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]
