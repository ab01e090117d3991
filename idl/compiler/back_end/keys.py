"""Keys of structs, by `@key` or `#pragma keylist`. What Skein takes for the key is what DDS makes of the flattened IDL."""

import model
from report import suggestion


def apply(builder, pragmas, report):
    """Sets the keys of all structs."""
    structs = {decl.scope: decl for decl in builder.declarations.values() if type(decl) is model.Struct}
    for struct in structs.values():
        for member in struct.all_members():
            if any(True for _ in member.annotations) and member.annotations.has("key"):
                _add_annotated(struct, member, report)
    keylists = _Keylists(structs, report)
    for pragma in pragmas:
        keylists.add(pragma)
    if not report.errors:
        keylists.check()
    for struct in structs.values():
        for key in struct.keys:
            key[0].must_understand = True


def _add_annotated(struct, member, report):
    """A nested struct counts by its own keys, or as a whole without any."""
    if size(member.type) is None:
        report.error(member.place, f"@key: '{member.name}' cannot be a key; keys are numbers, text, enumerations, and arrays and "
                     "structs of these")  # fmt: skip
    nested = _struct(member.type)
    struct.keys += [[member, *key] for key in nested.keys] if nested and nested.keys else [[member]]


class _Keylists:
    """`#pragma keylist Struct member…`, which OpenSplice and older Cyclone DDS have in place of @key."""

    def __init__(self, structs, report):
        self._structs = structs  # by their scoped names
        self._report = report
        self._places = {}  # keyed struct: where its pragma stands

    def add(self, pragma):
        words = pragma.words
        if not words:
            return self._refuse(pragma.place, "it needs a struct and its key members")
        struct = pragma.lookup(words[0], self._structs)
        if struct is None:
            known = [scope[-1] for scope in self._structs]
            return self._refuse(pragma.place, f"no struct '{words[0]}' here{suggestion(words[0], known)}")
        if struct.place.file != pragma.place.file:
            return self._refuse(pragma.place, f"{struct.idl_name} is of another file, where its keylist must stand")
        self._places[struct] = pragma.place
        for path in words[1:]:
            key = self._members(pragma.place, struct, path)
            if key and key not in struct.keys:
                struct.keys.append(key)

    def check(self):
        """Once all are known. A struct whose keylist names no member has no key."""
        for struct, place in self._places.items():
            struct.keys.sort(key=lambda key, struct=struct: _position(struct, key))
            here, in_dds = _in_skein(struct), _in_dds(struct)
            if struct.keys and here != in_dds:
                self._refuse(place, f"the key of {struct.idl_name} is {', '.join(here)}, but in DDS {', '.join(in_dds)}: "
                             "there a nested struct counts by its own keylist, or as a whole without one; "
                             "make both agree")  # fmt: skip

    def _refuse(self, place, reason):
        self._report.error(place, f"#pragma keylist: {reason}")

    def _members(self, place, struct, path):
        """The members on the way to a key; None, and an error, where it can be none."""
        found = []
        parts = path.split(".")
        for depth, name in enumerate(parts, 1):
            member = next((m for m in struct.all_members() if m.name == name), None)
            if member is None:
                hint = suggestion(name, [m.name for m in struct.all_members()])
                return self._refuse(place, f"{struct.idl_name} has no member '{name}'{hint}")
            found.append(member)
            struct = _struct(member.type)
            if struct is None and depth < len(parts):
                return self._refuse(place, f"'{name}' in '{path}' is no struct")
        if size(found[-1].type) is None:
            return self._refuse(place, f"'{path}' cannot be a key; keys are numbers, text, enumerations, and arrays and "
                                "structs of these")  # fmt: skip
        return found


def _struct(kind):
    kind = model.unaliased(kind)
    return kind.decl if isinstance(kind, model.Named) and type(kind.decl) is model.Struct else None


def _position(struct, key):
    """DDS knows no order but that of the members."""
    position = []
    for member in key:
        position.append([id(each) for each in struct.all_members()].index(id(member)))
        struct = _struct(member.type)
    return position


# ---- the members that a key consists of, as paths to numbers, text and enumerations


def _in_skein(struct):
    return [path for key in struct.keys for path in _below(".".join(m.name for m in key), key[-1].type, _whole)]


def _in_dds(struct):
    """By XTypes 7.2.2.4.4 (as idlc does it): a struct without keys that is a key itself is so as a whole."""
    if not struct.keys:
        return _whole(struct)
    keyed = {id(key[0]) for key in struct.keys}
    return [path for m in struct.all_members() if id(m) in keyed for path in _below(m.name, m.type, _in_dds)]


def _whole(struct):
    return [path for m in struct.all_members() for path in _below(m.name, m.type, _whole)]


def _below(path, kind, members):
    kind = model.unaliased(kind)
    while isinstance(kind, model.Array):
        kind = model.unaliased(kind.element)
    struct = _struct(kind)
    return [f"{path}.{inner}" for inner in members(struct)] if struct else [path]


# ---- how long a key may be

UNBOUNDED = 1 << 40
LONGEST = 16  # a longer key is hashed, however long it is


def size_of_member(member):
    """The size of a member alone, which is found once."""
    if not hasattr(member, "key_size"):
        member.key_size = size(member.type)
    return member.key_size


def size(kind, start=0):
    """The largest offset at which a key that begins at `start` may end in CDR; None: it cannot be a key."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Primitive):
        length = model.PRIMITIVES[kind.idl][1]
        return start + -start % model.alignment(length) + length
    if isinstance(kind, model.String):
        return start + -start % 4 + 4 + kind.bound + 1 if kind.bound else UNBOUNDED
    if isinstance(kind, model.Array):
        struct = _struct(kind.element)
        if struct and struct.keys and _in_skein(struct) != _whole(struct):
            return None  # DDS would take of each element its own keys alone
        for _ in range(kind.size):
            begin, start = start, size(kind.element, start)
            if start is None or start > LONGEST:
                return start and UNBOUNDED
            if start == begin:  # elements without a member
                break
        return start
    if isinstance(kind, model.Named) and isinstance(kind.decl, (model.Enum, model.Bitmask, model.Bitset)):
        length = kind.decl.bits // 8
        return start + -start % length + length
    if isinstance(kind, model.Named) and type(kind.decl) is model.Struct:
        ends = kind.decl.__dict__.setdefault("key_ends", {})  # by where it begins: structs of structs are asked again and again
        if start not in ends:
            ends[start] = _size_of_struct(kind.decl, start)
        return ends[start]
    return None


def _size_of_struct(struct, start):
    members = [key[-1] for key in struct.keys] or list(struct.all_members())
    if any(size_of_member(member) is None for member in members):
        return None
    for member in members:
        start = size(member.type, start)
        if start > LONGEST:
            return UNBOUNDED
    return start
