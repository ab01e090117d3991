"""IDL names as Ada ones, after the OMG's Ada mapping 1.3, 1.2.4: `U` mends underscores, `IDL_` goes before reserved words. A name that is taken, where case
does not count, gets a number."""

import os
import re

import model

_RESERVED = frozenset(
    """abort abs abstract accept access aliased all and array at begin body case constant declare delay delta digits do else elsif end entry exception exit for
    function generic goto if in interface is limited loop mod new not null of or others out overriding package pragma private procedure protected raise range
    record rem renames requeue return reverse select separate some subtype synchronized tagged task terminate then type until use when while with xor
    standard ada interfaces skein""".split()
)
STANDARD = ("Boolean", "Character", "Duration", "Float", "Integer", "Long_Float", "Long_Long_Float", "Long_Long_Integer", "Natural", "Positive",
            "Short_Integer", "Short_Short_Integer", "String", "Wide_Character", "Wide_String")  # fmt: skip
# What each package declares beside what IDL does, and what one of an interface does.
_OWN = {"put", "get", "to_box", "from_box", "described"}
_OF_INTERFACE = {"proxy", "service", "connect", "provide", "dispatcher", "description", "handle"}


class Clash(Exception):
    """Two files that would become one package."""


def identifier(idl, reserved=()):
    """`speed_m_s` becomes Speed_M_S."""
    name = re.sub("__+", lambda found: "_U_" * (len(found[0]) - 1), idl)
    name = ("U" if name.startswith("_") or name[:1].isdigit() else "") + name + ("U" if name.endswith("_") else "")
    name = "_".join(part[:1].upper() + part[1:] for part in name.split("_"))
    return "IDL_" + name if name.lower() in _RESERVED or name.lower() in reserved or name.lower().endswith("_idl") else name


def unique(name, taken, derive=lambda name: [name]):
    """The name, with a number if it or what is derived from it is taken, all of which join `taken`."""
    made, number = name, 1
    while any(each.lower() in taken for each in derive(made)):
        number += 1
        made = f"{name}_{number}"
    taken.update(each.lower() for each in derive(made))
    return made


def members(idl_names, reserved=()):
    """Of one type or operation."""
    taken = set()
    return [unique(identifier(each, reserved), taken) for each in idl_names]


def flag(bitmask, idl):
    """A constant of a bitmask whose name in Ada that is."""
    return f"{bitmask}_{identifier(idl)}"


def unit(path):
    """The package for an IDL file."""
    return identifier(re.sub(r"\W", "_", os.path.basename(path).removesuffix(".idl"))) + "_IDL"


class Names:
    """Where declarations lie in Ada."""

    def __init__(self, items, interfaces):
        self.used = set()  # units
        self.taken = {}  # path of a package: names in it
        self._files = {}  # unit: file
        self._modules = {}  # file, modules, openings: path
        self._interfaces = {interface.scope: interface for interface in interfaces}
        self._simple = {}
        for item in items:
            self.simple(item)

    def path(self, decl):
        """The packages around a declaration, the unit first. What an interface encloses lies in its package."""
        around = self._module(decl.place.file, decl.modules, decl.openings)
        interface = self._enclosing(decl)
        return (*around, self.simple(interface)) if interface else around

    def _enclosing(self, decl):
        inner = len(decl.modules) + 1
        return self._interfaces.get(decl.scope[:inner]) if inner < len(decl.scope) else None

    def _module(self, file, modules, openings):
        key = (file, modules, openings)
        if key not in self._modules:
            if modules:
                parent = self._module(file, modules[:-1], openings[:-1])
                self._modules[key] = (*parent, unique(identifier(modules[-1]), self.names_in(parent)))
            else:
                self._modules[key] = (self._unit(file),)
        return self._modules[key]

    def _unit(self, file):
        made = unit(file)
        if self._files.setdefault(made.lower(), file) != file:
            raise Clash(f"{self._files[made.lower()]} and {file} would both become the Ada package {made}; give one of them another name")
        return made

    def names_in(self, path):
        return self.taken.setdefault(path, set(_OWN))

    def names_of_interface(self, interface):
        """In its package."""
        path = (*self.path(interface), self.simple(interface))
        if path not in self.taken:
            self.taken[path] = _OWN | _OF_INTERFACE
        return self.taken[path]

    def simple(self, decl):
        """In its package."""
        if decl not in self._simple:
            interface = self._enclosing(decl)
            taken = self.names_of_interface(interface) if interface else self.names_in(self.path(decl))
            idl = "_".join(decl.scope[len(decl.modules) + (1 if interface else 0) :])
            self._simple[decl] = unique(identifier(idl), taken, lambda name: _derived(decl, name))
        return self._simple[decl]

    def package(self, decl):
        path = self.path(decl)
        self.used.add(path[0])
        return ".".join(path)

    def qualified(self, decl):
        return f"{self.package(decl)}.{self.simple(decl)}"

    def literal(self, enum, idl):
        """Of an enumeration, in its package."""
        names = [each for each, _, _ in enum.enumerators]
        return members(names)[names.index(idl)]

    def hide_standard(self, items):
        """Whether something in these declarations has the name of one of Ada's own types."""
        hidden = {each.lower() for each in STANDARD}
        return any(name.lower() in hidden for item in items for name in _all_names(item)) or any(
            name.lower() in hidden for path, names in self.taken.items() for name in (*path, *names)
        )


def _derived(decl, name):
    """What is declared with it."""
    if isinstance(decl, model.Exception_):
        return [name, f"{name}_Members", f"Raise_{name}", f"{name}_Of"]
    if isinstance(decl, (model.Struct, model.Union)):
        return [name, f"{name}_Topic_Type", *([f"{name}_Box"] if decl.recursive else [])]
    return [name, *(flag(name, idl) for idl, _, _, _ in decl.flags)] if isinstance(decl, model.Bitmask) else [name]


def _all_names(item):
    """Of members, enumerators, operations and parameters."""
    if isinstance(item, model.Interface):
        operations = item.all_operations()
        return [*(identifier(each.name) for each in operations), *(identifier(p.name) for each in operations for p in each.parameters)]
    parts = item.all_members() if isinstance(item, model.Struct) else getattr(item, "cases", None) or getattr(item, "fields", None) or []
    return [*(identifier(each.name) for each in parts), *(identifier(idl) for idl, _, _ in getattr(item, "enumerators", []))]
