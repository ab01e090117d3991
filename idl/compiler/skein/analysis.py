"""What the templates need to know beyond the declarations: recursion, hashes, in and out structs, clashes."""

from . import flattened_names, hashes, keys, model, names
from .errors import suggestion


def analyse(builder, report):
    decls = [decl for decl in builder.items if not isinstance(decl, model.Forward)]
    for decl in decls:
        if isinstance(decl, (model.Struct, model.Union)):
            decl.recursive = _reaches(decl, decl, set())
    if report.refused:
        return
    for interface in builder._built.values():
        if isinstance(interface, model.Interface) and interface.place[0] not in builder.broken:
            for operation in interface.operations:
                _complete(operation)
    for interface in builder.interfaces:
        _check_hashes(interface, report)
    _check_clashes(builder, report)
    if not report.refused:
        known = [decl for decl in builder._built.values() if decl.place[0] not in builder.broken]
        defined = [decl for decl in known if not isinstance(decl, model.Interface) or decl.defined]
        flattened_names.check_clashes(defined, report)


# ---- recursion


def parts(decl):
    """The types that a declaration is made of."""
    if isinstance(decl, model.Struct):
        return [member.type for member in decl.members]
    if isinstance(decl, model.Union):
        return [case.type for case in decl.cases] + [decl.discriminator]
    if isinstance(decl, model.Typedef):
        return [decl.type]
    return []


def _reaches(decl, goal, seen):
    for kind in parts(decl):
        while isinstance(kind, (model.Sequence, model.Array)):
            kind = kind.element
        if isinstance(kind, model.Named):
            if kind.decl is goal:
                return True
            if kind.decl not in seen:
                seen.add(kind.decl)
                if _reaches(kind.decl, goal, seen):
                    return True
    return False


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
            model.Member(name, names.unique(name, names.MEMBER - {"return_"}, taken), kind, operation.place, [], argument)
            for name, kind, argument in fields
        ],
    )


def _operation_text(operation):
    parameters = ",".join(f"{p.direction} {p.name}:{_text(p.type, ())}" for p in operation.parameters)
    raises = ",".join(sorted(f"{e.idl_name}={_declared_text(e, ())}" for e in operation.raises))
    result = _text(operation.result, ()) if operation.result else "void"
    oneway = "oneway " if operation.oneway else ""
    return f"{oneway}{result} {operation.name}({parameters}) raises({raises})"


