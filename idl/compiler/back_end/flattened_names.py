"""What is called what in `x.dds.idl`. No two things may be called alike there, nor in the C that idlc makes of it, where
modules are a part of the name: `a_b::c` and `a::b_c` are both `a_b_c`."""

import model

from . import flattened


def check_clashes(decls, report):
    """`decls` are those of the file and of all that it includes."""
    modules = {decl.modules[:depth] for decl in decls for depth in range(1, len(decl.modules) + 1)}
    owners = {}

    def claim(name, owner, place):
        other = owners.setdefault(name, owner)
        if other != owner:
            _report(name, other, owner, place, report)

    for decl in decls:
        for name, owner, place in _names(decl):
            path = decl.modules + (name,)
            if path in modules:
                _report("_".join(path), f"the module {'::'.join(path)}", owner, place, report)
            claim("_".join(path), owner, place)
        if isinstance(decl, model.Interface):
            for name, owner, place in _members(decl):
                claim("_".join(decl.modules + (name,)), owner, place)


def _report(name, one, other, place, report):
    report.error(place, f"the flattened name {name} would be both {one} and {other}; rename one of them")


def _names(decl):
    """Each name that a declaration brings into its module, what it is, and where that stands."""
    if isinstance(decl, model.Interface):
        for operation in decl.operations:
            for name in _names_of_operation(operation):
                yield name, f"{name} of {_scoped(operation)}", operation.place
        for suffix in ("Call", "Request", "Return", "Reply"):
            name = f"{decl.dds_name}_{suffix}"
            yield name, f"{name} of {decl.idl_name}", decl.place
        return
    yield decl.dds_name, decl.idl_name, decl.place
    for path, kind in _types(decl):
        for name, pairs in _pairs(path, kind):
            yield name, f"the pairs of {pairs}", decl.place
    if isinstance(decl, model.Enum) and decl.counted:
        for name, _, _ in decl.enumerators:
            yield name, f"the enumerator {'::'.join([*decl.scope[:-1], name])}", decl.place
    if isinstance(decl, model.Exception_):
        name = flattened.exception_hash(decl)
        yield name, f"{name} of {decl.idl_name}", decl.place


def _pairs(path, kind):
    """The structs that a type needs, and what each is of."""
    pair = flattened.pair_name(path) if flattened.is_struct_here(kind) else ""
    if pair:
        yield pair, path
    for name, part in kind.parts.items():
        yield from _pairs(f"{pair}_{name}" if pair else path, part)


def _types(decl):
    """The types of a declaration, by what their pairs would be called after."""
    if isinstance(decl, model.Typedef):
        return [(decl.dds_name, decl.type)]
    members = decl.all_members() if isinstance(decl, model.Struct) else getattr(decl, "cases", [])
    return [(f"{decl.dds_name}_{member.name}", member.type) for member in members]


def _names_of_operation(operation):
    suffixes = ["Hash", "In"] + ([] if operation.oneway else ["Out", "Result"])
    return [f"{operation.interface.dds_name}_{operation.name}_{suffix}" for suffix in suffixes]


def _members(interface):
    """The same of the members that are not members in the IDL."""
    call = f"{interface.dds_name}_Call."
    yield call + flattened.UNKNOWN_OPERATION, "the case of unknown operations", interface.place
    for operation in interface.all_operations():
        yield call + operation.dds_member, _scoped(operation), interface.place
    for operation in interface.operations:
        said = _scoped(operation)
        for parameter in operation.parameters:
            for struct, holds in ((operation.in_struct, parameter.is_in), (operation.out_struct, parameter.is_out)):
                if holds:
                    yield f"{struct.dds_name}.{parameter.name}", f"the parameter {parameter.name} of {said}", operation.place
        if operation.result:
            yield f"{operation.out_struct.dds_name}.return_", f"the result of {said}", operation.place
        for exception in operation.raises:
            member = flattened.exception_member(exception)
            yield f"{interface.dds_name}_{operation.name}_Result.{member}", exception.idl_name, operation.place


def _scoped(operation):
    return f"{operation.interface.idl_name}::{operation.name}"
