"""Ada for IDL: of x.idl the package X_IDL (x_idl.ads, x_idl.adb), with a package in it for each module and interface."""

import os
import re

import model

from . import ada_coding, analysis, c_types, description
from .ada_names import STANDARD, Names, flag, identifier, members, unique, unit


def outputs(file, base, _):
    """{path: lines}"""
    made = _unit_of(file)
    path = os.path.join(os.path.dirname(base), made.root.name.lower())
    return {path + ".ads": made.spec(), path + ".adb": made.body()}


def _unit_of(file):
    """That of the main file. Those of included files are made before it, for the names of their types."""
    names = Names(file.all_items, file.announced)
    types = ada_coding.Types(names, file.included)
    for path in dict.fromkeys(item.place.file for item in file.all_items if item.place.file != file.path):
        _Unit(path, [item for item in file.all_items if item.place.file == path], names, types)
    names.used.clear()
    return _Unit(file.path, [item for item in file.items if not isinstance(item, model.Forward)], names, types)


class _Package:
    """One package, and what is in it, in order."""

    def __init__(self, name):
        self.name = name
        self.spec = []  # lines and packages
        self.body = []
        self.inner = {}

    def within(self, name):
        if name not in self.inner:
            self.inner[name] = package = _Package(name)
            self.spec += ["", package]
            self.body.append(package)
        return self.inner[name]

    def has_body(self):
        return any(not isinstance(each, _Package) or each.has_body() for each in self.body)

    def lines(self, part, begun=()):
        made = [f"package {'body ' if part == 'body' else ''}{self.name} is"]
        for each in getattr(self, part):
            if not isinstance(each, _Package):
                made.append("   " + each if each else "")
            elif part == "spec" or each.has_body():
                made += [*([] if made[-1] == "" else [""]), *("   " + line if line else "" for line in each.lines(part))]
        return [*made, "", *(["begin", *("   " + line for line in begun)] if begun else []), f"end {self.name};"]


