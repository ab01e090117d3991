"""Interfaces, their operations and attributes."""

import model
import names

from . import constants, scopes


class Interfaces:
    """The part of the builder that makes interfaces of the model."""

    def _interface_forward(self, tree, noted):
        kind, name = tree.children
        if kind.data != "plain":
            return self._not_travelling(name, kind.data, f"{kind.data} interface")
        self._announced_interface(name, tree)

    def _announced_interface(self, name, tree):
        """The interface of that name, which may be only announced so far."""
        found = self._scope.names.get(scopes.plain(name))
        if found and isinstance(found.what, model.Interface):
            return found.what
        decl = self._declare(model.Interface, name, tree, defined=False)
        found = self._scope.names[scopes.plain(name)]
        found.scope = scopes.Scope(scopes.plain(name), self._scope)
        return decl

    def _interface(self, tree, noted):
        kind, name, bases, *exports = tree.children
        if kind.data != "plain":
            return self._not_travelling(name, kind.data, f"{kind.data} interface")
        interface = self._announced_interface(name, tree)
        if interface.defined:
            raise constants.Fault(name, f"'{scopes.plain(name)}' is declared twice in one scope, first at {interface.place}")
        self._span(name, tree)
        interface.place = self._place(name)
        interface.in_main_file = interface.place.file == self.source.path
        interface.documentation = self._documentation(tree) or interface.documentation
        interface.defined = True
        outer, self._scope = self._scope, self._scope.names[scopes.plain(name)].scope
        for base in bases.children if bases else []:
            self._base(interface, base)
        self._contents(interface, exports)
        self._scope = outer
        self.all_items.append(interface)
        if interface.in_main_file:
            self.items.append(interface)
            self.interfaces.append(interface)

    def _base(self, interface, tree):
        found = self._usable(tree, self._symbol(tree), "be a base")
        if found is None:
            return
        if not isinstance(found.what, model.Interface) or not found.what.defined or found.what is interface:
            return self._error(tree, f"the base of {interface.idl_name} must be an interface that is defined before it")
        if found.what in interface.bases:
            return self._error(tree, f"{found.what.idl_name} is a base twice")
        interface.bases.append(found.what)
        self._scope.bases.append(found.scope)

    def _contents(self, interface, exports):
        calls = [export for export in exports if _is_call(export)]
        self._known[interface] = scopes.Declared()
        self._outer.append(interface)
        self._each(export for export in exports if not _is_call(export))
        self._outer.pop()
        taken = {decl.scope[-1] for decl in interface.nested} | {interface.cpp_name}
        plain = {name for call in calls for name in _names(call.children[1])}  # and the names of asynchronous calls
        for export in calls:
            noted, call = export.children
            build = self._operation if call.data == "operation" else self._attribute
            try:
                build(interface, call, export, self._read_annotations(call.data, noted), taken, plain)
            except constants.Fault as fault:
                self._fault(fault)
        self._check_inherited(interface)

    def _check_inherited(self, interface):
        seen = {}
        for operation in interface.all_operations():
            other = seen.setdefault(operation.name, operation)
            if other is not operation:
                plain = operation.name.removeprefix("_get_").removeprefix("_set_")
                mine = other if other.interface is interface else interface
                known = f"{operation.interface.idl_name}::{plain}"
                self.report.error(mine.place, f"'{plain}' is declared already, as {known} at {operation.place}; IDL has no overloading, name it otherwise")

    def _operation(self, interface, tree, export, noted, taken, plain):
        oneway, kind, token, given, raises, context = tree.children
        name = scopes.plain(token)
        self._warn_of_case(token, name, self._known[interface])
        if context is not None:
            self._error(context, "context clauses are not supported: pass what they carry as a parameter")
        result = None if kind.data == "void" else self._type(kind)
        used, declared = set(), scopes.Declared()
        parameters = [self._parameter(parameter, used, declared) for parameter in (given.children if given else [])]
        operation = model.Operation(
            name=name,
            cpp_name=names.unique(name, names.OPERATION, taken),
            async_name=_async_name(name, plain),
            result=result,
            parameters=parameters,
            raises=self._raises(raises),
            oneway=oneway is not None or noted.has("oneway"),
            idempotent=noted.has("idempotent"),
            stream=noted.has("stream"),
            optional=noted.has("optional"),
            by_default=self._by_default(noted),
            documentation=self._documentation(tree, export),
            place=self._place(token),
            interface=interface,
            annotations=noted,
        )
        if operation.oneway and (kind.data != "void" or raises or any(p.is_out for p in parameters)):
            self._error(token, f"'{name}' is oneway, so that nothing can come back: no result, no out parameter, no exception")
        if operation.oneway and operation.idempotent:
            self._warn(noted.find("idempotent").token, f"'@idempotent' has no effect on '{name}', which is oneway: without an answer nothing is repeated")
        interface.operations.append(operation)

    def _by_default(self, noted):
        """The name in `@stream(by_default = "plan")`."""
        stream = noted.find("stream")
        given = stream and stream.arguments.get("by_default")
        return str(constants.value(given, model.String(0), self._resolve)) if given else None

    def _parameter(self, tree, used, declared):
        *around, kind, token = tree.children
        for each in around:
            if each is not None and each.data == "annotations":
                self._read_annotations("parameter", each)
        direction = next((each.data for each in around if each is not None and each.data != "annotations"), "in")
        name = scopes.plain(token)
        if name in used:
            raise constants.Fault(token, f"there is a parameter '{name}' already")
        self._warn_of_case(token, name, declared)
        built = self._type(kind)
        if built is not None:
            built = self._complete(kind, built, apart=False)
        return model.Parameter(name, names.unique(name, names.PARAMETER, used), built, direction)

    def _raises(self, tree):
        found = []
        for each in tree.children if tree else []:
            symbol = self._usable(each, self._symbol(each), "be raised")
            if symbol is None:
                continue
            if not isinstance(symbol.what, model.Exception_):
                self._error(each, f"'{'::'.join(each.children)}' is no exception")
            elif symbol.what not in found:
                found.append(symbol.what)
        return found

    def _attribute(self, interface, tree, export, noted, taken, plain):
        readonly, kind, declarators, raises, get_raises, set_raises = tree.children
        built = self._type(kind)
        documentation = self._documentation(tree, export)
        for declarator in declarators.children:
            name = scopes.plain(declarator.children[1])
            self._warn_of_case(declarator, name, self._known[interface])
            if len(declarator.children) > 3:
                raise constants.Fault(declarator, f"the attribute '{name}' cannot be an array; give the array a name by typedef, and use that")
            shared = dict(
                cpp_name=names.unique(name, names.OPERATION, taken),
                async_name=_async_name(name, plain),
                oneway=False,
                idempotent=noted.has("idempotent"),
                stream=noted.has("stream"),
                optional=noted.has("optional"),
                documentation=documentation,
                place=self._place(declarator),
                interface=interface,
                annotations=noted,
            )
            both = self._raises(raises)
            get = both + self._raises(get_raises)
            interface.operations.append(model.Operation(name="_get_" + name, result=built, parameters=[], raises=get, **shared))
            if readonly is None:
                value = model.Parameter("value", "value", built, "in")
                put = both + self._raises(set_raises)
                interface.operations.append(model.Operation(name="_set_" + name, result=None, parameters=[value], raises=put, **shared))


def _is_call(export):
    return export.children[1].data in ("operation", "attribute")


def _names(call):
    if call.data == "operation":
        return [scopes.plain(call.children[2])]
    return [scopes.plain(declarator.children[1]) for declarator in call.children[2].children]


def _async_name(name, plain):
    return names.unique("async_" + name, names.OPERATION, plain)
