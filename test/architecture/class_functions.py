"""How many functions the classes of a C++ source declare, read without a compiler."""

import re

_TEXTS = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|^[ \t]*#[^\n]*', re.MULTILINE | re.DOTALL)
_CLASS = re.compile(r"(?<!enum )\b(?:class|struct)\s+([\w:]+)(?:\s+final)?\s*(?::[^;{}]*)?\{")
_ANGLES = re.compile(r"<[^<>()]*(?:\([^()<>]*\)[^<>()]*)*>")
_NO_FUNCTION = re.compile(r"(?:using|friend|static_assert|enum|class|struct|typedef|union)\b")
_ACCESS = re.compile(r"\b(?:public|private|protected)\s*:")
_CALLED = re.compile(r"(~?\w+)\s*$")


def classes(text):
    """(name, number of functions, whether it has a mutex) of each class that `text` defines. Constructors, destructors and
    operators do not count."""
    text = _TEXTS.sub(" ", text)
    for found in _CLASS.finditer(text):
        members = list(_members(text, found.end()))
        name = found.group(1)
        functions = sum(_is_function(member, name.split("::")[-1]) for member in members)
        yield name, functions, any(re.search(r"\bstd::(?:\w+_)?mutex\s+\w+$", member.strip()) for member in members)


def _members(text, at):
    """What stands in a class whose body begins at `at`, one after the other, and of bodies and initialisers no more than braces."""
    depth, member = 1, ""
    while depth > 0 and at < len(text):
        sign = text[at]
        at += 1
        depth += (sign == "{") - (sign == "}")
        if sign == "{" and depth == 2:
            member += "{}"
        ends = sign == ";" if depth == 1 and sign != "}" else sign == "}" and depth == 1 and text[at:].lstrip()[:1] not in (";", ",", "=")
        if ends:
            yield _ACCESS.sub("", member).strip()
            member = ""
        elif depth == 1 and sign != "}":
            member += sign


def _is_function(member, name):
    while (plain := _ANGLES.sub("", member)) != member:
        member = plain
    before, found, _ = member.partition("(")
    called = _CALLED.search(before)
    if not found or not called or _NO_FUNCTION.match(member) or "=" in before or "{" in before or "operator" in before:
        return False
    return called.group(1).lstrip("~") not in (name, "requires", "decltype", "noexcept", "alignas")
