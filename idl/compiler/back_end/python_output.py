"""Python for IDL: `x_idl.py`, which has the package skein make the classes, and `x_idl.pyi`, which says of what types they are."""

import base64
import keyword
import os
import re
import textwrap

import model

from . import c_types, description

_NUMBERS = {"boolean": "_b.bool", "char": "_b.str", "wchar": "_b.str", "float": "_b.float", "double": "_b.float", "long double": "_b.float"}
_RESERVED = {"within", "connected", "close", "asynchronous", "Proxy", "AsyncProxy"}  # as src/languages/python/skein/_interfaces.py has it


def _name(idl):
    return idl + "_" if keyword.iskeyword(idl) else idl


def _case(case):
    return case.name + "_" if case.name in ("discriminator", "value") else _name(case.name)


def module_name(header):
    """`x_idl` for `x.idl`, below the folders that lead to it."""
    folder, base = os.path.split(header)
    return os.path.join(folder, re.sub(r"\W", "_", base.removesuffix(".idl")) + "_idl")


def outputs(file, base, name_of):
    """{path: lines}; `name_of` gives the name of an included file, whose output has that name."""
    path = os.path.join(os.path.dirname(base), module_name(os.path.basename(base)))
    return {path + ".py": _source(file), path + ".pyi": _Stub(file, name_of).lines()}


def _source(file):
    name = os.path.basename(file.path)
    constants = [each for each in file.items if isinstance(each, model.Constant)]
    named = [model.unaliased(each.type).decl for each in constants if isinstance(model.unaliased(each.type), model.Named)]
    descriptions = [description.interface_description(None, c_types.types_of([*file.items, *named]))]
    for interface in file.interfaces:
        structs = [struct for each in interface.all_operations() for struct in (each.in_struct, each.out_struct, *each.raises)]
        own = {struct for each in interface.all_operations() for struct in (each.in_struct, each.out_struct)}
        descriptions.append(description.interface_description(interface, [each for each in description.closure(structs) if each not in own]))
    lines = [f'"""Generated from {name} by the IDL compiler of Skein. Do not edit."""', "", "import skein as _skein", "", "_skein.define(globals(), '''"]
    for each in descriptions:
        lines.append(textwrap.fill(base64.b64encode(each).decode(), 120).replace("\n", "\\\n"))
    scopes = dict.fromkeys(".".join(map(_name, item.modules)) for item in file.items if item.modules)
    lines += [f"''', {tuple(scopes)!r})", ""]
    return lines + [f"{'.'.join(map(_name, each.scope))} = {_value(each)}" for each in constants]


def _value(constant):
    kind = model.unaliased(constant.type)
    if isinstance(kind, model.Named):
        place = ".".join(map(_name, kind.decl.scope))
        return f"{place}.{_name(constant.value)}" if isinstance(kind.decl, model.Enum) else f"{place}({constant.value})"
    if isinstance(kind, model.String):
        return repr(constant.value.encode("latin-1").decode("utf-8", "surrogateescape"))
    return repr(constant.value)


