"""Annotations (OMG IDL 4.2, clause 8, DDS-XTypes 1.3 and DDS-RPC 1.0), and those of Skein."""

from dataclasses import dataclass

from report import suggestion

from . import constants

KNOWN = frozenset(
    """ami appendable autoid bit_bound allowed_data_representation data_representation default default_literal default_nested extensibility external final
    hashid id ignore_literal_names key max min must_understand mutable nested non_serialized oneway optional position range
    service topic try_construct unit value verbatim
    DDSService DDSRequestTopic DDSReplyTopic Choice Empty
    idempotent stream""".split()
)


# Those that are set or not: `@key`, `@key(FALSE)`.
FLAGS = frozenset("external idempotent key must_understand non_serialized nested oneway optional".split())


_TYPES = "struct union enum bitmask bitset exception"
_CALLS = "operation attribute"
# What the annotations are for that this compiler obeys: kinds of declarations, as the grammar calls them, and in words.
_PLACES = {
    name: (frozenset(kinds.split()), spoken)
    for names, kinds, spoken in (
        ("final appendable mutable extensibility", _TYPES, "types"),
        ("autoid", "module struct union exception", "types and modules"),
        ("key", "member", "members of structs"),
        ("must_understand", "member", "members of structs"),
        ("optional", f"member {_CALLS}", "members of structs, and for operations"),
        ("default", "member", "members of structs"),
        ("external id hashid", "member case", "members"),
        ("default_literal value", "enumerator", "enumerators"),
        ("position", "bit_value", "bits of a bitmask"),
        ("bit_bound", "enum bitmask", "enumerations and bitmasks"),
        ("idempotent stream", _CALLS, "operations"),
        ("oneway", "operation", "operations"),
    )
    for name in names.split()
}
_SPOKEN = {"bit_value": "a bit", "bitfield": "a bit field", "struct_forward": "the announcement of a struct",
           "union_forward": "the announcement of a union", "interface_forward": "the announcement of an interface", "typedef": "a typedef"}  # fmt: skip


@dataclass(eq=False)
class Annotation:
    name: str
    arguments: dict  # name: tree of the value; what has no name is `value`
    tree: object
    token: object
    off: bool = False  # a flag that is said not to be set


class Annotations:
    """Those of one declaration."""

    def __init__(self, *trees):
        self._all = [_read(tree) for each in trees for tree in each.children]

    def __iter__(self):
        return iter(self._all)

    def add_flag(self, name):
        """As if it had been written."""
        self._all.append(Annotation(name, {}, None, None))

    def find(self, name):
        """The last of that name, or None."""
        return next((each for each in reversed(self._all) if each.name == name), None)

    def has(self, name):
        """Whether a flag is set: `@key`, `@key(TRUE)`."""
        found = self.find(name)
        return found is not None and not found.off


def _read(tree):
    token, given = tree.children
    arguments = {}
    if given is not None and given.data == "named":
        arguments = {str(argument.children[0]): argument.children[1] for argument in given.children}
    elif given is not None:
        arguments = {"value": given.children[0]}
    return Annotation(token.lstrip("@ \t").removeprefix("::"), arguments, tree, token)


def check(annotation, declared):
    """What there is to say of an annotation that nobody declared; None where it is known. One that is known in other letters, as older
    tools write `@Key`, is taken for that."""
    name = annotation.name
    if name in KNOWN or name.split("::")[-1] in declared:
        return None
    if name.lower() in KNOWN:
        annotation.name = name.lower()
        return f"'@{name}' is taken for '@{annotation.name}'"
    return f"unknown annotation '@{name}' is kept and has no effect{suggestion(name, KNOWN)}"


def misplaced(annotation, kind):
    """What there is to say of an annotation that does nothing on a declaration of this kind; None where it does something."""
    kinds, spoken = _PLACES.get(annotation.name, ((kind,), ""))
    if kind in kinds or annotation.off:
        return None
    article = "an" if kind[0] in "aeiou" else "a"
    return f"'@{annotation.name}' has no effect on {_SPOKEN.get(kind) or f'{article} {kind}'}: it is for {spoken}"


def written(tree):
    """A name that an annotation gives; nothing without one."""
    return str(tree.children[-1]) if tree is not None and tree.data == "relative_name" else ""


def verbatim(noted):
    """The text of `@verbatim(language = "comment", text = …)`, as ROS 2 writes documentation; nothing without it."""
    given = noted.find("verbatim")
    language, text = (given.arguments.get(name) for name in ("language", "text")) if given else (None, None)
    if language is None or text is None or language.data != "text" or "comment" not in language.children[0]:
        return []
    return constants.written_text(text).encode("latin-1").decode("utf-8", "replace").strip().split("\n")
