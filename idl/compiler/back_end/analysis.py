"""What the templates need to know beyond the declarations: recursion, hashes, in and out structs, clashes."""

import model
import names
from report import suggestion

from . import flattened_names, hashes


_LONGEST_TEXT = 4096


def analyse(builder, report):
    decls = [decl for decl in builder.items if not isinstance(decl, model.Forward)]
    for decl in builder.declarations.values():
        if isinstance(decl, (model.Struct, model.Union)):
            decl.recursive = reaches(decl, decl)
    _choose_initial_cases(builder.declarations.values())
    for decl in decls:
        if isinstance(decl, (model.Struct, model.Union)) and decl.recursive and _is_without_end(decl):
            report.error(decl.place, f"a value of {decl.idl_name} would be without end: make a member by which it contains itself @optional, "
                         "or a sequence")  # fmt: skip
    if report.errors:
        return
    for interface in builder.declarations.values():
        if isinstance(interface, model.Interface) and interface.place.file not in builder.broken:
            for operation in interface.operations:
                _complete(operation)
    for interface in builder.interfaces:
        _check_hashes(interface, report)
    _check_streams(builder, report)
    _check_clashes(builder, report)
    if not report.errors:
        known = [decl for decl in builder.declarations.values() if decl.place.file not in builder.broken]
        defined = [decl for decl in known if not isinstance(decl, model.Interface) or decl.defined]
        flattened_names.check_clashes(defined, report)


# ---- recursion


def _placed_parts(decl):
    if isinstance(decl, model.Struct):
        return [(member.type, member.place) for member in decl.all_members()]
    if isinstance(decl, model.Union):
        return [(case.type, case.place) for case in decl.cases] + [(decl.discriminator, decl.place)]
    return [(decl.type, decl.place)] if isinstance(decl, model.Typedef) else []


def parts(decl):
    """The types that a declaration is made of."""
    return [kind for kind, _ in _placed_parts(decl)]


def check_language(items, language, report):
    """Refuses templates that the language lacks."""
    operations = [operation for item in items if isinstance(item, model.Interface) for operation in item.operations]
    for decl in [*items, *(struct for each in operations for struct in (each.in_struct, each.out_struct))]:
        for kind, place in _placed_parts(decl):
            for each in kind.walk():
                if language not in each.languages:
                    report.error(place, f"{model.LANGUAGES[language]} has no form of the type {each.keyword}<…> yet; use a struct, or --language c++")


def reaches(decl, goal):
    """Whether a type has the declaration within it."""
    return _reaches(decl, goal, set())


def _reaches(decl, goal, seen):
    for kind in parts(decl):
        for decl in named_in(kind):
            if decl is goal:
                return True
            if decl not in seen:
                seen.add(decl)
                if _reaches(decl, goal, seen):
                    return True
    return False


def _choose_initial_cases(declarations):
    """The initial case of unions whose first one would contain the union itself: the first that ends soonest."""
    endless = {decl for decl in declarations if isinstance(decl, model.Union) and decl.cases and _is_without_end(decl)}
    while found := {union: case for union in endless if (case := _ending_case(union, endless))}:
        for union, case in found.items():
            union.initial = case
        endless -= set(found)


def _ending_case(union, endless):
    ending = (case for case in union.cases if not any(_is_without_end(inner, endless) for inner in model.contained(case.type)))
    return next(ending, None)


def _is_without_end(decl, around=frozenset(), ending=None):
    """Whether the initial value of a type contains itself, or one of what is around it. `ending`: those that were seen to end."""
    ending = set() if ending is None else ending
    if decl in ending:
        return False
    if decl in around:
        return True
    if isinstance(decl, model.Union):
        kinds = [decl.initial_case.type]
    else:
        kinds = [member.type for member in decl.all_members()] if isinstance(decl, model.Struct) else []
    inner = [found for kind in kinds for found in model.contained(kind)]
    if any(_is_without_end(each, around | {decl}, ending) for each in inner):
        return True
    ending.add(decl)
    return False


def named_in(kind):
    """The declarations that a type names."""
    return [each.decl for each in kind.walk() if isinstance(each, model.Named)]


# ---- operations


