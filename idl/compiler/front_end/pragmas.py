"""Pragmas. What they once said is said by annotations today."""

from dataclasses import dataclass

from report import suggestion

# Of CORBA's repository, and of how other compilers write their output.
_WITHOUT_MEANING = frozenset("prefix ID version once DCPS_DATA_TYPE DCPS_SUPPORT_ZERO_COPY_READ".split())
_ANNOTATIONS = frozenset(["stream", "idempotent"])


@dataclass(frozen=True)
class Keylist:
    words: list  # the struct, its members
    place: object
    scope: tuple

    def lookup(self, name, table):
        """What `name` means where the pragma stands: in its scope or in one around it."""
        parts = tuple(part for part in name.split("::") if part)
        for depth in range(len(self.scope), -1, -1):
            if found := table.get(self.scope[:depth] + parts):
                return found
        return None


def keylists(source, scope_at, report):
    """The keylists of a source; others are passed over, with a warning."""
    found = []
    for pragma in source.pragmas:
        words = pragma.text.split() or [""]
        kind = words.pop(0)
        here = pragma.place.file == source.path
        if kind == "DCPS_DATA_KEY":
            kind, words = "keylist", " ".join(words).strip('"').split()
        if kind == "keylist":
            found.append(Keylist(words, pragma.place, scope_at(pragma.offset)))
            if here:
                report.warning(pragma.place, "#pragma keylist is older than IDL 4: write @key before each member that is a key")
        elif kind in _ANNOTATIONS:
            if here:
                report.warning(pragma.place, f"#pragma {kind} is passed over: of Skein's operations, write @{kind} before the operation")
        elif hint := suggestion(kind, ["keylist"]):
            report.error(pragma.place, f"unknown pragma '{kind}'{hint}")
        elif here and kind not in _WITHOUT_MEANING:
            report.warning(pragma.place, f"unknown pragma '{kind}' is passed over")
    return found
