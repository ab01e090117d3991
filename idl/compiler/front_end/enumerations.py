"""Enumerations, bitmasks and bitsets."""

import model
import names

from . import annotations, constants, scopes


class Enumerations:
    """The part of the builder that makes enumerations, bitmasks and bitsets of the model."""

    def _enum(self, tree, noted):
        name, *enumerators = tree.children
        bits = self._bit_bound(noted, 32)
        enum = self._declare(model.Enum, name, tree, bits=8 if bits <= 8 else 16 if bits <= 16 else 32)
        enum.documentation = enum.documentation or annotations.verbatim(noted)
        inner = self._scope.names[scopes.plain(name)].scope = scopes.Scope(scopes.plain(name), self._scope)
        taken, used = set(), set()
        for each in enumerators:
            annotated, token, assigned = each.children
            plain = scopes.plain(token)
            self._check_free(token, plain)
            noted = self._read_annotations("enumerator", annotated)
            enum.values.append(self._enumerator_value(enum, token, noted, assigned, used))
            symbol = scopes.Symbol(scopes.Enumerator(plain, enum), self._place(token))
            self._scope.names[plain] = inner.names[plain] = symbol
            enum.enumerators.append((plain, names.unique(plain, names.MEMBER, taken), self._documentation(each)))
            if noted.has("default_literal"):
                if enum.initial is not None:
                    raise constants.Fault(noted.find("default_literal").token, f"'{enum.initial}' is the default literal already")
                enum.initial = plain
        self._add(enum)

    def _enumerator_value(self, enum, token, noted, assigned, used):
        kind = model.Primitive(model.SIGNED[enum.bits])
        given = noted.find("value")
        where = assigned if assigned is not None else given and given.arguments.get("value")
        value = constants.value(where, kind, self._resolve) if where is not None else enum.values[-1] + 1 if enum.values else 0
        if value in used:
            raise constants.Fault(where if where is not None else token, f"another enumerator has the value {value} already")
        used.add(value)
        return value

    def _bit_bound(self, noted, most):
        bits, where = self._number(noted, "bit_bound")
        if bits is not None and not 1 <= bits <= most:
            raise constants.Fault(where, f"@bit_bound is from 1 to {most} here, not {bits}")
        return 32 if bits is None else bits

    def _bitmask(self, tree, noted):
        name, *values = tree.children
        bound = self._bit_bound(noted, 64)
        mask = self._declare(model.Bitmask, name, tree, bits=next(bits for bits in (8, 16, 32, 64) if bound <= bits))
        inner = self._scope.names[scopes.plain(name)].scope = scopes.Scope(scopes.plain(name), self._scope)
        taken = set()
        for each in values:
            annotated, token = each.children
            plain = scopes.plain(token)
            if plain in inner.names:
                raise constants.Fault(token, f"there is a bit '{plain}' already, at {inner.names[plain].place}")
            position, where = self._number(self._read_annotations("bit_value", annotated), "position")
            if position is None:
                position, where = (mask.flags[-1][2] + 1 if mask.flags else 0), token
            if not 0 <= position < bound:
                raise constants.Fault(where, f"the position {position} is none of the {bound} bits")
            if position in [flag[2] for flag in mask.flags]:
                raise constants.Fault(where, f"another bit has the position {position} already")
            inner.names[plain] = scopes.Symbol(scopes.Flag(1 << position), self._place(token))
            mask.flags.append((plain, names.unique(plain, names.MEMBER, taken), position, self._documentation(each)))
        self._add(mask)

    def _bitset(self, tree, noted):
        name, base, *fields = tree.children
        found = model.unaliased(self._declared(base, self._symbol(base))) if base is not None else None
        if base is not None and (not isinstance(found, model.Named) or not isinstance(found.decl, model.Bitset)):
            raise constants.Fault(base, "the base of a bitset must be a bitset that is defined before it")
        bitset = self._declare(model.Bitset, name, tree)
        bitset.fields = list(found.decl.fields) if found else []
        taken = {field.cpp_name for field in bitset.fields}
        for each in fields:
            self._bit_fields(bitset, each, taken)
        used = sum(field.width for field in bitset.fields)
        if not 1 <= used <= 64:
            raise constants.Fault(name, f"a bitset has 1 to 64 bits, not {used}")
        bitset.bits = next(bits for bits in (8, 16, 32, 64) if used <= bits)
        self._add(bitset)

    def _bit_fields(self, bitset, tree, taken):
        annotated, width_tree, given, listed = tree.children
        self._read_annotations("bitfield", annotated)
        width = constants.size(width_tree, self._resolve)
        if width > 64:
            raise constants.Fault(width_tree, f"a bit field has at most 64 bits, not {width}")
        kind = self._type(given) if given is not None else model.Primitive(_bit_field_type(width))
        room = {"boolean": 1}.get(kind.idl) or (8 * model.PRIMITIVES[kind.idl][1] if constants.integers(kind) else 0)
        if width > room:
            raise constants.Fault(given, f"a bit field of {width} bits is held by a boolean or a whole number that has as many")
        for token in listed.children or [None]:
            plain = scopes.plain(token) if token is not None else ""
            if plain and any(field.name == plain for field in bitset.fields):
                raise constants.Fault(token, f"there is a bit field '{plain}' already")
            offset = sum(field.width for field in bitset.fields)
            cpp_name = names.unique(plain, names.MEMBER, taken) if plain else ""
            documentation = self._documentation(tree)
            bitset.fields.append(model.BitField(plain, cpp_name, kind, width, offset, documentation))


def _bit_field_type(width):
    return "boolean" if width == 1 else next(idl for bits, idl in model.UNSIGNED.items() if width <= bits)