class _Stub:
    """The `.pyi` of one file."""

    def __init__(self, file, name_of):
        self._file = file
        self._name_of = name_of
        self._own = {item for item in file.items if isinstance(item, model.Declaration)}
        self._imports = {}

    def lines(self):
        tree = {}
        for item in self._file.items:
            if isinstance(item, model.Declaration) and not isinstance(item, model.Typedef):
                place = tree
                for part in item.scope[:-1]:
                    place = place.setdefault(_name(part), {})
                place.setdefault(_name(item.scope[-1]), {})[None] = item
        body = self._scope(tree)
        name = os.path.basename(self._file.path)
        imports = ["import builtins as _b", "import collections.abc as _c", "import enum as _enum", "import typing as _t", "",
                   "import skein as _skein", *sorted(f"import {each}" for each in self._imports), ""]  # fmt: skip
        return [f'"""Generated from {name} by the IDL compiler of Skein. Do not edit."""', "", *imports, *body]

    def _scope(self, tree):
        lines = []
        for name, inner in tree.items():
            item = inner.pop(None, None)
            nested = self._scope(inner)
            if isinstance(item, model.Constant):
                lines += [f"{name}: {self._type(item.type)}", *_said(item)]
                continue
            head, body = self._declared(name, item) if item else (f"class {name}:", [])
            body = nested + body
            lines += [head, *("    " + line if line else "" for line in (_said(item) if item else []) + (body or ["..."])), ""]
        return lines

    def _declared(self, name, item):
        if isinstance(item, model.Enum):
            return f"class {name}(_enum.IntEnum):", [f"{_name(idl)} = {value}" for (idl, _, _), value in zip(item.enumerators, item.values)]
        if isinstance(item, model.Bitmask):
            return f"class {name}(_enum.IntFlag):", [f"{_name(idl)} = {1 << position}" for idl, _, position, _ in item.flags]
        if isinstance(item, model.Bitset):
            members = [(field.name, "_b.bool" if field.type.idl == "boolean" else "_b.int", field.documentation) for field in item.fields if field.name]
            return f"class {name}:", self._members(members)
        if isinstance(item, model.Union):
            return f"class {name}(_skein.Union):", self._union(item)
        if isinstance(item, model.Interface):
            return self._interface(name, item)
        base = "(_skein.UserException)" if isinstance(item, model.Exception_) else ""
        return f"class {name}{base}:", self._members([(each.name, self._type(each.type), each.documentation) for each in item.all_members()])

    def _members(self, members):
        lines = []
        for name, kind, said in members:
            lines += [f"{_name(name)}: {kind}", *_text(said)]
        parameters = "".join(f", {_name(name)}: {kind} = ..." for name, kind, _ in members)
        return [*lines, f"def __init__(_self, /{parameters}) -> None: ..."]

    def _union(self, union):
        discriminator = self._type(union.discriminator)
        lines = [f"discriminator: {discriminator}", "value: _t.Any"]
        for case in union.cases:
            lines += ["@property", f"def {_case(case)}(self) -> {self._type(case.type)}: ..."]
        cases = "".join(f", {_case(case)}: {self._type(case.type)} = ..." for case in union.cases)
        return [*lines, f"def __init__(self, discriminator: _t.Optional[{discriminator}] = None, value: _t.Any = None, /, *{cases}) -> None: ..."]

    def _interface(self, name, interface):
        qualified = ".".join(map(_name, interface.scope))
        bases = [self._place(base) for base in interface.bases]
        functions = {kind: [] for kind in ("", "Proxy", "AsyncProxy")}
        taken = set()
        for operation in interface.all_operations():
            method, inputs, result = self._signature(operation, taken)
            said = _text(operation.documentation)
            stream = f"_skein.Stream[{result}]"
            answer = f"_c.Iterable[{result}] | _c.AsyncIterable[{result}]" if operation.stream else "None" if operation.oneway else f"_skein.Answer[{result}]"
            functions[""].append((f"def {method}(self{inputs}) -> {answer}:", said))
            functions["Proxy"].append((f"def {method}(self{inputs}) -> {stream if operation.stream else result}:", said))
            functions["AsyncProxy"].append((f"def {method}(self{inputs}) -> {stream if operation.stream else f'_skein.Call[{result}]'}:", said))
        body = [*_functions(functions[""]), "@classmethod", f"def _skein_proxies(cls) -> _b.tuple[{qualified}.Proxy, {qualified}.AsyncProxy]: ..."]
        for kind in ("Proxy", "AsyncProxy"):
            body += ["", f"class {kind}({', '.join(f'{base}.{kind}' for base in bases) or '_skein.ProxyBase'}):"]
            shown = _functions(functions[kind])
            if kind == "Proxy":
                shown += ["@property", f"def asynchronous(self) -> {qualified}.AsyncProxy: ..."]
            body += ["    " + line for line in shown or ["..."]]
        return f"class {name}({', '.join(bases) or '_skein.Interface'}):", body

    def _signature(self, operation, taken):
        plain = _name(operation.name[1:] if operation.name.startswith(("_get_", "_set_")) else operation.name)
        method = plain + "_" if plain in _RESERVED else plain
        while method in taken:  # an attribute `x` and an operation `get_x`
            method += "_"
        taken.add(method)
        named = ((p, "self_" if p.name == "self" else _name(p.name)) for p in operation.parameters if p.is_in)
        inputs = "".join(f", {name}: {self._type(p.type)}" for p, name in named)
        results = [self._type(member.type) for member in operation.out_struct.members]
        return method, inputs, "None" if not results else results[0] if len(results) == 1 else f"_b.tuple[{', '.join(results)}]"

    def _type(self, kind):
        kind = model.unaliased(kind)
        if isinstance(kind, model.Primitive):
            return _NUMBERS.get(kind.idl, "_b.int")
        if isinstance(kind, (model.String, model.WideString)):
            return "_b.str"
        if isinstance(kind, (model.Sequence, model.Array)):
            element = model.unaliased(kind.element)
            return "_b.bytes" if element == model.Primitive("octet") else f"_c.Sequence[{self._type(element)}]"
        if isinstance(kind, model.Map):
            return f"_b.dict[{self._type(kind.key)}, {self._type(kind.value)}]"
        if isinstance(kind, model.Optional):
            return f"_t.Optional[{self._type(kind.element)}]"
        if isinstance(kind, model.External):
            return self._type(kind.element)
        return "_t.Optional[_skein.Reference]" if isinstance(kind, model.Reference) else self._place(kind.decl)

    def _place(self, decl):
        """A declared type; of an included file by that file's module."""
        name = ".".join(map(_name, decl.scope))
        if decl in self._own:
            return name
        module = module_name(self._name_of(decl.place.file)).replace("/", ".")
        self._imports[module] = True
        return f"{module}.{name}"


def _functions(functions):
    lines = []
    for head, said in functions:
        lines += [head, *("    " + line for line in said), "    ..."] if said else [head + " ..."]
    return lines


def _said(decl):
    return _text(getattr(decl, "documentation", []))


def _text(lines):
    if not lines:
        return []
    text = "\n".join(lines).replace("\\", "\\\\").replace('"""', "'''")
    return f'"""{text}"""'.split("\n")
