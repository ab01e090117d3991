"""From omniidl's syntax tree to the model. Every refusal of unsupported IDL happens here."""

from omniidl import idlast, idltype, idlvisitor

from . import comments, model, names

_PRIMITIVES = {
    idltype.tk_boolean: "boolean",
    idltype.tk_char: "char",
    idltype.tk_octet: "octet",
    idltype.tk_short: "short",
    idltype.tk_ushort: "unsigned short",
    idltype.tk_long: "long",
    idltype.tk_ulong: "unsigned long",
    idltype.tk_longlong: "long long",
    idltype.tk_ulonglong: "unsigned long long",
    idltype.tk_float: "float",
    idltype.tk_double: "double",
}

_REFUSED = {
    idltype.tk_wchar: "wchar is not supported: DDS vendors disagree on its size; use string (UTF-8) or unsigned long",
    idltype.tk_wstring: "wstring is not supported: DDS vendors disagree on its encoding; use string, which carries UTF-8",
    idltype.tk_longdouble: "long double is not supported: its format differs between machines; use double",
    idltype.tk_fixed: "fixed is not supported: DDS has no such type; use long long with a documented unit",
    idltype.tk_any: "any is not supported: its type would not be known to the reader; use a union of the types that occur",
    idltype.tk_TypeCode: "TypeCode is not supported: there are no types at run time; use a string that names the type",
    idltype.tk_Principal: "Principal is not supported: it belongs to CORBA's security; use a string",
    idltype.tk_value: "valuetype is not supported: objects do not travel by value; use a struct",
    idltype.tk_value_box: "boxed valuetypes are not supported: use a sequence with a bound of 1 for what may be absent",
    idltype.tk_native: "native is not supported: it has no form on the wire; use a type of IDL",
    idltype.tk_abstract_interface: "abstract interfaces are not supported: use an ordinary interface or a struct",
    idltype.tk_local_interface: "local interfaces are not supported: nothing of them travels; write a C++ class",
}
_VALUE_BASE = "ValueBase is not supported: objects do not travel by value; use a struct"
_OBJECT = "Object is not supported: a reference names its interface; use the interface as the type"