class _Unit:
    """What becomes of one file."""

    def __init__(self, file, items, names, types):
        self.file = file
        self.items = items
        self.names = names
        self.root = _Package(unit(file))
        self.path = (self.root.name,)  # of the package in which the next declaration lies
        self.types = types
        self.at_start = []  # statements
        self.done = set()
        types.enter(file, self._declare_instance)
        described = c_types.types_of(items)
        if described:
            self.root.body += _described("Described", description.interface_description(None, described))
        for item in items:
            self._add(item)

    def _add(self, item):
        """What it needs of the same package comes first: it may have been announced before."""
        if item in self.done:
            return
        self.done.add(item)
        for named in [] if isinstance(item, model.Interface) else [decl for kind in analysis.parts(item) for decl in analysis.named_in(kind)]:
            if named in self.items and self.names.path(named) == self.names.path(item) and not analysis.reaches(named, item):
                self._add(named)
        outer, self.path = self.path, self.names.path(item) + ((self.names.simple(item),) if isinstance(item, model.Interface) else ())
        made = {model.Enum: self._enum, model.Bitmask: self._bitmask, model.Bitset: self._bitset, model.Union: self._union, model.Interface: self._interface,
                model.Exception_: self._exception, model.Constant: self._constant, model.Typedef: self._typedef}.get(type(item), self._struct)  # fmt: skip
        made(item, self.names.simple(item))
        self.path = outer

    @property
    def package(self):
        package = self.root
        for name in self.path[1:]:
            package = package.within(name)
        return package

    def _declare_instance(self, name, declaration):
        """A type that has no name in IDL, where it is used first; its qualified name."""
        name = unique(name, self.names.names_in(self.path))
        self.package.spec += ["", *(line.replace("%", name) for line in declaration)]
        return ".".join([*self.path, name])

    def _says(self, lines, decl=None):
        self.package.spec += ["", *_said(decl), *lines]

    def _codes(self, kind, write, read):
        """Put and Get of a declared type."""
        heads = [f"procedure Put (Into : in out Skein.CDR.Writer; Item : {kind})", f"procedure Get (From : in out Skein.CDR.Reader; Item : out {kind})"]
        self.package.spec += [head + ";" for head in heads]
        for head, (declared, code) in zip(heads, (write, read)):
            self.package.body += ["", head + " is", *("   " + line for line in declared), "begin", *("   " + line for line in code or ["null;"]), f"end {head[10:13]};"]

    # ---- declarations

    def _constant(self, item, name):
        kind = model.unaliased(item.type)
        of = {model.String: "Standard.String", model.WideString: "Standard.Wide_String"}.get(type(kind)) or self.types.spelled(self.types.fixed(item.type, None))
        self._says([f"{name} : constant {of} := {self.types.plain_literal(kind, item.value)};"], item)

    def _typedef(self, item, name):
        of = self.types.fixed(item.type, item)
        spelled = self.types.spelled(of)
        self._says([f"subtype {name} is {spelled};"], item)

    def _enum(self, item, name):
        literals = [self.names.literal(item, idl) for idl, _, _ in item.enumerators]
        self._says([f"type {name} is", *(f"  {'(' if i == 0 else ' '}{each}{',' if i + 1 < len(literals) else ');'}" for i, each in enumerate(literals))], item)
        number = "Standard." + {8: "Short_Short_Integer", 16: "Short_Integer", 32: "Integer"}[item.bits]
        cases = [(f"{self.names.package(item)}.{literal}", value) for literal, value in zip(literals, item.values)]
        write = ["case Item is", *(f"   when {literal} => Skein.CDR.Put (Into, {number}'({value}));" for literal, value in cases), "end case;"]
        wrong = f'raise Skein.Invalid_Argument with Number\'Image & " is no {item.idl_name}";'
        read = ["Skein.CDR.Get (From, Number);", "case Number is", *(f"   when {value} => Item := {literal};" for literal, value in cases), f"   when others => {wrong}", "end case;"]
        self._codes(name, ([], write), ([f"Number : {number};"], read))

    def _bitmask(self, item, name):
        under = f"Interfaces.Unsigned_{item.bits}"
        flags = [f"{flag(name, idl)} : constant {name} := 2**{position};" for idl, _, position, _ in item.flags]
        self._says([f"type {name} is new {under};", *flags], item)
        self._codes(name, ([], [f"Skein.CDR.Put (Into, {under} (Item));"]), ([], [f"Skein.CDR.Get (From, {under} (Item));"]))

    def _bitset(self, item, name):
        under = f"Interfaces.Unsigned_{item.bits}"
        fields = [each for each in item.fields if each.name]
        named = dict(zip(fields, members([each.name for each in fields])))
        components = [f"{ada} : {ada_coding.PRIMITIVES[each.type.idl][0]} := {ada_coding.PRIMITIVES[each.type.idl][1]};" for each, ada in named.items()]
        self._says(_record(name, components), item)
        write, read = [], [f"Skein.CDR.Get (From, Stored);", "Bits := Interfaces.Unsigned_64 (Stored);"]
        for each, ada in named.items():
            kind, at = ada_coding.PRIMITIVES[each.type.idl][0], f'{each.width}, {each.offset}'
            wide = "Standard.Long_Long_Integer" if each.type.idl in model.SIGNED.values() else "Interfaces.Unsigned_64"
            value = f"{wide}'({kind + chr(39) + 'Pos (Item.' + ada + ')' if kind == 'Standard.Boolean' else f'{wide} (Item.{ada})'})"
            write.append(f'Bits := Bits or Skein.CDR.Field ({value}, {at}, "{item.idl_name}.{each.name}");')
            part = f"{wide}'(Skein.CDR.Field_Of (Bits, {at}))"
            read.append(f"Item.{ada} := {part} /= 0;" if kind == "Standard.Boolean" else f"Item.{ada} := {kind} ({part});")
        write.append(f"Skein.CDR.Put (Into, {under} (Bits));")
        bits = ["use type Interfaces.Unsigned_64;", "Bits : Interfaces.Unsigned_64 := 0;"]
        self._codes(name, (bits, write), ([*bits, f"Stored : {under};"], read if named else ["Skein.CDR.Get (From, Stored);"]))

    def _struct(self, item, name):
        self._says(self._members(item, name), item)
        self._codes(name, *self.types.struct_codes(item))
        self._topic_type(item, name)
        self._box(item, name)

    def _members(self, item, name):
        components = []
        for each, ada in zip(item.all_members(), members([each.name for each in item.all_members()])):
            kind = self.types.fixed(each.type, item)
            initial = self.types.initial(kind) if each.initial is None else self.types.literal(kind, each.initial)
            components += [*_said(each), f"{ada} : {self.types.spelled(kind)}{' := ' + initial if initial else ''};"]
        return _record(name, components)

    def _topic_type(self, item, name):
        self.package.spec += [f"function {name}_Topic_Type return Skein.Types.Topic_Type;"]
        self.package.body += ["", f'function {name}_Topic_Type return Skein.Types.Topic_Type is (({self.root.name}.Described, Skein."+" ("{item.idl_name}"), {ada_coding.representation(item)}));']

    def _box(self, item, name):
        """Conversions of a type that contains itself."""
        if not item.recursive:
            return
        self.package.spec += ["", f"function To_Box (Item : {name}) return Skein.Box;", f"function From_Box (Item : Skein.Box) return {name};"]
        self.package.body += [
            "", f"type {name}_Box is new Skein.Boxed with record", f"   Value : {name};", "end record;", "",
            f"function To_Box (Item : {name}) return Skein.Box is (Skein.Boxes.To_Holder ({name}_Box'(Value => Item)));", "",
            f"function From_Box (Item : Skein.Box) return {name} is", f"   Initial : {name};", "begin",
            f"   return (if Item.Is_Empty then Initial else {name}_Box (Item.Element).Value);", "end From_Box;"]  # fmt: skip

    def _exception(self, item, name):
        members = f"{name}_Members"
        self._says([f"{name} : exception; --  raise it by Raise_{name}, which gives it its members", *self._members(item, members), f"procedure Raise_{name} (Members : {members}) with No_Return;",
                    f"--  The members of an exception that this task has just caught.",
                    f"function {name}_Of (Error : Ada.Exceptions.Exception_Occurrence) return {members};"], item)  # fmt: skip
        self._codes(members, *self.types.struct_codes(item))
        self.package.body += [
            "", f"procedure Raise_{name} (Members : {members}) is", f"   Into : Skein.CDR.Writer ({ada_coding.representation(item)});", "begin",
            "   Put (Into, Members);", f"   Skein.Errors.Raise_With ({name}'Identity, Skein.CDR.Message (Into));", f"end Raise_{name};", "",
            f"function {name}_Of (Error : Ada.Exceptions.Exception_Occurrence) return {members} is",
            "   Message : Skein.Bytes renames Skein.Errors.Members (Error);",
            "   From    : Skein.CDR.Reader := Skein.CDR.Read (Message'Address, Message'Length);", "begin", f"   return Item : {members} do",
            "      Get (From, Item);", "   end return;", f"end {name}_Of;"]  # fmt: skip
        self.at_start.append(f"Skein.Errors.Register (\"{item.idl_name}\", {self.names.qualified(item)}'Identity);")

    def _union(self, item, name):
        discriminator = self.types.fixed(item.discriminator, item)
        cases = list(zip(item.cases, members([case.name for case in item.cases], {"switch"})))
        label = self.types.plain_literal(model.unaliased(item.discriminator), ada_coding.label_of(item))
        components = []
        for case, ada in cases:
            kind = self.types.fixed(case.type, item)
            initial = self.types.initial(kind)
            components += [f"when {self._labels(item, case)} =>", *("   " + line for line in _said(case)),
                           f"   {ada} : {self.types.spelled(kind)}{' := ' + initial if initial else ''};"]  # fmt: skip
        components += ada_coding.otherwise(item)
        self._says([f"type {name} (Switch : {self.types.spelled(discriminator)} := {label}) is record", "   case Switch is",
                    *("      " + line for line in components), "   end case;", "end record;"], item)  # fmt: skip
        self._codes(name, *self.types.union_codes(item, cases, lambda case: self._labels(item, case)))
        self._topic_type(item, name)
        self._box(item, name)

    def _labels(self, item, case):
        if None in case.labels:
            return "others"
        return " | ".join(self.types.plain_literal(model.unaliased(item.discriminator), label) for label in case.labels)

    # ---- interfaces

    def _interface(self, item, name):
        taken = self.names.names_of_interface(item)
        operations = [_Operation(self.types, self.names, each, taken) for each in item.all_operations()]
        structs = [struct for each in item.all_operations() for struct in (each.in_struct, each.out_struct, *each.raises)]
        own = {struct for each in item.all_operations() for struct in (each.in_struct, each.out_struct)}
        bytes_ = description.interface_description(item, [each for each in description.closure(structs) if each not in own])
        self.package.body += _described("Description", bytes_)
        self._says(["type Proxy is new Skein.Proxies.Proxy with null record;", "--  Waits for a provider.",
                    "function Connect (Own : Skein.Entities.Entity'Class; By : Skein.Proxies.Choice := Skein.Proxies.Any) return Proxy;"], item)  # fmt: skip
        self.package.body += ["", "function Connect (Own : Skein.Entities.Entity'Class; By : Skein.Proxies.Choice := Skein.Proxies.Any) return Proxy is", "begin",
                              "   return Made : Proxy do", "      Skein.Proxies.Connect (Made, Own, Description, By);", "   end return;", "end Connect;"]  # fmt: skip
        for each in operations:
            self.package.spec += ["", *_said(each.idl), *each.calls()]
            self.package.body += each.call_bodies()
        self._says(["--  Derive from it; it is called by as many tasks at once as Skein.Services.Options say.", "type Service is abstract tagged limited null record;"])
        for each in operations:
            self.package.spec += each.served()
            self.package.body += each.served_body()
        head = ["function Provide", "  (Own : Skein.Entities.Entity'Class; By : not null access Service'Class; Given : Skein.Services.Options := Skein.Services.Plain)",
                "   return Skein.Services.Provider"]  # fmt: skip
        self._says(["--  The service must live as long as the provider.", *head[:-1], head[-1] + ";"])
        self.package.body += ["", "type Dispatcher is new Skein.Services.Handler with record", "   Target : access Service'Class;", "end record;", "",
                              "overriding procedure Handle (Self : in out Dispatcher; Operation : Standard.String; From : in out Skein.CDR.Reader; To : Skein.Services.Reply) is",
                              "begin"]  # fmt: skip
        for index, each in enumerate(operations):
            self.package.body += [f"   {'els' if index else ''}if Operation = \"{each.idl.name}\" then", *("      " + line for line in each.dispatched())]
        refuse = "Skein.Services.Refuse (Operation);"
        self.package.body += ["   else", "      " + refuse, "   end if;"] if operations else ["   " + refuse]
        self.package.body += ["end Handle;", "", *head[:-1], head[-1] + " is", "  (Skein.Services.Provide",
                              "     (Own, Description, new Dispatcher'(Skein.Services.Handler with Target => By.all'Unchecked_Access), Given));"]  # fmt: skip

    # ---- files

    def spec(self):
        used = sorted(self.names.used - {self.root.name})
        packages = ["Ada.Containers.Ordered_Maps", "Ada.Containers.Vectors", "Ada.Exceptions", "Ada.Strings.Unbounded", "Ada.Strings.Wide_Unbounded", "Interfaces",
                    "Skein.CDR", "Skein.Entities", "Skein.Optionals", "Skein.Proxies", "Skein.Services", "Skein.Types", *used]  # fmt: skip
        return self._written([*(f"with {each};" for each in packages), "", *self.root.lines("spec")])

    def body(self):
        if not self.root.has_body():
            return ["pragma No_Body;"]
        return self._written(["with Skein.Errors;", "", *self.root.lines("body", self.at_start)])

    def _written(self, lines):
        """Ada's own types are named with their package only where something hides them."""
        head = [f"--  Generated from {os.path.basename(self.file)} by the IDL compiler of Skein. Do not edit.", "pragma Style_Checks (Off);", "pragma Warnings (Off);"]
        lines = [each for line in lines for each in line.split("\n")]
        if self.names.hide_standard(self.items):
            return [*head, *lines]
        return [*head, *(re.sub(_PREFIX, "", line) for line in lines)]


