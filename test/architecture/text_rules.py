"""What no file of the project says, and what README quotes."""

import re

from source_tree import SOURCES, within

_MACHINE_PATH = re.compile(r"""(?:^|[\s"'=(,:<>`])(/(?:work|home|root|Users)/[\w.]|[A-Z]:\\\\?\w)""")
_SLEEP = re.compile(r"\b(sleep_for|sleep_until|usleep|nanosleep|time\.sleep)\b|\bsleep\s*\(|^\s*sleep\s+[\d$]", re.MULTILINE)

# The only tests that sleep, and why.
SLEEPERS = {
    "test/tools/eventually.hpp": "looks again at a condition",
    "test/launch/shell_mission.hpp": "looks again at a condition",
    "test/connector/echo_service.cpp": "an operation that takes its time until it is cancelled",
    "test/conformance/fastdds_forgetting_test.cpp": "the age of what is requested: Fast DDS sends nothing again that it has just sent",
    "test/conformance/suite_lifetime.cpp": "the pace of a writer that never rests",
    "test/faults/churn.hpp": "how long participants and endpoints live, which is what the churn varies",
    "test/faults/death_test.cpp": "an operation that takes its time until it is let go",
    "test/mission/planner_process.cpp": "a planner that is slower than it declares",
    "test/faults/first_call_test.cpp": "the offset between two starts, which is what the test varies",
    "test/faults/processes.hpp": "how long a fault lasts, which is what the tests vary",
    "test/faults/tally_client.cpp": "the pace of a client that never rests",
    "test/faults/tally_peer.cpp": "an operation that takes its time",
}


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
    """Code in README that no example holds, line by line as it stands."""
    examples = ["\n" + _trimmed(tree.text(path)) + "\n" for path in tree.files((*SOURCES, ".idl"), "examples")]
    for language, code in quoted_code(tree):
        if not any("\n" + _trimmed(code) + "\n" in example for example in examples):
            first = code.strip().splitlines()[0] if code.strip() else "nothing"
            yield f"README.md: its {language} code that begins with '{first}' is in no file of examples/"


def quoted_code(tree):
    """(language, code) of each block of code that examples must hold."""
    if not tree.exists("README.md"):
        return []
    return re.findall(r"^```(cpp|idl)\n(.*?)^```$", tree.text("README.md"), re.MULTILINE | re.DOTALL)


def _trimmed(text):
    return "\n".join(line.rstrip() for line in text.strip("\n").splitlines())