def _complete(operation):
    interface = operation.interface
    operation.hash = hashes.name_hash(operation.name)
    operation.signature = hashes.signature(_operation_text(operation))
    inputs = [(p.name, p.type, not model.is_scalar(p.type)) for p in operation.parameters if p.is_in]
    outputs = [("return_", operation.result, False)] if operation.result else []
    outputs += [(p.name, p.type, False) for p in operation.parameters if p.is_out]
    operation.in_struct = _struct(interface, operation, "In", inputs)
    operation.out_struct = _struct(interface, operation, "Out", outputs)


def _struct(interface, operation, suffix, fields):
    name = f"{interface.scope[-1]}_{operation.name}_{suffix}"
    taken = set()
    kind = "request" if suffix == "In" else "reply"
    return model.Struct(
        place=operation.place,
        scope=interface.modules + (name,),
        namespace=interface.namespace,
        cpp_name=name,
        documentation=[f"The {kind} of {interface.idl_name}::{operation.name}."],
        in_main_file=interface.in_main_file,
        modules=interface.modules,
        members=[
            model.Member(name, names.unique(name, names.MEMBER - {"return_"}, taken), kind, operation.place, argument=argument)
            for name, kind, argument in fields
        ],
    )


def _operation_text(operation):
    parameters = ",".join(f"{p.direction} {p.name}:{_text(p.type, ())}" for p in operation.parameters)
    raises = ",".join(sorted(f"{e.idl_name}={_declared_text(e, ())}" for e in operation.raises))
    result = _text(operation.result, ()) if operation.result else "void"
    oneway = "oneway " if operation.oneway else ""
    return f"{oneway}{result} {operation.name}({parameters}) raises({raises})"


def growing(interface):
    """The members of all types that may grow and that an operation carries: (type, key, digest, required, name), in the order of the
    first two. A key tells which member of one version is which of another."""
    found = {}
    for operation in interface.all_operations():
        for decl in (operation.in_struct, operation.out_struct, *operation.raises):
            _find_growing(decl, found, set())
    return sorted(found.values())


def growing_members(decl):
    """The same, of one type, if that may grow."""
    if getattr(decl, "extensibility", "final") == "final":
        return []
    return [
        (hashes.name_hash(decl.idl_name), key, hashes.name_hash(f"{member.name}:{_text(member.type, ())}"), required,
         f"{decl.idl_name}.{member.name}")
        for key, member, required in _keyed_members(decl)
    ]  # fmt: skip


def signature(decl):
    """Of a type on its own, with its keys."""
    keys = ",".join(".".join(member.name for member in key) for key in getattr(decl, "keys", []))
    return hashes.signature(_declared_text(decl, ()) + (f" keyed({keys})" if keys else ""))


def _find_growing(decl, found, seen):
    if decl in seen:
        return
    seen.add(decl)
    found.update({row[:2]: row for row in growing_members(decl)})
    for kind in parts(decl):
        for named in named_in(kind):
            _find_growing(named, found, seen)


def _keyed_members(decl):
    if isinstance(decl, model.Union):
        spelled = {None: "default"}
        return [(hashes.name_hash(spelled.get(each, f"case {each}")), case, False) for case in decl.cases for each in _labels(case)]
    # One without members has an octet on the wire, in whose place nothing else can come.
    members = enumerate(decl.all_members() or [model.Member("nothing", "nothing", model.Primitive("octet"), decl.place)])
    return [(m.id if decl.extensibility == "mutable" else place, m, m.must_understand) for place, m in members]


