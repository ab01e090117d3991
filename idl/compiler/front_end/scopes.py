"""Names and where they are known (OMG IDL 4.2, clause 7.5). Names that differ only in case are two names."""

from dataclasses import dataclass

from report import native, suggestion


def plain(name):
    """An identifier without the escape that lets a keyword be one."""
    return str(name).removeprefix("_")


@dataclass(eq=False)
class Symbol:
    """What a name stands for: `what` is a declaration of the model, an `Enumerator`, a `LeftOut`, or None for a module."""

    what: object
    place: object
    scope: object = None  # of what holds names itself


@dataclass(eq=False)
class Enumerator:
    name: str
    enum: object  # model.Enum


@dataclass(eq=False)
class Flag:
    """A bit of a bitmask, as a constant."""

    value: int


@dataclass(frozen=True)
class Cause:
    """Why something cannot be used."""

    place: object
    reason: str

    def seen_from(self, file):
        """Where to look; and why, unless that was said of `file` itself."""
        return f"{self.place}: {self.reason}" if self.reason and self.place.file != file else str(self.place)


@dataclass(eq=False)
class LeftOut:
    """A declaration of which nothing is generated."""

    cause: Cause
    told: bool = False  # its own error is enough: each use would repeat it


class Declared:
    """Names that are declared side by side, and where."""

    def __init__(self, inherited=None):
        self.places = dict(inherited.places) if inherited else {}
        self._spelled = {lower: list(each) for lower, each in inherited._spelled.items()} if inherited else {}

    def add(self, name, place):
        self.places.setdefault(name, place)
        self._spelled.setdefault(name.lower(), []).append((name, place))

    def in_other_letters(self, name):
        """The first that differs in case alone, and its place; None without one."""
        return next((each for each in self._spelled.get(name.lower(), ()) if each[0] != name), None)


class Members(Declared):
    """Those of a struct, an exception or a union."""

    def __init__(self, inherited=None):
        super().__init__(inherited)
        self.ids = dict(inherited.ids) if inherited else {}  # and the names that have them
        self.last_id = inherited.last_id if inherited else None


# Of which names may be almost right.
_TYPES = "boolean char wchar octet short long float double string wstring int8 int16 int32 int64 uint8 uint16 uint32 uint64".split()


class Scope:
    def __init__(self, name="", outer=None):
        self.outer = outer
        self.path = outer.path + (name,) if outer else ()
        self.bases = []  # scopes of inherited interfaces and structs
        self.names = {}
        self.declared = Declared()

    def own(self, name, seen=None):
        """The symbol of that name here or in a base; None where there is none."""
        if name in self.names:
            return self.names[name]
        seen = set() if seen is None else seen
        for base in self.bases:
            if id(base) not in seen:
                seen.add(id(base))
                if found := base.own(name, seen):
                    return found
        return None

    def _inherited(self, name):
        """All symbols of that name, here or, if there is none, in the bases."""
        if name in self.names:
            return [self.names[name]]
        found = {id(symbol): symbol for base in self.bases for symbol in base._inherited(name)}
        return list(found.values())

    def find(self, parts, absolute):
        """The symbol of a scoped name that is used here, or None and why there is none."""
        scope = self
        while scope.outer and (absolute or scope.own(parts[0]) is None):
            scope = scope.outer
        found = scope.own(parts[0])
        if found is None:
            return None, self._unknown(parts)
        if len(several := scope._inherited(parts[0])) > 1:
            places = " and ".join(str(symbol.place) for symbol in several)
            return None, f"'{parts[0]}' is inherited from several bases, see {places}; write which, as in Base::{parts[0]}"
        for index, part in enumerate(parts[1:], 1):
            outer = "::".join(parts[:index])
            if isinstance(found.what, LeftOut):
                return found, ""
            if found.scope is None:
                return None, f"{outer} holds no names"
            inner = found.scope.own(part)
            if inner is None:
                return None, f"there is no '{part}' in {outer}{suggestion(part, found.scope.names)}"
            found = inner
        return found, ""

    def _unknown(self, parts):
        name = "::".join(parts)
        if own := native(parts[0] if len(parts) == 1 else parts[-1] if parts[0] == "std" else ""):
            return f"there is no '{name}' here; write {own}"
        return f"there is no '{parts[0]}' here{suggestion(parts[0], self._known() + _TYPES)}"

    def _known(self):
        scope, known = self, []
        while scope:
            known += scope.names
            scope = scope.outer
        return known