class Builder(idlvisitor.AstVisitor):
    def __init__(self, report):
        self.report = report
        self.items = []
        self.interfaces = []
        self._built = {}  # scoped name -> Declaration
        self._unsupported = {}  # scoped name -> where the cause stands
        self._modules = ()
        self._outer = []  # enclosing structs, unions, interfaces
        self._cause = None  # place of the last refusal
        self.broken = {}  # file -> place of its first refusal

    def build(self, tree):
        for decl in tree.declarations():
            decl.accept(self)

    def announced(self):
        """Every interface that is known, so that references to it can be written."""
        return [decl for decl in self._built.values() if isinstance(decl, model.Interface)]

    # ---- places and names

    def _declare(self, kind, node, **fields):
        scope = tuple(node.scopedName())
        namespace = tuple(names.plain(module) for module in self._modules)
        cpp_name = names.plain("_".join(scope[len(self._modules) :]))
        decl = kind(
            place=(node.file(), node.line()),
            scope=scope,
            namespace=namespace,
            cpp_name=cpp_name,
            documentation=comments.documentation(node),
            in_main_file=bool(node.mainFile()),
            modules=self._modules,
            **fields,
        )
        self._built[scope] = decl
        return decl

    def _add(self, decl):
        """Joins what is generated; also known to what encloses it, which keeps an alias."""
        if self._outer:
            self._outer[-1].nested.append(decl)
        if decl.in_main_file:
            self.items.append(decl)

    def _refuse(self, node, reason):
        """Refuses a declaration; uses of it are refused as well."""
        self._error(node, reason)
        self._unsupported[tuple(node.scopedName())] = self._cause

    def _error(self, node, reason):
        self._fail(node, reason, (node.file(), node.line()))

    def _fail(self, node, reason, cause):
        """Of an included file, only what is used matters; it has no output that could be included, though."""
        self._cause = cause
        self.broken.setdefault(node.file(), cause)
        if node.mainFile():
            self.report.error((node.file(), node.line()), reason)

    def _find(self, node, scope, use):
        """The declaration that `node` uses; None, and an error, where it was refused or lies in a refused file."""
        decl = self._built.get(scope)
        if decl and (decl.place[0] == node.file() or decl.place[0] not in self.broken):
            return decl
        cause = self._unsupported.get(scope) or self.broken[decl.place[0]]
        self._fail(node, f"{'::'.join(scope)} cannot {use}, see {self.report.where(cause)}", cause)
        return None

    # ---- types

    def _type(self, node, kind, sizes=None):
        """The model of an omniidl type; None, and an error at `node`, where it is not supported."""
        built = self._plain_type(node, kind)
        for size in reversed(sizes or []):
            built = built and model.Array(built, size)
        return built

    def _plain_type(self, node, kind):
        code = kind.kind()
        if code in _PRIMITIVES:
            return model.Primitive(_PRIMITIVES[code])
        if code == idltype.tk_string:
            return model.String(kind.bound())
        if code == idltype.tk_sequence:
            element = self._plain_type(node, kind.seqType())
            return element and model.Sequence(element, kind.bound())
        if isinstance(kind, idltype.Declared):
            return self._declared_type(node, kind)
        return self._error(node, _REFUSED[code])

    def _declared_type(self, node, kind):
        scope = tuple(kind.scopedName())
        if scope in (("CORBA", "Object"), ("Object",)):
            return self._error(node, _OBJECT)
        if scope == ("CORBA", "ValueBase"):
            return self._error(node, _VALUE_BASE)
        if scope in self._unsupported:
            return self._find(node, scope, "be used")
        if kind.kind() in _REFUSED:
            return self._error(node, _REFUSED[kind.kind()])
        if kind.kind() == idltype.tk_objref:
            self._interface(kind.decl())
            decl = self._find(node, scope, "be used")
            return decl and model.Reference(decl)
        decl = self._find(node, scope, "be used")
        return decl and model.Named(decl)

    def _interface(self, node):
        """The interface, which may be only forward-declared so far."""
        scope = tuple(node.scopedName())
        if scope not in self._built:
            modules, self._modules = self._modules, scope[:-1]
            self._declare(model.Interface, node, defined=False)
            self._modules = modules
        return self._built[scope]

    # ---- declarations

    def visitModule(self, node):
        self._modules += (node.identifier(),)
        for decl in node.definitions():
            decl.accept(self)
        self._modules = self._modules[:-1]

    def visitForward(self, node):
        if node.abstract() or node.local():
            self._refuse_interface(node)
        else:
            self._interface(node)

    def _refuse_interface(self, node):
        kind = idltype.tk_abstract_interface if node.abstract() else idltype.tk_local_interface
        self._refuse(node, _REFUSED[kind])

    def visitInterface(self, node):
        if node.abstract() or node.local():
            return self._refuse_interface(node)
        forward = self._built.get(tuple(node.scopedName()))
        if forward is None:
            interface = self._declare(model.Interface, node)
        else:
            interface = forward
            interface.place, interface.in_main_file = (node.file(), node.line()), bool(node.mainFile())
            interface.documentation = comments.documentation(node) or interface.documentation
        interface.defined = True
        for base in node.inherits():
            scope = tuple(base.scopedName())
            if built := self._find(node, scope, "be a base"):
                interface.bases.append(built)
        self._contents(node, interface)
        if interface.in_main_file:
            self.items.append(interface)
            self.interfaces.append(interface)

    def _contents(self, node, interface):
        self._outer.append(interface)
        for decl in node.declarations():
            decl.accept(self)
        self._outer.pop()
        taken = {decl.scope[-1] for decl in interface.nested}
        plain = {call.identifier() for call in node.callables() if isinstance(call, idlast.Operation)}
        plain |= {name for call in node.callables() if isinstance(call, idlast.Attribute) for name in call.identifiers()}
        for call in node.callables():
            if isinstance(call, idlast.Operation):
                self._operation(call, interface, taken, plain)
            else:
                self._attribute(call, interface, taken, plain)

    def _async_name(self, name, plain):
        return names.unique("async_" + name, names.OPERATION, set(plain))

    def _raises(self, node, exceptions):
        found = [self._find(node, tuple(exception.scopedName()), "be raised") for exception in exceptions]
        return [exception for exception in found if exception]

    def _operation(self, node, interface, taken, plain):
        if node.contexts():
            self._error(node, "context clauses are not supported: pass what they carry as a parameter")
        void = node.returnType().kind() == idltype.tk_void
        result = None if void else self._type(node, node.returnType())
        parameters = []
        used = set()
        for parameter in node.parameters():
            parameters.append(
                model.Parameter(
                    parameter.identifier(),
                    names.unique(parameter.identifier(), names.PARAMETER, used),
                    self._type(parameter, parameter.paramType()),
                    ("in", "out", "inout")[parameter.direction()],
                )
            )
        name = node.identifier()
        interface.operations.append(
            model.Operation(
                name=name,
                cpp_name=names.unique(name, names.OPERATION, taken),
                async_name=self._async_name(name, plain),
                result=result,
                parameters=parameters,
                raises=self._raises(node, node.raises()),
                oneway=bool(node.oneway()),
                idempotent=False,
                stream=False,
                documentation=comments.documentation(node),
                place=(node.file(), node.line()),
                interface=interface,
            )
        )

    def _attribute(self, node, interface, taken, plain):
        kind = self._type(node, node.attrType())
        documentation = comments.documentation(node)
        for name in node.identifiers():
            cpp_name = names.unique(name, names.OPERATION, taken)
            shared = dict(
                cpp_name=cpp_name,
                async_name=self._async_name(name, plain),
                raises=[],
                oneway=False,
                idempotent=False,
                stream=False,
                documentation=documentation,
                place=(node.file(), node.line()),
                interface=interface,
            )
            interface.operations.append(model.Operation(name="_get_" + name, result=kind, parameters=[], **shared))
            if not node.readonly():
                value = model.Parameter("value", "value", kind, "in")
                interface.operations.append(
                    model.Operation(name="_set_" + name, result=None, parameters=[value], **shared)
                )

    def visitConst(self, node):
        kind = self._type(node, node.constType())
        if kind is None:
            return self._refuse_use(node)
        value = node.value()
        if isinstance(value, idlast.Enumerator):
            value = value.identifier()
        self._add(self._declare(model.Constant, node, type=kind, value=value))

    def _refuse_use(self, node):
        """`node` is of a type that was refused a moment ago."""
        self._unsupported[tuple(node.scopedName())] = self._cause

    def _constructed(self, node, kind):
        """A type that is declared where it is used."""
        if node.constrType() and isinstance(kind, idltype.Declared):
            if tuple(kind.scopedName()) not in self._built:
                kind.decl().accept(self)

    def visitTypedef(self, node):
        kind = node.aliasType()
        if node.constrType():
            kind.decl().accept(self)
        for declarator in node.declarators():
            built = self._type(node, kind, declarator.sizes())
            if built is None:
                self._refuse_use(declarator)
            else:
                decl = self._declare(model.Typedef, declarator, type=built)
                decl.documentation = decl.documentation or comments.documentation(node)
                self._add(decl)

    def visitStruct(self, node):
        self._struct(model.Struct, node, names.MEMBER)

    def visitException(self, node):
        self._struct(model.Exception_, node, names.EXCEPTION_MEMBER)

    def _struct(self, kind, node, reserved):
        struct = self._defined(kind, node)
        self._outer.append(struct)
        taken = set()
        supported = True
        for member in node.members():
            self._constructed(member, _innermost(member.memberType()))
            for declarator in member.declarators():
                built = self._type(member, member.memberType(), declarator.sizes())
                supported = supported and built is not None
                name = declarator.identifier()
                struct.members.append(
                    model.Member(
                        name,
                        names.unique(name, reserved, taken),
                        built,
                        (member.file(), member.line()),
                        comments.documentation(declarator) or comments.documentation(member),
                    )
                )
        self._outer.pop()
        self._finish(node, struct, supported)

    def _finish(self, node, decl, supported):
        if supported:
            self._add(decl)
        else:
            del self._built[decl.scope]
            self._refuse_use(node)

    def _defined(self, kind, node):
        """The declaration that `node` defines: a new one, or the one that it was announced as."""
        scope = tuple(node.scopedName())
        if scope not in self._built:
            return self._declare(kind, node)
        decl = self._built[scope]
        decl.place, decl.in_main_file = (node.file(), node.line()), bool(node.mainFile())
        decl.documentation = comments.documentation(node)
        return decl

    def visitStructForward(self, node):
        self._forward(model.Struct, node)

    def visitUnionForward(self, node):
        self._forward(model.Union, node)

    def _forward(self, kind, node):
        if tuple(node.scopedName()) not in self._built:
            decl = self._declare(kind, node)
            if decl.in_main_file:
                self.items.append(model.Forward(decl))

    def visitUnion(self, node):
        union = self._defined(model.Union, node)
        self._outer.append(union)
        if node.constrType():
            node.switchType().decl().accept(self)
        union.discriminator = self._type(node, node.switchType())
        taken = set()
        supported = union.discriminator is not None
        for case in node.cases():
            self._constructed(case, _innermost(case.caseType()))
            built = self._type(case, case.caseType(), case.declarator().sizes())
            supported = supported and built is not None
            name = case.declarator().identifier()
            union.cases.append(
                model.Case(
                    name,
                    names.unique(name, names.UNION_MEMBER, taken),
                    built,
                    [None if label.default() else _label(label.value()) for label in case.labels()],
                    (case.file(), case.line()),
                    next((_label(label.value()) for label in case.labels() if label.default()), None),
                    comments.documentation(case.declarator()) or comments.documentation(case),
                )
            )
        self._outer.pop()
        self._finish(node, union, supported)

    def visitEnum(self, node):
        taken = set()
        enumerators = [
            (e.identifier(), names.unique(e.identifier(), names.MEMBER, taken), comments.documentation(e))
            for e in node.enumerators()
        ]
        self._add(self._declare(model.Enum, node, enumerators=enumerators))

    def visitNative(self, node):
        self._refuse(node, _REFUSED[idltype.tk_native])

    def visitValue(self, node):
        self._refuse(node, _REFUSED[idltype.tk_value])

    visitValueAbs = visitValueForward = visitValue

    def visitValueBox(self, node):
        self._refuse(node, _REFUSED[idltype.tk_value_box])


def _label(value):
    return value.identifier() if isinstance(value, idlast.Enumerator) else value


def _innermost(kind):
    while isinstance(kind, idltype.Sequence):
        kind = kind.seqType()
    return kind
