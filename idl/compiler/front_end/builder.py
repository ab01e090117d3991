"""From the syntax tree to the model: modules, constants, types. Every refusal of unsupported IDL happens in this folder."""

import lark

import model
import names

from . import annotations, comments, constants, scopes
from .enumerations import Enumerations
from .interfaces import Interfaces
from .structures import Structures
from .types import Types

_NOT_TRAVELLING = {
    "native": "it has no form on the wire",
    "local": "nothing of it travels; write a C++ class",
    "abstract": "it may stand for an object that travels by value; use an ordinary interface or a struct",
    "valuetype": "objects do not travel by value; use a struct",
    "boxed valuetype": "objects do not travel by value; use @optional, or a sequence with a bound of 1, for what may be absent",
}
_REFUSED = {
    "component": "components are not supported: an entity is written in C++; use its interfaces",
    "component_forward": "components are not supported: an entity is written in C++; use its interfaces",
    "home": "homes are not supported: they make components; use an interface",
    "connector": "connectors are not supported: they belong to components; use an interface",
    "port_type": "port types are not supported: they belong to components; use an interface",
    "template_module": "template modules are not supported: write out the module for each of its arguments",
    "template_instance": "template modules are not supported: write out the module for each of its arguments",
}

# A class has no member of its own name.
_MEMBERS = {model.Union: names.UNION_MEMBER, model.Exception_: names.EXCEPTION_MEMBER, model.Interface: names.OPERATION}


