"""Collects the pragmas of a syntax tree together with the scope in which they stand."""

import os
from dataclasses import dataclass


@dataclass
class Pragma:
    text: str
    place: tuple
    scope: tuple

    def lookup(self, name, table):
        """What `name` means where the pragma stands: in its scope or in one around it."""
        parts = tuple(part for part in name.split("::") if part)
        for depth in range(len(self.scope), -1, -1):
            if found := table.get(self.scope[:depth] + parts):
                return found
        return None


def collect(tree, resolve):
    found = [Pragma(p.text().strip(), (p.file(), p.line()), ()) for p in tree.pragmas()]
    for decl in tree.declarations():
        _collect(decl, (), found)
    for pragma in found:
        pragma.place = _exact(pragma, resolve(pragma.place[0]))
    return found


def _exact(pragma, path):
    """omniidl counts the line that a pragma ends, unless the file ends there."""
    file, line = pragma.place
    if os.path.isfile(path):
        with open(path, encoding="latin-1") as stream:
            lines = stream.read().split("\n")
        if 2 <= line <= len(lines) + 1 and lines[line - 2].rstrip().endswith(pragma.text):
            return (file, line - 1)
    return pragma.place


def _collect(node, scope, found):
    if hasattr(node, "scopedName"):
        scope = tuple(node.scopedName())
    found += [Pragma(p.text().strip(), (p.file(), p.line()), scope) for p in node.pragmas() if p.text().strip()]
    for children in ("definitions", "contents", "members", "declarators", "cases", "enumerators", "parameters"):
        for child in getattr(node, children, list)():
            _collect(child, scope, found)