def _text(kind, around):
    """Canonical text: structure and member names, no type names; recursion as the distance outwards. Of a type that may grow, its name
    alone."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Primitive):
        return kind.idl
    if isinstance(kind, model.External):
        return _text(kind.element, around)
    if isinstance(kind, model.Optional):
        return f"optional<{_text(kind.element, around)}>"
    if kind.keyword:
        given = [_text(each, around) if isinstance(each, model.Kind) else str(each) for each in vars(kind).values()]
        return f"{kind.keyword}<{','.join(given)}>"
    if isinstance(kind, model.Array):
        return f"{_text(kind.element, around)}[{kind.size}]"
    if isinstance(kind, model.Reference):
        return f"reference<{kind.decl.idl_name}>"
    return _declared_text(kind.decl, around)


def _declared_text(decl, around):
    if decl in around:
        return f"^{len(around) - around.index(decl)}"
    if getattr(decl, "extensibility", "final") != "final":
        switch = f" by {_text(decl.discriminator, ())}" if isinstance(decl, model.Union) else ""
        return f"{decl.extensibility} {decl.idl_name}{switch}"
    if isinstance(decl, (model.Struct, model.Union)) and not decl.recursive:
        decl.text = decl.text or _shortened(_made_text(decl, ()))
        return decl.text
    return _made_text(decl, around)


def _shortened(text):
    """A long text stands within others as its digest, or texts would grow without bounds."""
    return text if len(text) <= _LONGEST_TEXT else f"#{hashes.signature(text):016x}"


def _made_text(decl, around):
    inner = around + (decl,)
    if isinstance(decl, model.Enum):
        return _enum_text(decl)
    if isinstance(decl, model.Bitmask):
        return f"bitmask{decl.bits}{{" + ",".join(f"{idl}@{position}" for idl, _, position, _ in decl.flags) + "}"
    if isinstance(decl, model.Bitset):
        return f"bitset{decl.bits}{{" + ",".join(f"{f.name}:{f.width}:{f.type.idl}" for f in decl.fields) + "}"
    if isinstance(decl, model.Union):
        cases = ";".join(f"{_labels(case)}{case.name}:{_text(case.type, inner)}" for case in decl.cases)
        return f"union({_text(decl.discriminator, inner)}){{{cases}}}"
    return "struct{" + ";".join(f"{m.name}:{_text(m.type, inner)}" for m in decl.all_members()) + "}"


def _enum_text(enum):
    names = [idl for idl, _, _ in enum.enumerators]
    if enum.counted:
        return "enum{" + ",".join(names) + "}"
    return f"enum{enum.bits}{{" + ",".join(f"{name}={value}" for name, value in zip(names, enum.values)) + "}"


def _labels(case):
    """Booleans are 0 and 1."""
    return [int(label) if isinstance(label, bool) else label for label in case.labels]


# ---- checks


def _check_hashes(interface, report):
    seen = {}
    for operation in interface.all_operations():
        other = seen.setdefault(operation.hash, operation)
        if other is not operation:
            report.error(operation.place, f"{operation.name} and {other.name} have the same hash; rename one of them")
        hashes_of = {0: "success"}
        for exception in operation.raises:
            number = hashes.name_hash(exception.idl_name)
            if hashes_of.setdefault(number, exception) is not exception:
                report.error(operation.place, f"two exceptions of {operation.name} have the same hash (that of "
                             f"{exception.idl_name}); rename one of them")  # fmt: skip


def _check_clashes(builder, report):
    """One C++ namespace holds what IDL keeps in several scopes."""
    owners = {}

    def claim(cpp, owner, place):
        other = owners.setdefault(cpp, owner)
        if other != owner:
            report.error(place, f"the C++ name {cpp[2:]} would be both {other} and {owner}; rename one of them")

    for decl in builder.declarations.values():
        claim(decl.cpp, decl.idl_name, decl.place)
        if isinstance(decl, model.Interface) and decl.defined and decl.place.file not in builder.broken:
            claim(decl.cpp + "Proxy", f"the proxy of {decl.idl_name}", decl.place)
            claim(decl.cpp + "Skeleton", f"the skeleton of {decl.idl_name}", decl.place)
            claim(decl.cpp + "Deferred", f"the deferred form of {decl.idl_name}", decl.place)
            for operation in decl.operations:
                for struct in (operation.in_struct, operation.out_struct):
                    claim(struct.cpp, f"{struct.cpp_name} of {decl.idl_name}::{operation.name}", operation.place)


# ---- facts about types


def uses_xcdr2(decl, seen=None):
    """Whether a type contains what is @appendable, @mutable or @optional, and so travels as XCDR2."""
    seen = seen or set()
    if decl in seen:
        return False
    seen.add(decl)
    if getattr(decl, "extensibility", "final") != "final":
        return True
    for kind in parts(decl):
        if any(isinstance(each, model.Optional) for each in kind.walk()) or any(uses_xcdr2(each, seen) for each in named_in(kind)):
            return True
    return False


def plain_element(decl):
    """The basic type of which a struct is one run, or None."""
    elements = set()
    seen = set()

    def visit(kind):
        kind = model.unaliased(kind)
        if isinstance(kind, model.Array):
            visit(kind.element)
        elif isinstance(kind, model.Named) and isinstance(kind.decl, model.Struct) and not kind.decl.recursive:
            if kind.decl not in seen:
                seen.add(kind.decl)
                for member in kind.decl.all_members():
                    visit(member.type)
        else:
            elements.add(kind)

    if type(decl) is not model.Struct or uses_xcdr2(decl) or not decl.all_members() or any(m.argument for m in decl.members):
        return None
    for member in decl.all_members():
        visit(member.type)
    only = elements.pop() if len(elements) == 1 else None
    return only if isinstance(only, model.Primitive) and only.idl not in ("boolean", "wchar", "long double") else None


def any_bits_are_a_value(decl):
    """Whether a struct is made of numbers, octets and characters alone, and lies in memory as every compiler puts it: a base's padding
    is used by some for what is derived from it."""

    def is_so(kind):
        kind = model.unaliased(kind)
        if isinstance(kind, model.Array):
            return is_so(kind.element)
        if isinstance(kind, model.Named):
            return any_bits_are_a_value(kind.decl)
        return isinstance(kind, model.Primitive) and kind.idl not in ("boolean", "wchar", "long double")

    if type(decl) is not model.Struct or decl.base or decl.recursive or uses_xcdr2(decl) or any(m.argument for m in decl.members):
        return False
    return bool(decl.members) and all(is_so(member.type) for member in decl.members)


def bounded(kind):
    """Whether a value of this type, not counting declared types in it, must be checked for a bound."""
    kind = model.unaliased(kind)
    return bool(kind.bound) or any(map(bounded, kind.consists_of))


# ---- streams


def _check_streams(builder, report):
    operations = [operation for interface in builder.interfaces for operation in interface.operations]
    for operation in operations:
        if operation.name.startswith("_set_") or not operation.stream:
            continue
        if operation.name.startswith("_get_"):
            report.error(operation.place, f"@stream: '{operation.name[5:]}' is an attribute; use an operation")
        elif operation.result is None or any(p.is_out for p in operation.parameters):
            report.error(operation.place, f"@stream: '{operation.name}' must have a result, which becomes the stream, and no out "
                         "parameters")  # fmt: skip
        elif operation.idempotent:  # what was taken from a stream cannot be taken back
            report.error(operation.place, f"'{operation.name}' cannot be both idempotent and a stream: a stream is never repeated")
    for operation in operations:
        if operation.by_default is not None:
            operation.by_default = _source_of(operation, operation.by_default, report)


def _source_of(stream, name, report):
    """The operation of that name, own or inherited, of the stream's interface."""
    known = {operation.name: operation for operation in stream.interface.all_operations()}
    if name not in known and "_get_" + name in known:
        return report.error(stream.place, f"@stream: '{name}' is an attribute; use an operation")
    if name not in known:
        hint = suggestion(name, [each for each in known if not each.startswith("_") and each != stream.name])
        return report.error(stream.place, f"@stream: {stream.interface.idl_name} has no operation '{name}'{hint}")
    if reason := _obstacle(stream, known[name]):
        return report.error(stream.place, f"@stream: '{name}' cannot stand in for '{stream.name}': {reason}")
    return known[name]


def _obstacle(stream, source):
    """Why the result of `source` cannot be what the stream brings; None where it can."""
    if source.stream:
        return "it is a stream itself"
    if [(p.direction, _resolved(p.type)) for p in source.parameters] != [
        (p.direction, _resolved(p.type)) for p in stream.parameters
    ]:
        return "its parameters are others"
    if source.result is None or _resolved(source.result) != _resolved(stream.result):
        return "its result is another"
    if undeclared := [exception.idl_name for exception in source.raises if exception not in stream.raises]:
        return f"it raises {', '.join(undeclared)}, which the stream does not"
    return None


def _resolved(kind):
    """The type without any typedef."""
    return model.unaliased(kind).rebuilt(_resolved)