_PREFIX = re.compile(r"\bStandard\.(?=(?:" + "|".join((*STANDARD, "True", "False")) + r")\b)")


def _said(decl):
    return ["--  " + re.sub(r"[\x00-\x1f\x7f\x85]", " ", line) for line in getattr(decl, "documentation", [])]


def _record(name, components):
    return [f"type {name} is record", *("   " + line for line in components), "end record;"] if components else [f"type {name} is null record;"]


def _described(name, bytes_):
    lines = [", ".join(map(str, bytes_[at : at + 24])) for at in range(0, len(bytes_), 24)]
    return ["", f"{name} : constant Skein.Types.Description := Skein.Types.Make", "  ((" + ",\n      ".join(lines) + "));"]


class _Operation:
    """One operation as a caller and as a provider see it."""

    def __init__(self, types, names, operation, taken):
        self.types, self.idl = types, operation
        plain = operation.name
        for prefix, verb in (("_get_", "Get_"), ("_set_", "Set_")):
            plain = verb + plain.removeprefix(prefix) if plain.startswith(prefix) else plain
        self.name = unique(identifier(plain), taken, self._derived)
        self.parameters = list(zip(operation.parameters, members([each.name for each in operation.parameters], {"self", "within", "call", "push", "stream"})))
        self.fixed = {each: types.fixed(each.type, None) for each in operation.parameters}
        self.result = types.fixed(operation.result, None) if operation.result else None
        self.result_type = types.argument(self.result) if operation.result else None
        self.results = f"{self.name}_Results"

    def _derived(self, name):
        return [name, f"Start_{name}", f"Finish_{name}", f"{name}_Stream", f"{name}_Results"]

    def _place(self):
        return f"{self.idl.interface.idl_name}::{self.idl.name}"

    def _inputs(self):
        return [f"{ada} : {self.types.argument(self.fixed[each])}" for each, ada in self.parameters if each.is_in]

    def _modes(self):
        modes = {"in": "", "out": "out ", "inout": "in out "}
        return [f"{ada} : {modes[each.direction]}{self.types.argument(self.fixed[each]) if each.direction == 'in' else self.types.spelled(self.fixed[each])}"
                for each, ada in self.parameters]  # fmt: skip

    def _outputs(self):
        return [f"{ada} : out {self.types.spelled(self.fixed[each])}" for each, ada in self.parameters if each.is_out]

    def _head(self, name, parameters, result):
        given = f" ({'; '.join(parameters)})" if parameters else ""
        return f"function {name}{given} return {result}" if result else f"procedure {name}{given}"

    def _within(self):
        return "Within : Standard.Duration := 0.0"

    def _heads(self):
        """Of what callers have."""
        if self.idl.stream:
            return [self._head(self.name, ["Self : Proxy'Class", *self._inputs(), self._within()], f"{self.name}_Stream"),
                    self._head("Next", [f"Self : in out {self.name}_Stream", f"Item : out {self.types.spelled(self.result)}"], "Standard.Boolean")]  # fmt: skip
        made = [self._head(self.name, ["Self : Proxy'Class", *self._modes(), self._within()], self.result_type)]
        if self.idl.oneway:
            return made
        return [*made, self._head(f"Start_{self.name}", ["Self : Proxy'Class", "Call : in out Skein.Proxies.Pending", *self._inputs(), self._within()], None),
                self._head(f"Finish_{self.name}", ["Call : in out Skein.Proxies.Pending", *self._outputs()], self.result_type)]  # fmt: skip

    def calls(self):
        heads = [head + ";" for head in self._heads()]
        if self.idl.stream:
            return [f"type {self.name}_Stream is new Skein.Proxies.Result_Stream with null record;", heads[0], "--  False at the end, where Item has its initial value.", heads[1]]
        return heads

    def _written(self):
        """Lines that write the arguments."""
        lines = []
        for each, ada in self.parameters:
            if each.is_in:
                lines += self.types.put(self.fixed[each], ada, f"{self._place()}.{each.name}", "Skein_Into")
        return lines or ["Skein.CDR.Put (Skein_Into, Interfaces.Unsigned_8'(0));"]

    def _results_function(self):
        """Reads what an answer holds."""
        if not self.idl.out_struct.members:
            return []
        code = self.types.get(self.result, "Skein_Result", "Skein_From") if self.result else []
        for each, ada in self.parameters:
            if each.is_out:
                code += self.types.get(self.fixed[each], ada, "Skein_From")
        declared = ["   " + self.types.variable("Skein_Result", self.result)] if self.result else []
        back = [f"   return {self.types.as_argument(self.result, 'Skein_Result')};"] if self.result else []
        head = self._head(self.results, ["Skein_From : in out Skein.CDR.Reader", *self._outputs()], self.result_type)
        return ["", head + " is", *declared, "begin", *("   " + line for line in code), *back, f"end {self.results};"]

    def _read(self, reader):
        """Statements that call what gives a reader, and return what it holds."""
        if not self.idl.out_struct.members:
            return [f"declare", f"   Skein_From : Skein.CDR.Reader := {reader} with Unreferenced;", "begin", "   null;", "end;"]
        call = f"{self.results} ({', '.join(['Skein_From', *(ada for each, ada in self.parameters if each.is_out)])});"
        return ["declare", f"   Skein_From : Skein.CDR.Reader := {reader};", "begin", f"   {'return ' if self.result else ''}{call}", "end;"]

    def call_bodies(self):
        heads = self._heads()
        into = f"   Skein_Into : Skein.CDR.Writer ({ada_coding.representation(self.idl.in_struct)});"
        written = ["   " + line for line in self._written()]
        sent = f'"{self.idl.name}", Skein_Into, Within'
        if self.idl.stream:
            got = self.types.get(self.result, "Item", "Skein_From")
            return ["", heads[0] + " is", into, "begin", *written, f"   return Made : {self.name}_Stream do", f"      Skein.Proxies.Start (Self, {sent}, Made);", "   end return;",
                    f"end {self.name};", "", heads[1] + " is", "   Skein_From : Skein.CDR.Reader := Skein.Proxies.Take (Self);",
                    "   " + self.types.variable("Skein_Initial", self.result), "begin", "   if Skein_From.Is_Empty then", "      Item := Skein_Initial;", "      return False;", "   end if;",
                    *("   " + line for line in got), "   return True;", "end Next;"]  # fmt: skip
        made = [*self._results_function(), "", heads[0] + " is", into, "begin", *written,
                *("   " + line for line in self._read(f"Skein.Proxies.Call (Self, {sent})")), f"end {self.name};"]  # fmt: skip
        if self.idl.oneway:
            return made
        return [*made, "", heads[1] + " is", into, "begin", *written, f"   Skein.Proxies.Start (Self, {sent}, Call);", f"end Start_{self.name};", "", heads[2] + " is", "begin",
                *("   " + line for line in self._read(f"Skein.Proxies.Finish (Call, {chr(34)}{self.idl.name}{chr(34)})")), f"end Finish_{self.name};"]  # fmt: skip

    # ---- the provider's side

    def _served_head(self):
        push = [f"Push : not null access procedure (Item : {self.result_type})"] if self.idl.stream else []
        return self._head(self.name, ["Self : in out Service", *self._modes(), *push], None if self.idl.stream else self.result_type)

    def served(self):
        return [self._served_head() + ("; --  raises Unimplemented unless it is overridden" if self.idl.optional else " is abstract;")]

    def served_body(self):
        if not self.idl.optional:
            return []
        refuse = f'Skein.Services.Refuse ("{self.idl.name}");'
        unreachable = [f"   return {self.name} (Self{''.join(', ' + ada for _, ada in self.parameters)});"] if self.result and not self.idl.stream else []
        return ["", self._served_head() + " is", "begin", "   " + refuse, *unreachable, f"end {self.name};"]

    def dispatched(self):
        """Statements that read the arguments, call the service and write the answer."""
        declared, read, passed = [], [], []
        for each, ada in self.parameters:
            declared.append(self.types.variable(f"P_{ada}", self.fixed[each]))
            passed.append(self.types.as_argument(self.fixed[each], f"P_{ada}") if each.direction == "in" else f"P_{ada}")
            if each.is_in:
                read += self.types.get(self.fixed[each], f"P_{ada}", "From")
        into = f"Into : Skein.CDR.Writer ({ada_coding.representation(self.idl.out_struct)});"
        if self.idl.stream:
            declared += [f"procedure Push (Item : {self.result_type}) is", "   " + into, "begin", *("   " + line for line in self.types.put(self.result, "Item", self._place(), "Into")),
                         "   Skein.Services.Push (To, Into);", "end Push;"]  # fmt: skip
            passed.append("Push'Access")
        call = f"Self.Target.{self.name}{' (' + ', '.join(passed) + ')' if passed else ''}"
        if self.idl.stream or self.idl.oneway:
            return _block(declared, [*read, call + ";"])
        outs = [line for each, ada in self.parameters if each.is_out for line in self.types.put(self.fixed[each], f"P_{ada}", f"{self._place()}.{each.name}", "Into")]
        if self.result:
            is_text = self.result_type in ("Standard.String", "Standard.Wide_String")  # of which a constant would be a copy on a stack that is not Ada's
            declaration = f"Result : {self.result_type} renames {call};" if is_text else f"Result : constant {self.result_type} := {call};"
            answered = _block([declaration], [*self.types.put(self.result, "Result", self._place(), "Into"), *outs])
        else:
            answered = [call + ";", *(outs or ["Skein.CDR.Put (Into, Interfaces.Unsigned_8'(0));"])]
        return _block([*declared, into], [*read, *answered, "Skein.Services.Answer (To, Into);"])


def _block(declared, code):
    return [*(["declare", *("   " + line for line in declared)] if declared else []), "begin", *("   " + line for line in code), "end;"]
