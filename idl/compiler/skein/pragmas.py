"""Collects the pragmas of a syntax tree together with the scope in which they stand."""

from dataclasses import dataclass


@dataclass
class Pragma:
    text: str
    place: tuple
    scope: tuple


def collect(tree):
    found = [Pragma(p.text(), (p.file(), p.line()), ()) for p in tree.pragmas()]
    for decl in tree.declarations():
        _collect(decl, (), found)
    return found


def _collect(node, scope, found):
    if hasattr(node, "scopedName"):
        scope = tuple(node.scopedName())
    found += [Pragma(p.text(), (p.file(), p.line()), scope) for p in node.pragmas() if p.text().strip()]
    for children in ("definitions", "contents", "members", "declarators", "cases", "enumerators", "parameters"):
        for child in getattr(node, children, list)():
            _collect(child, scope, found)
