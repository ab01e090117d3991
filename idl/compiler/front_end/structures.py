"""Structs, exceptions and unions, and what their members may be."""

import hashlib

import model
import names

from . import annotations, constants, scopes

_GREATEST_ID = 0x0FFFFFFF


class Structures:
    """The part of the builder that makes structs, exceptions and unions of the model."""

    def _struct(self, tree, noted, kind=model.Struct, reserved=names.MEMBER):
        name, *rest = tree.children
        base = rest.pop(0) if kind is model.Struct else None
        struct = self._defined(kind, name, tree)
        struct.extensibility = self._extensibility(noted)
        hashed = self._by_hash(noted)
        struct.documentation = struct.documentation or annotations.verbatim(noted)
        self._span(name, tree)
        supported = base is None or self._inherit(struct, base)
        self._known[struct] = scopes.Members(self._known.get(struct.base))
        scope = self._enter(name, struct)
        taken = {member.cpp_name for member in struct.all_members()}
        reserved |= {struct.cpp_name}  # a class has no member of its own name
        for member in rest:
            supported = self._members(struct, member, reserved, taken, hashed) and supported
        self._leave(scope, struct)
        self._finish(name, struct, supported)

    def _inherit(self, struct, tree):
        found = self._declared(tree, self._symbol(tree))
        base = model.unaliased(found) if found else None
        if found is None:
            return False
        if not isinstance(base, model.Named) or type(base.decl) is not model.Struct or base.decl in self._forwards:
            self._error(tree, f"the base of {struct.idl_name} must be a struct that is defined before it")
            return False
        struct.base = base.decl
        if struct.extensibility != base.decl.extensibility and struct.in_main_file:
            self.report.warning(self._place(tree), f"{struct.idl_name} is {struct.extensibility} and its base {base.decl.extensibility}: where "
                                "they differ, other compilers refuse both (DDS-XTypes 1.3, 7.2.2.4.5)")  # fmt: skip
        return True

    def _extensibility(self, noted):
        """What the last of @final, @appendable, @mutable and @extensibility says; final without any."""
        said = "final"
        for each in noted:
            if each.name in ("final", "appendable", "mutable"):
                said = each.name
            elif each.name == "extensibility":
                said = annotations.written(each.arguments.get("value")).lower()
                if said not in ("final", "appendable", "mutable"):
                    raise constants.Fault(each.token, "@extensibility is FINAL, APPENDABLE or MUTABLE")
        return said

    def _member_id(self, decl, name, noted, hashed, first=0, least=0):
        """By @id, @hashid or @autoid (DDS-XTypes 1.3, 7.3.1.2.1.1), else one more than the last."""
        members = self._known[decl]
        given, where = self._number(noted, "id")
        by_hash = noted.find("hashid")
        if given is None and (by_hash or hashed):
            tree = by_hash and by_hash.arguments.get("value")
            text = constants.value(tree, model.String(0), self._resolve) if tree is not None else ""
            given = int.from_bytes(hashlib.md5((text or name).encode("latin-1")).digest()[:4], "little") & _GREATEST_ID
        if given is None:
            given = first if members.last_id is None else members.last_id + 1
        if not least <= given <= _GREATEST_ID:
            raise constants.Fault(where if where is not None else name, f"a member's identifier is from {least} to {_GREATEST_ID}, not {given}")
        if other := members.ids.get(given):
            reason = f"'{name}' would have the identifier {given}, as '{other}' has; give one of them another by @id"
            raise constants.Fault(where if where is not None else by_hash.token if by_hash else name, reason)
        members.ids[given], members.last_id = name, given
        return given

    def _exception(self, tree, noted):
        self._struct(tree, noted, model.Exception_, names.EXCEPTION_MEMBER)

    def _members(self, struct, tree, reserved, taken, hashed):
        """Adds the members of one declaration; whether they are supported."""
        noted, kind, declarators = tree.children
        try:
            base = self._type_or_definition(kind)
            for declarator in declarators.children:
                found = self._read_annotations("member", noted, declarator.children[0])
                name = scopes.plain(declarator.children[1])
                self._check_member(declarator, name, struct)
                built = base and self._with_sizes(base, declarator)
                built = built and self._complete(kind, built, found.has("external") or found.has("optional"))
                if built is None:
                    return False
                documentation = self._documentation(declarator) or self._documentation(kind, noted) or annotations.verbatim(found)
                cpp_name = names.unique(name, reserved | {names.plain(each.scope[-1]) for each in struct.nested}, taken)
                member = model.Member(name, cpp_name, built, self._place(declarator), documentation, annotations=found)
                member.initial = self._initial(found, built)
                member.id = self._member_id(struct, declarator.children[1], found, hashed)
                if self._comments.say_key(tree.meta.end_pos):
                    found.add_flag("key")
                member.must_understand = found.has("must_understand")
                if found.has("optional"):
                    self._check_optional(member, found)
                struct.members.append(member)
        except constants.Fault as fault:
            self._fault(fault)
            return False
        return True

    def _check_optional(self, member, noted):
        if noted.has("key"):
            raise constants.Fault(noted.find("key").token, f"'{member.name}' cannot be a key and optional: each sample has its key")
        member.type = model.Optional(member.type)

    def _initial(self, noted, kind):
        """The value of @default; None without one."""
        given = noted.find("default")
        tree = given and given.arguments.get("value")
        if given and tree is None:
            raise constants.Fault(given.token, "@default needs a value: @default(1)")
        return constants.value(tree, kind, self._resolve) if tree is not None else None

    def _number(self, noted, name):
        """The number that an annotation gives, and the tree where it stands; None without one."""
        given = noted.find(name)
        tree = given and given.arguments.get("value")
        if given and tree is None:
            raise constants.Fault(given.token, f"@{name} needs a number: @{name}(1)")
        return (None, None) if tree is None else (constants.value(tree, model.Primitive("long long"), self._resolve), tree)

    def _check_member(self, declarator, name, decl):
        known = self._known[decl].places.get(name)
        self._warn_of_case(declarator, name, self._known[decl])
        if known:
            raise constants.Fault(declarator, f"there is a member '{name}' already, at {known}")

    def _complete(self, where, kind, apart):
        """The type of a member; of what is not defined yet only where it may lie apart. None, with an error, where it may not."""
        later = next((decl for decl in model.contained(kind) if decl in self._forwards), None)
        if later is None:
            return kind
        if apart:
            return model.External(kind)
        return self._error(where, f"{later.idl_name} is not defined yet: make the member @external or @optional, or use a sequence of it")

    def _finish(self, name, decl, supported):
        if supported:
            self._add(decl)
        else:
            self.declarations.pop(decl.scope, None)
            self._leave_out(name)
        self._forwards.pop(decl, None)

    def _defined(self, kind, name, tree):
        """The declaration that a definition is of: a new one, or the one that it was announced as."""
        found = self._scope.names.get(scopes.plain(name))
        decl = found.what if found else None
        if type(decl) is not kind or decl not in self._forwards:
            decl = self._declare(kind, name, tree)
            self._forwards[decl] = decl.place
            found = self._scope.names[scopes.plain(name)]
        decl.place = self._place(name)
        decl.in_main_file = decl.place.file == self.source.path
        decl.documentation = self._documentation(tree)
        return decl

    def _struct_forward(self, tree, noted):
        self._forward(model.Struct, tree)

    def _union_forward(self, tree, noted):
        self._forward(model.Union, tree)

    def _forward(self, kind, tree):
        name = tree.children[0]
        found = self._scope.names.get(scopes.plain(name))
        if found is None or type(found.what) is not kind:
            decl = self._declare(kind, name, tree)
            self._forwards[decl] = decl.place
            if decl.in_main_file:
                self.items.append(model.Forward(decl))

    def _union(self, tree, noted):
        name, annotated, discriminator, *cases = tree.children
        self._read_annotations("discriminator", annotated)
        union = self._defined(model.Union, name, tree)
        union.extensibility = self._extensibility(noted)
        self._known[union] = scopes.Members()
        scope = self._enter(name, union)
        union.discriminator = self._type_or_definition(discriminator)
        supported = union.discriminator is not None and self._check_discriminator(discriminator, union.discriminator)
        taken = set()
        used = {}
        for case in cases if supported else []:
            try:
                supported = self._case(union, case, taken, used, self._by_hash(noted)) and supported
            except constants.Fault as fault:
                self._fault(fault)
                supported = False
        if supported:
            self._default(union, used)
        self._leave(scope, union)
        self._finish(name, union, supported)

    def _check_discriminator(self, where, kind):
        if constants.integers(kind) or _discrete(kind):
            return True
        self._error(where, "a union is switched by a whole number, a character, a boolean or an enumeration")
        return False

    def _case(self, union, tree, taken, used, hashed):
        noted = [child for child in tree.children if child.data == "annotations"]
        labels = [child for child in tree.children if child.data in ("label", "default_label")]
        kind, declarator = tree.children[-2:]
        found = [self._label(union, label, used) for label in labels]
        base = self._type_or_definition(kind)
        name = scopes.plain(declarator.children[1])
        self._check_member(declarator, name, union)
        if name == "_d":
            raise constants.Fault(declarator, "'_d' is the discriminator's name in JSON; give the member another")
        notes = self._read_annotations("case", *noted)
        built = base and self._with_sizes(base, declarator)
        built = built and self._complete(kind, built, notes.has("external"))
        if built is None:
            return False
        cpp_name = names.unique(name, self._reserved_in(union), taken)
        while f"holds_{cpp_name}" in taken:
            cpp_name = names.unique(cpp_name + "_", self._reserved_in(union), taken)
        taken.add(f"holds_{cpp_name}")
        case = model.Case(
            name,
            cpp_name,
            built,
            found,
            self._place(declarator),
            documentation=self._documentation(declarator) or self._documentation(kind) or self._documentation(tree),
            annotations=notes,
            id=self._member_id(union, declarator.children[1], notes, hashed, first=1, least=int(union.extensibility == "mutable")),
        )
        union.cases.append(case)
        return True

    @staticmethod
    def _reserved_in(union):
        return names.UNION_MEMBER | {names.plain(each.scope[-1]) for each in union.nested} | {union.cpp_name}

    def _label(self, union, label, used):
        value = None if label.data == "default_label" else self._label_value(label.children[0], union.discriminator)
        if value in used:
            said = "default" if value is None else value
            raise constants.Fault(label, f"there is a case {said} already, at {self._place(used[value])}")
        used[value] = label
        return value

    def _label_value(self, tree, kind):
        plain = model.unaliased(kind)
        if isinstance(plain, model.Named) and tree.data == "relative_name" and len(tree.children) == 1:
            if any(idl == tree.children[0] for idl, _, _ in plain.decl.enumerators):
                return str(tree.children[0])
        return constants.value(tree, kind, self._resolve)

    def _default(self, union, used):
        """The value by which the default is selected: the first that no case has."""
        case = next((case for case in union.cases if None in case.labels), None)
        if case is None:
            return
        case.default_value = next((value for value in _values(union.discriminator) if value not in used), None)
        if case.default_value is not None:
            return
        place = self._place(used[None])
        if place.file == self.source.path:
            self.report.warning(place, f"the default of {union.idl_name} can never be chosen, as every value has its own case, and is left out")
        case.labels.remove(None)
        if not case.labels:
            union.cases.remove(case)


def _discrete(kind):
    kind = model.unaliased(kind)
    return kind.decl if isinstance(kind, model.Named) and isinstance(kind.decl, model.Enum) else (
        kind if isinstance(kind, model.Primitive) and kind.idl in ("boolean", "char", "wchar") else None)  # fmt: skip


def _values(kind):
    """The values of a discriminator, in the order in which a default takes them."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Named):
        return [idl for idl, _, _ in kind.decl.enumerators]
    if kind.idl == "boolean":
        return [False, True]
    if kind.idl in ("char", "wchar"):
        return map(chr, range(255, -1, -1))
    least, greatest = constants.integers(kind)
    return range(least, greatest + 1) if least else range(greatest, -1, -1)
