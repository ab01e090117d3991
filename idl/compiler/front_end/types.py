"""Types where they are used."""

import model
from report import nearest

from . import annotations, constants, scopes

_PRIMITIVES = {
    "boolean": "boolean",
    "char": "char",
    "wchar": "wchar",
    "int8": "int8",
    "octet": "octet",
    "short": "short",
    "unsigned_short": "unsigned short",
    "long": "long",
    "unsigned_long": "unsigned long",
    "long_long": "long long",
    "unsigned_long_long": "unsigned long long",
    "float": "float",
    "double": "double",
    "long_double": "long double",
}

_REFUSED = {
    "fixed": "fixed is not supported: DDS has no such type; use double, or long long with a documented unit",
    "any": "any is not supported: its type would not be known to the reader; use a union of the types that occur",
    "object": "Object is not supported: a reference names its interface; use the interface as the type",
    "value_base": "ValueBase is not supported: objects do not travel by value; use a struct",
}
_LARGE_ARRAY = 64 << 20  # bytes
_BOOLEANS = {"true": True, "True": True, "false": False, "False": False}
_NO_TYPE = {model.Constant: "a constant", model.Exception_: "an exception", scopes.Enumerator: "an enumerator", scopes.Flag: "a bit", type(None): "a module"}


class Types:
    """The part of the builder that makes types of the model; None, with an error, of what is not supported."""

    def _type_or_definition(self, tree):
        """A type that is used, or declared where it is used."""
        if tree.data not in ("struct", "union", "enum"):
            return self._type(tree)
        name = tree.children[0]
        lenient, self._lenient = self._lenient, False
        getattr(self, "_" + tree.data)(tree, annotations.Annotations())
        self._lenient = lenient
        return self._declared(name, self._scope.names[scopes.plain(name)])

    def _type(self, tree):
        if tree.data in _PRIMITIVES:
            return model.Primitive(_PRIMITIVES[tree.data])
        if tree.data in _REFUSED:
            return self._unusable(tree, _REFUSED[tree.data], scopes.Cause(self._place(tree), _REFUSED[tree.data]))
        if tree.data in model.TEMPLATES:
            return self._template(model.TEMPLATES[tree.data], tree.children)
        return self._declared(tree, self._symbol(tree))

    def _template(self, template, given):
        """`given` are its types, then its bounds."""
        elements = [each for each in given if _is(each, "element")]
        for each in elements:
            self._read_annotations("element", each.children[0])
        built = [self._type(each.children[1]) for each in elements]
        if None in built:
            return None
        if template is model.Map and not _may_be_key(built[0]):
            return self._error(elements[0], "the key of a map is a number, a character, text, a boolean or an enumeration")
        return template(*built, *(self._bound(each) for each in given[len(elements) :]))

    def _bound(self, tree):
        return constants.size(tree, self._resolve_size) if tree is not None else 0

    def _with_sizes(self, kind, declarator):
        """The type with the sizes of an array that stand behind its name."""
        if declarator.children[2].children and not _is(declarator.children[-1], "dimension"):
            raise constants.Fault(declarator.children[2], "an annotation stands before what it is about, not behind")
        sizes = [constants.size(child.children[0], self._resolve_size) for child in declarator.children if _is(child, "dimension")]
        for size in reversed(sizes):
            kind = model.Array(kind, size)
        if sizes:
            self._check_array(declarator, model.least_bytes(kind))
        return kind

    def _check_array(self, declarator, size):
        """A value holds its arrays itself, full or not."""
        if size > _LARGE_ARRAY:
            beyond = " (a message has less than 2048)" if size >= 1 << 31 else ""
            self._warn(declarator, f"this array takes {size >> 20} MiB{beyond} in every value and every message; use a sequence, which takes what it holds")

    def _symbol(self, tree, remedy=""):
        """What a scoped name stands for; None, with an error, where it is unknown."""
        parts = [scopes.plain(token) for token in tree.children]
        found, reason = self._scope.find(parts, tree.data == "absolute_name")
        if found is None:
            self._error(tree, "" if self._quiet else self._further_down(tree, parts[-1]) or self._with_hint(tree, parts[-1], reason, remedy))
        return found

    def _further_down(self, tree, name):
        """What is wrong where a name is used before it is declared; empty where it is declared nowhere."""
        later = next((token for token in self._declared_names.get(name, []) if token.start_pos > self._offset(tree)), None)
        if later is None:
            return ""
        return f"'{name}' is declared further down, at {self._place(later)}; move its declaration up, before its first use"

    def _with_hint(self, tree, name, reason, remedy):
        if "did you mean" in reason:
            return reason
        if "; write " in reason or len(tree.children) > 1:
            return reason + remedy
        later = {known: token for known, tokens in self._declared_names.items() for token in tokens[-1:] if token.start_pos > self._offset(tree)}
        near = nearest(name, later)
        return f"{reason} (did you mean '{near}', which is declared further down, at {self._place(later[near])}?)" if near else reason + remedy

    def _resolve_size(self, tree):
        return self._resolve(tree, f"; a size is a number or a constant: const unsigned long {scopes.plain(tree.children[-1])} = 10;")

    def _resolve(self, tree, remedy=""):
        """What a name in a constant expression stands for. `true` and `false`, which IDL writes in capitals, are taken, too."""
        spelled = _BOOLEANS.get(str(tree.children[0])) if len(tree.children) == 1 else None
        if spelled is not None and self._scope.find([str(tree.children[0])], False)[0] is None:
            place = self._place(tree)
            if place.file == self.source.path:
                self.report.warning(place, f"IDL writes {str(spelled).upper()}")
            return spelled
        found = self._symbol(tree, remedy)
        if found is None or (isinstance(found.what, scopes.LeftOut) and found.what.told):
            raise constants.Fault(tree, "")
        if isinstance(found.what, scopes.LeftOut):
            raise constants.Fault(tree, f"{_spoken(tree)} cannot be used, see {found.what.cause.seen_from(self._place(tree).file)}")
        if isinstance(found.what, (model.Constant, scopes.Enumerator, scopes.Flag)):
            return found.what
        raise constants.Fault(tree, f"'{_spoken(tree)}' is no constant")

    def _usable(self, tree, found, use):
        """The declaration behind a symbol; None, with an error, where it was refused or lies in a refused file."""
        if found is None:
            return None
        here = self._place(tree).file
        if isinstance(found.what, scopes.LeftOut):
            cause = found.what.cause
        elif found.place.file != here and found.place.file in self.broken:
            cause = self.broken[found.place.file]
        else:
            return found
        name = found.what.idl_name if isinstance(found.what, model.Declaration) else _spoken(tree)
        return self._unusable(tree, f"{name} cannot {use}, see {cause.seen_from(here)}" if cause else "", cause)

    def _unusable(self, tree, reason, cause):
        if self._lenient:
            self._reason, self._cause = reason, cause
        else:
            self._fail(tree, reason, cause)

    def _declared(self, tree, found):
        found = self._usable(tree, found, "be used")
        if found is None:
            return None
        if type(found.what) in _NO_TYPE:
            return self._error(tree, f"'{_spoken(tree)}' is {_NO_TYPE[type(found.what)]}, no type")
        return model.Reference(found.what) if isinstance(found.what, model.Interface) else model.Named(found.what)


def _may_be_key(kind):
    kind = model.unaliased(kind)
    if isinstance(kind, model.Primitive):
        return kind.idl not in ("float", "double", "long double")
    return isinstance(kind, (model.String, model.WideString)) or (isinstance(kind, model.Named) and isinstance(kind.decl, model.Enum))


def _is(child, name):
    return getattr(child, "data", None) == name


def _parts(tree):
    return [str(token) for token in getattr(tree, "children", [tree])]


def _spoken(tree):
    return "::".join(_parts(tree))
