"""What the whole costs those who read it, below the ceilings of budget.json. They may only fall: a change that would exceed one deletes
something first."""

import collections
import json
import os
import re
import subprocess

import class_functions

BUDGET = "test/architecture/budget.json"
MOST_FUNCTIONS = 15
MISSION_LINES = "thousand lines read to compile the mission"
_COMMENT = re.compile(r"//+(.*)")
_PRONOUN = re.compile(r"(who|whom|whose|whoever|what|whatever|where)$", re.IGNORECASE)


def figures(tree):
    """What is counted, by its name in budget.json."""
    return {
        "words of documents": sum(len(tree.text(path).split()) for path in tree.files((".md",))),
        "users' headers": sum(1 for path in tree.files((".hpp",), "include/skein") if os.path.dirname(path) == "include/skein"),
        "sources in the fullest folder": max(_sources(tree).values(), default=0),
        "names that sources of two folders share": _shared_names(tree),
        "pronouns in 1,000 words of comments": _pronouns(tree),
        f"functions beyond {MOST_FUNCTIONS} of classes with a mutex": _functions_beyond(tree),
    }


def budget(tree):
    """A figure above its ceiling."""
    ceilings = json.loads(tree.text(BUDGET))
    for name, figure in figures(tree).items():
        if figure > ceilings[name]:
            yield f"{name}: {figure}, and {BUDGET} allows {ceilings[name]}"


def mission_lines(tree, build):
    """More lines than the ceiling for a compiler to read for `./dev mission`, which is what most of its time goes to.

    Preprocesses each unit that it builds, in the folder `build`: the same number on each machine that has the same headers.
    """
    subprocess.run(["cmake", "--preset", "mission", "-B", build], cwd=tree.root, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", build, "--target", "skein_generated"], check=True, stdout=subprocess.DEVNULL)
    told = subprocess.run(["ninja", "-C", build, "-t", "commands", "skein_flight"], check=True, capture_output=True, text=True).stdout
    commands = [line for line in told.splitlines() if re.search(r" -c \S+\.(cxx|cpp)$", line) and ".hxx" not in line.split()[-1]]
    lines = 0
    for command in commands:
        preprocess = re.sub(r" -o \S+ -c ", " -E -P -w ", command)
        lines += subprocess.run(preprocess, shell=True, cwd=build, check=True, capture_output=True).stdout.count(b"\n")
    figure, ceiling = round(lines / 1000), json.loads(tree.text(BUDGET))[MISSION_LINES]
    print(f"weight: {MISSION_LINES}: {figure}, of {ceiling} at most, in {len(commands)} units")
    if figure > ceiling:
        yield f"{MISSION_LINES}: {figure}, and {BUDGET} allows {ceiling}; `g++ -H` shows which headers a source brings"


def _sources(tree):
    return collections.Counter(
        os.path.dirname(path) for folder in ("src", "test") for path in tree.files((".cpp", ".c"), folder))


def _shared_names(tree):
    """How many names sources of two folders have: who looks for one finds the other."""
    places = collections.defaultdict(set)
    for folder in ("src", "brokerless_discovery"):
        for path in tree.files((".hpp", ".cpp", ".h", ".c"), folder):
            places[os.path.splitext(os.path.basename(path))[0]].add(os.path.dirname(path))
    return sum(1 for folders in places.values() if len(folders) > 1)


def _functions_beyond(tree):
    """A class under a lock has one job, so few functions: how many more there are in all."""
    return sum(max(0, functions - MOST_FUNCTIONS) for folder in ("src", "include", "brokerless_discovery")
               for path in tree.files((".hpp", ".cpp"), folder)
               for _, functions, has_mutex in class_functions.classes(tree.text(path)) if has_mutex)


def _pronouns(tree):
    """Of src: who, what and where for an actor, a thing and a condition that have names (CONTRIBUTING.md says how we write)."""
    words = [word for path in tree.files((".hpp", ".cpp"), "src") for comment in _COMMENT.findall(tree.text(path))
             for word in re.findall(r"[A-Za-z]+", comment)]
    return round(1000 * sum(1 for word in words if _PRONOUN.match(word)) / max(1, len(words)), 1)