def _text(kind, around):
    """Canonical text: structure and member names, no type names; recursion as the distance outwards."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Primitive):
        return kind.idl
    if isinstance(kind, model.String):
        return f"string<{kind.bound}>"
    if isinstance(kind, model.Sequence):
        return f"sequence<{_text(kind.element, around)},{kind.bound}>"
    if isinstance(kind, model.Array):
        return f"{_text(kind.element, around)}[{kind.size}]"
    if isinstance(kind, model.Reference):
        return f"reference<{kind.decl.idl_name}>"
    return _declared_text(kind.decl, around)


def _declared_text(decl, around):
    if decl in around:
        return f"^{len(around) - around.index(decl)}"
    inner = around + (decl,)
    if isinstance(decl, model.Enum):
        return "enum{" + ",".join(idl for idl, _, _ in decl.enumerators) + "}"
    if isinstance(decl, model.Union):
        cases = ";".join(f"{case.labels}{case.name}:{_text(case.type, inner)}" for case in decl.cases)
        return f"union({_text(decl.discriminator, inner)}){{{cases}}}"
    return "struct{" + ";".join(f"{m.name}:{_text(m.type, inner)}" for m in decl.members) + "}"


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

    for decl in builder._built.values():
        claim(decl.cpp, decl.idl_name, decl.place)
        if isinstance(decl, model.Interface) and decl.defined and decl.place[0] not in builder.broken:
            claim(decl.cpp + "Proxy", f"the proxy of {decl.idl_name}", decl.place)
            claim(decl.cpp + "Skeleton", f"the skeleton of {decl.idl_name}", decl.place)
            for operation in decl.operations:
                for struct in (operation.in_struct, operation.out_struct):
                    claim(struct.cpp, f"{struct.cpp_name} of {decl.idl_name}::{operation.name}", operation.place)


# ---- facts about types


def plain_element(decl):
    """The basic type of which a struct is one run, or None."""
    elements = set()

    def visit(kind):
        kind = model.unaliased(kind)
        if isinstance(kind, model.Array):
            visit(kind.element)
        elif isinstance(kind, model.Named) and isinstance(kind.decl, model.Struct) and not kind.decl.recursive:
            for member in kind.decl.members:
                visit(member.type)
        else:
            elements.add(kind)

    if type(decl) is not model.Struct or not decl.members or any(m.argument for m in decl.members):
        return None
    for member in decl.members:
        visit(member.type)
    only = elements.pop() if len(elements) == 1 else None
    return only if isinstance(only, model.Primitive) and only.idl != "boolean" else None


def bounded(kind):
    """Whether a value of this type, not counting declared types in it, must be checked for a bound."""
    kind = model.unaliased(kind)
    if isinstance(kind, (model.String, model.Sequence)) and kind.bound:
        return True
    return isinstance(kind, (model.Sequence, model.Array)) and bounded(kind.element)


# ---- pragmas


def apply_pragmas(pragmas, builder, report, main_file):
    structs = {decl.scope: decl for decl in builder._built.values() if type(decl) is model.Struct}
    keylists = keys.Keylists(structs, report)
    for pragma in pragmas:
        words = pragma.text.split() or [""]
        if words[0] == "keylist":
            keylists.add(pragma, words[1:])
        elif words[0] == "idempotent":
            _idempotent(pragma, words[1:], builder, report)
        elif words[0] == "stream":
            _stream(pragma, words[1:], builder, report)
        elif hint := suggestion(words[0], ["keylist", "idempotent", "stream"]):
            report.error(pragma.place, f"unknown pragma '{words[0]}'{hint}")
        elif pragma.place[0] == main_file:
            report.warning(pragma.place, f"unknown pragma '{words[0]}' is passed over")
    for pragma in pragmas:  # once it is known which operations are streams
        words = pragma.text.split()
        if words[:1] == ["stream"] and len(words) == 3:
            _default(pragma, words[1:], builder, report)
    if not report.refused:
        keylists.check()


def _operations(pragma, kind, given, builder, report):
    """The operations that a pragma names."""
    table = {}
    for decl in builder._built.values():
        for operation in decl.operations if isinstance(decl, model.Interface) else []:
            plain = operation.name.removeprefix("_get_").removeprefix("_set_")
            for name in {plain, operation.name}:
                table.setdefault(decl.scope + (name,), []).append(operation)
    if not given:
        report.error(pragma.place, f"#pragma {kind} needs the name of an operation")
    for name in given:
        found = pragma.lookup(name, table)
        if found is None:
            known = [scope[-1] for scope in table]
            report.error(pragma.place, f"#pragma {kind}: no operation '{name}' here{suggestion(name, known)}")
        yield from found or []


def _idempotent(pragma, given, builder, report):
    for operation in _operations(pragma, "idempotent", given, builder, report):
        operation.idempotent = True
        _refuse_repeated_stream(pragma, operation, report)


def _stream(pragma, given, builder, report):
    """A stream, and perhaps the operation that it falls back on."""
    if len(given) > 2:
        return report.error(pragma.place, "#pragma stream names one stream and at most the operation whose result it brings by "
                            "default; write a pragma for each stream")  # fmt: skip
    for operation in _operations(pragma, "stream", given[:1], builder, report):
        if operation.name.startswith("_set_"):
            continue
        if operation.name.startswith("_get_"):
            report.error(pragma.place, f"#pragma stream: '{operation.name[5:]}' is an attribute; use an operation")
        elif operation.result is None or any(p.is_out for p in operation.parameters):
            report.error(
                pragma.place,
                f"#pragma stream: '{operation.name}' must have a result, which becomes the stream, and no out parameters",
            )
        else:
            operation.stream = True
            _refuse_repeated_stream(pragma, operation, report)


def _default(pragma, given, builder, report):
    for stream in _operations(pragma, "stream", given[:1], builder, report):
        source = _source_of(stream, given[1], pragma, report) if stream.stream else None
        if source is None:
            continue
        if reason := _obstacle(stream, source):
            report.error(pragma.place, f"#pragma stream: '{source.name}' cannot stand in for '{stream.name}': {reason}")
        else:
            stream.by_default = source


def _source_of(stream, name, pragma, report):
    """The operation of that name, own or inherited, of the stream's interface."""
    known = {operation.name: operation for operation in stream.interface.all_operations()}
    if name in known:
        return known[name]
    if "_get_" + name in known:
        report.error(pragma.place, f"#pragma stream: '{name}' is an attribute; use an operation")
    else:
        hint = suggestion(name, [each for each in known if not each.startswith("_") and each != stream.name])
        report.error(pragma.place, f"#pragma stream: {stream.interface.idl_name} has no operation '{name}'{hint}")
    return None


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
    kind = model.unaliased(kind)
    if isinstance(kind, model.Sequence):
        return model.Sequence(_resolved(kind.element), kind.bound)
    if isinstance(kind, model.Array):
        return model.Array(_resolved(kind.element), kind.size)
    return kind


def _refuse_repeated_stream(pragma, operation, report):
    """What was taken from a stream cannot be taken back."""
    if operation.stream and operation.idempotent:
        report.error(pragma.place, f"'{operation.name}' cannot be both idempotent and a stream: a stream is never repeated")
