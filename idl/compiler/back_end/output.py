"""Puts the templates together: `x.idl.hpp` and `x.idl.cpp`."""

import os

import model

from . import (
    analysis,
    cdr_template,
    cpp,
    deferred_template,
    interface_template,
    json_template,
    metadata_template,
    proxy_template,
    skeleton_template,
    types_template,
)

VERSION = 9  # SKEIN_IDL_VERSION of the headers that the output is for


_OWN_HEADERS = [
    f'"skein/{name}.hpp"'
    for name in ("call", "detail/argument", "detail/declared_exception", "detail/lendable", "detail/operation", "detail/plain_layout",
                 "detail/service_reference", "detail/union_access", "detail/version", "stream")
]  # fmt: skip
_TYPES = (model.Struct, model.Union, model.Enum, model.Bitmask, model.Bitset)


def _operation_structs(interface):
    return [s for operation in interface.operations for s in (operation.in_struct, operation.out_struct)]


def _travelling(file):
    """Every type that gets functions, in order; in and out structs after their interface."""
    for item in file.items:
        if isinstance(item, _TYPES):
            yield item
        elif isinstance(item, model.Interface):
            yield from _operation_structs(item)


def _includes(file, general):
    """Those of all outputs, and those of the templates that the file uses."""
    structs = [struct for interface in file.interfaces for struct in _operation_structs(interface)]
    kinds = [each for decl in [*file.items, *structs] for kind in analysis.parts(decl) for each in kind.walk()]
    of_templates = {each.header for each in kinds if each.header.startswith(general[0][0])}
    return [f"#include {header}" for header in sorted({*general, *of_templates})]


def header(file):
    name = os.path.basename(file.path)
    lines = [
        f"// Generated from {name} by the IDL compiler of Skein. Do not edit.",
        "#pragma once",
        "",
        *_includes(file, ["<array>", "<cstdint>", "<iosfwd>", "<memory>", "<string>", "<string_view>", "<utility>", "<variant>", "<vector>"]),
        "",
        *_includes(file, _OWN_HEADERS),
        *(f'#include "{include}.hpp"' for include in file.includes),
        "",
        f"static_assert(SKEIN_IDL_VERSION == {VERSION},",
        f'              "{name}.hpp was generated for other headers of Skein: build it anew");',
        "",
    ]
    announced = cpp.in_namespaces(file.announced, lambda interface: [f"class {interface.cpp_name};"])
    proxies = cpp.in_namespaces(
        file.interfaces, lambda i: [f"class {i.cpp_name}{part};" for part in ("Proxy", "Skeleton", "Deferred")]
    )
    definitions = cpp.in_namespaces(file.items, _definition)
    if any("::skein::idl::filled<" in line for line in definitions):
        lines.insert(lines.index('#include "skein/detail/operation.hpp"'), '#include "skein/detail/filled.hpp"')
    return lines + announced + proxies + definitions + _layouts(file)


def _definition(item):
    if not isinstance(item, model.Interface):
        return types_template.definition(item)
    lines = interface_template.definition(item) + [""]
    for struct in _operation_structs(item):
        lines += types_template.definition(struct) + [""]
    for template in (proxy_template, skeleton_template, deferred_template):
        lines += template.definition(item) + [""]
    return lines[:-1]


def _layouts(file):
    lines = []
    for decl in _travelling(file):
        if analysis.uses_xcdr2(decl):
            kind = {"final": "Plain", "appendable": "Delimited", "mutable": "ParameterList"}[decl.extensibility]
            lines += ["template <>", f"inline constexpr ::skein::Representation skein::idl::kRepresentation<{decl.cpp}> =",
                      f"    ::skein::Representation::Xcdr2{kind};"]  # fmt: skip
        if isinstance(decl, (model.Bitmask, model.Bitset)) or (isinstance(decl, model.Enum) and not decl.counted):
            lines += ["template <>", f"inline constexpr bool skein::idl::kBasicOnTheWire<{decl.cpp}> = true;"]
        if analysis.any_bits_are_a_value(decl):
            lines += ["template <>", f"inline constexpr bool skein::idl::kAnyBitsAreAValue<{decl.cpp}> = true;"]
        if element := analysis.plain_element(decl):
            kind = model.PRIMITIVES[element.idl][0]
            lines += ["template <>", f"struct skein::idl::PlainLayout<{decl.cpp}> {{", f"  using Element = {kind};", "};"]
    return lines


def source(file):
    name = os.path.basename(file.path)
    lines = [
        f"// Generated from {name} by the IDL compiler of Skein. Do not edit.",
        f'#include "{file.header}"',
        "",
        "#include <ostream>",
        "",
        '#include "skein/detail/key_hash.hpp"',
        '#include "skein/detail/make_type_support.hpp"',
        '#include "skein/detail/unknown_operation.hpp"',
        "",
    ]
    return lines + cpp.in_namespaces(file.items, _implementation)


def _implementation(item):
    if isinstance(item, model.Interface):
        lines = []
        for struct in _operation_structs(item):
            lines += _type(struct, parameters=True)
        lines += interface_template.source(item) + metadata_template.interface_info(item)
        return lines + proxy_template.source(item) + skeleton_template.source(item) + deferred_template.source(item)
    return _type(item) if isinstance(item, _TYPES) else []


def _type(decl, parameters=False):
    private = []
    if isinstance(decl, (model.Enum, model.Bitmask)):
        private = json_template.tables(decl)
    else:
        private = cdr_template.bounds_check(decl)
    lines = ["namespace {", "", *private, "}  // namespace", ""] if private else []
    if isinstance(decl, model.Union):
        lines += types_template.union_source(decl)
    lines += cdr_template.functions(decl) + cdr_template.key_hash(decl)
    lines += json_template.functions(decl) + metadata_template.type_support(decl, parameters)
    if isinstance(decl, model.Exception_):
        lines += metadata_template.exception_info(decl)
    return lines
