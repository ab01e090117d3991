"""What the whole costs those who read it, below the ceilings of budget.json. They may only fall: a change that would exceed one deletes
something first."""

import collections
import json
import os
import re

BUDGET = "test/architecture/budget.json"
_COMMENT = re.compile(r"//+(.*)")
_PRONOUN = re.compile(r"(who|whom|whose|whoever|what|whatever|where)$", re.IGNORECASE)


def figures(tree):
    """What is counted, by its name in budget.json."""
    return {
        "words of documents": sum(len(tree.text(path).split()) for path in tree.files((".md",))),
        "users' headers": sum(1 for path in tree.files((".hpp",), "include/skein") if os.path.dirname(path) == "include/skein"),
        "sources in the fullest folder": max(_sources(tree).values(), default=0),
        "pronouns in 1,000 words of comments": _pronouns(tree),
    }


def budget(tree):
    """A figure above its ceiling."""
    ceilings = json.loads(tree.text(BUDGET))
    for name, figure in figures(tree).items():
        if figure > ceilings[name]:
            yield f"{name}: {figure}, and {BUDGET} allows {ceilings[name]}"


def _sources(tree):
    return collections.Counter(
        os.path.dirname(path) for folder in ("src", "test") for path in tree.files((".hpp", ".cpp"), folder))


def _pronouns(tree):
    """Of src: who, what and where for an actor, a thing and a condition that have names (CONTRIBUTING.md says how we write)."""
    words = [word for path in tree.files((".hpp", ".cpp"), "src") for comment in _COMMENT.findall(tree.text(path))
             for word in re.findall(r"[A-Za-z]+", comment)]
    return round(1000 * sum(1 for word in words if _PRONOUN.match(word)) / max(1, len(words)), 1)