class Builder(Types, Structures, Enumerations, Interfaces):
    """`items` are the main file's declarations in order, `declarations` all by their scoped names."""

    def __init__(self, source, report, quiet, namespace=()):
        """`namespace` is the C++ one around all; `quiet`: something could not be read, so that a name that is not known is no finding."""
        self.source = source
        self.report = report
        self.items = []
        self.all_items = []  # of included files, too
        self.interfaces = []
        self.declarations = {}
        self.broken = {}  # file -> cause of its first refusal
        self.declaring = set()  # files that declare something
        self._quiet = quiet
        self._namespace = namespace
        self._comments = comments.Comments(source)
        self._scope = self.root = scopes.Scope()
        self._modules = ()
        self._openings = ()  # see model.Declaration
        self._opened = {}  # file, modules, openings: how often
        self._hashed = False  # by @autoid of an enclosing module
        self._outer = []  # enclosing structs, unions, interfaces
        self._cause = None  # of the last refusal
        self._lenient = False  # what cannot be used is no error here
        self._reason = None  # why it cannot
        self._annotations = {}  # declared ones, and unknown ones of which it was said
        self._spans = []  # of what holds names: begin, end, path
        self._known = {}  # what structs, exceptions, unions and interfaces have declared
        self._forwards = {}  # structs and unions that are not defined yet: place
        self._read = set()  # places and texts of declarations

    def build(self, tree):
        self._declared_names = _declared_names(tree)
        self._each(tree.children)
        for decl, place in self._forwards.items():
            if decl.in_main_file and not self._quiet:
                self.report.error(place, f"{decl.idl_name} is announced here and defined nowhere")

    def announced(self):
        """Every interface that is known, so that references to it can be written."""
        return [decl for decl in self.declarations.values() if isinstance(decl, model.Interface)]

    def _each(self, trees):
        for tree in trees:
            if tree.data == "template_module":
                self._refuse(tree.children[1], _REFUSED["template_module"])
                continue
            noted, declared = tree.children
            if self._was_read(declared):
                continue
            scope, depth, modules, openings = self._scope, len(self._outer), self._modules, self._openings
            try:
                getattr(self, "_" + declared.data, self._refused)(declared, self._read_annotations(declared.data, noted))
            except constants.Fault as fault:
                self._fault(fault)
                self._scope, self._modules, self._openings = scope, modules, openings
                del self._outer[depth:]
                self._abandon(declared)

    def _was_read(self, tree):
        """Whether this very declaration comes again, from a file that is included twice and has nothing against that."""
        if tree.meta.empty:
            return False
        self.declaring.add(self._place(tree).file)
        seen = (self._place(tree), self.source.text[tree.meta.start_pos : tree.meta.end_pos])
        if seen in self._read:
            return True
        if self._place(tree).file != self.source.path:
            self._read.add(seen)
        return False

    def _abandon(self, tree):
        """Leaves out a struct or a union that was half defined."""
        name = tree.children[0] if tree.children else None
        found = self._scope.names.get(scopes.plain(name)) if isinstance(name, lark.Token) else None
        if found and found.what in self._forwards:
            self._finish(name, found.what, supported=False)

    # ---- places, findings and annotations

    def _offset(self, where):
        if isinstance(where, lark.Token):
            return where.start_pos
        return None if where.meta.empty else where.meta.start_pos

    def _place(self, where):
        return self.source.place(self._offset(where))

    def _fault(self, fault):
        self._error(fault.where, fault.reason)

    def _error(self, where, reason):
        """Of an included file, only what is used matters; it has no output that could be included, though."""
        self._fail(where, reason, scopes.Cause(self._place(where), reason))

    def _fail(self, where, reason, cause):
        place = self._place(where)
        self._cause = cause
        self.broken.setdefault(place.file, cause)
        if place.file == self.source.path and reason:
            self.report.error(place, reason)

    def _refuse(self, name, reason):
        """Refuses a declaration; uses of it are refused as well."""
        self._error(name, reason)
        self._leave_out(name)

    def _leave_out(self, name, told=False):
        """Of what `name` declares, whose cause was found a moment ago, nothing is generated."""
        self._scope.names[scopes.plain(name)] = scopes.Symbol(scopes.LeftOut(self._cause, told), self._place(name))

    def _read_annotations(self, kind, *trees):
        """Those of a declaration of this kind."""
        found = annotations.Annotations(*trees)
        for each in found:
            name = each.name
            said = annotations.check(each, self._annotations)
            if said and self._place(each.token).file == self.source.path:
                if each.name == name:  # once
                    self._annotations[name] = True
                self.report.warning(self._place(each.token), said)
            value = each.arguments.get("value")
            if each.name in annotations.FLAGS and value is not None:
                each.off = not constants.value(value, model.Primitive("boolean"), self._resolve)
            if said := annotations.misplaced(each, kind):
                self._warn(each.token, said)
        return found

    def _warn(self, where, reason):
        """Of the main file alone."""
        if self._place(where).file == self.source.path:
            self.report.warning(self._place(where), reason)

    def _by_hash(self, noted):
        """Whether members have the hashes of their names as identifiers: HASH is what @autoid says without an argument, and what it says
        of a module holds for the types in it (DDS-XTypes 1.3, 7.3.1.2.1.1)."""
        given = noted.find("autoid")
        if given is None:
            return self._hashed
        value = given.arguments.get("value")
        return value is None or "HASH" in annotations.written(value)

    def scope_at(self, offset):
        """The path of the innermost module, interface or struct around an offset."""
        around = [(begin, path) for begin, end, path in self._spans if begin <= offset < end]
        return max(around)[1] if around else ()

    def _documentation(self, *where):
        """The comments above the first of these trees that has any."""
        offsets = [offset for each in where if (offset := self._offset(each)) is not None]
        return next((lines for offset in offsets if (lines := self._comments.above(offset))), [])

    # ---- names

    def _enter(self, name, outer):
        self._scope, scope = scopes.Scope(scopes.plain(name), self._scope), self._scope
        scope.names[scopes.plain(name)].scope = self._scope
        if outer is not None:
            self._outer.append(outer)
        return scope

    def _leave(self, scope, outer):
        self._scope = scope
        if outer is not None:
            self._outer.pop()

    def _span(self, name, tree):
        self._spans.append((tree.meta.start_pos, tree.meta.end_pos, self._scope.path + (scopes.plain(name),)))

    def _declare(self, kind, name, tree, **fields):
        """A new declaration, known from here on."""
        plain = scopes.plain(name)
        path = self._scope.path + (plain,)
        place = self._place(name)
        self._check_free(name, plain)
        decl = kind(
            place=place,
            scope=path,
            namespace=self._namespace + tuple(names.plain(module) for module in self._modules),
            cpp_name=names.plain("_".join(path[len(self._modules) :]), names.NAMESPACE | _MEMBERS.get(kind, frozenset())),
            documentation=self._documentation(tree),
            in_main_file=place.file == self.source.path,
            modules=self._modules,
            openings=self._openings,
            **fields,
        )
        self.declarations[path] = decl
        self._scope.names[plain] = scopes.Symbol(decl, place)
        return decl

    def _warn_of_case(self, where, name, declared):
        """IDL takes names that differ in case alone for one (7.2.3), and so do compilers for languages that do. Files of others have such names
        all the same (constants beside types, members `x` and `X`), and idlc and fastddsgen read them when told to: a warning."""
        place = self._place(where)
        declared_before = declared.in_other_letters(name)
        declared.add(name, place)
        if declared_before and place.file == self.source.path:
            other, first = declared_before
            self.report.warning(place, f"'{name}' and '{other}', at {first}, are one name in IDL, where case does not count: other compilers may refuse them; "
                                "rename one")  # fmt: skip

    def _check_free(self, name, plain):
        found = self._scope.names.get(plain)
        self._warn_of_case(name, plain, self._scope.declared)
        if found is not None and not isinstance(found.what, scopes.LeftOut):
            raise constants.Fault(name, f"'{plain}' is declared twice in one scope, first at {found.place}")

    def _add(self, decl):
        """Joins what is generated; also known to what encloses it, which keeps an alias."""
        if self._outer:
            self._outer[-1].nested.append(decl)
        self.all_items.append(decl)
        if decl.in_main_file:
            self.items.append(decl)

    # ---- declarations

    def _module(self, tree, noted):
        name, *definitions = tree.children
        plain = scopes.plain(name)
        self._span(name, tree)
        found = self._scope.names.get(plain)
        if found is None or found.what is not None:
            self._check_free(name, plain)
            found = self._scope.names[plain] = scopes.Symbol(None, self._place(name), scopes.Scope(plain, self._scope))
        self._scope, scope = found.scope, self._scope
        hashed, self._hashed = self._hashed, self._by_hash(noted)
        self._modules += (plain,)
        opened = (self._place(name).file, self._modules, self._openings)
        self._opened[opened] = self._opened.get(opened, 0) + 1
        self._openings += (self._opened[opened],)
        self._each(definitions)
        self._modules, self._openings = self._modules[:-1], self._openings[:-1]
        self._hashed = hashed
        self._scope = scope

    def _const(self, tree, noted):
        kind, name, expression = tree.children
        built = self._type(kind)
        if built is None:
            return self._leave_out(name)
        try:
            found = constants.value(expression, built, self._resolve)
        except constants.Fault as fault:
            self._fault(fault)
            return self._leave_out(name, told=True)
        self._add(self._declare(model.Constant, name, tree, type=built, value=found))

    def _typedef(self, tree, noted):
        kind, declarators = tree.children
        self._reason, self._lenient = None, True
        try:
            base = self._type_or_definition(kind)
        finally:
            self._lenient = False
        for declarator in declarators.children:
            name = declarator.children[1]
            built = base and self._with_sizes(base, declarator)
            if self._is_again(name, built):
                continue
            if built is None:
                self._pass_over(name, f"the typedef {scopes.plain(name)} is left out: {self._reason}", self._cause)
                continue
            decl = self._declare(model.Typedef, name, tree, type=built)
            decl.documentation = self._documentation(declarator) or decl.documentation
            self._add(decl)

    def _is_again(self, name, built):
        """Whether a typedef says what another one has said."""
        found = self._scope.names.get(scopes.plain(name))
        return found is not None and isinstance(found.what, model.Typedef) and found.what.type == built

    def _native(self, tree, noted):
        self._not_travelling(tree.children[0], "native", "native")

    def _value(self, tree, noted):
        self._not_travelling(_name(tree), "valuetype", "valuetype")

    _value_forward = _value

    def _value_box(self, tree, noted):
        self._not_travelling(_name(tree), "boxed valuetype", "boxed valuetype")

    def _not_travelling(self, name, kind, spoken):
        cause = scopes.Cause(self._place(name), _NOT_TRAVELLING[kind])
        self._pass_over(name, f"the {spoken} {scopes.plain(name)} is left out: {_NOT_TRAVELLING[kind]}", cause)

    def _pass_over(self, name, said, cause):
        """Leaves out, with a warning, what matters only where it is used."""
        self._cause = cause
        self._leave_out(name)
        place = self._place(name)
        if place.file == self.source.path and self._reason != "":
            self.report.warning(place, said)

    def _annotation_declaration(self, tree, noted):
        self._annotations[str(tree.children[1])] = True

    def _type_prefix(self, tree, noted):
        """CORBA's repository identifiers, which are not used here."""

    _type_id = _import = _type_prefix

    def _refused(self, tree, noted):
        self._refuse(_name(tree), _REFUSED[tree.data])


# Of a declaration, the tokens that are the names which it declares.
_DECLARING = frozenset("const struct union enum bitset bitmask exception interface module".split())


def _declared_names(tree):
    """The names of all declarations, and the tokens where they stand."""
    found = {}
    for each in tree.iter_subtrees():
        if each.data in _DECLARING:
            tokens = [child for child in each.children if getattr(child, "type", "") == "IDENTIFIER"][:1]
        elif each.data == "typedef":
            tokens = [declarator.children[1] for declarator in each.children[1].children]
        else:
            continue
        for token in tokens:
            found.setdefault(scopes.plain(token), []).append(token)
    return found


def _name(tree):
    """What a declaration declares."""
    return next(each for each in tree.scan_values(lambda token: token.type == "IDENTIFIER"))
