"""Ada types for IDL types, and the code that writes and reads their values."""

from dataclasses import dataclass, replace

import model

from . import ada_names, analysis

# IDL: (Ada, initial value)
PRIMITIVES = {
    "boolean": ("Standard.Boolean", "Standard.False"), "char": ("Standard.Character", "Standard.Character'Val (0)"), "wchar": ("Standard.Wide_Character", "Standard.Wide_Character'Val (0)"),
    "int8": ("Standard.Short_Short_Integer", "0"), "octet": ("Interfaces.Unsigned_8", "0"), "short": ("Standard.Short_Integer", "0"),
    "unsigned short": ("Interfaces.Unsigned_16", "0"), "long": ("Standard.Integer", "0"), "unsigned long": ("Interfaces.Unsigned_32", "0"),
    "long long": ("Standard.Long_Long_Integer", "0"), "unsigned long long": ("Interfaces.Unsigned_64", "0"), "float": ("Standard.Float", "0.0"),
    "double": ("Standard.Long_Float", "0.0"), "long double": ("Standard.Long_Long_Float", "0.0"),
}  # fmt: skip
_EXTENSIBILITIES = {"final": "Plain", "appendable": "Delimited", "mutable": "Parameters"}
_TEXT = "Ada.Strings.Unbounded.Unbounded_String"
_LONGEST_PIECE = 200  # of a literal: GNAT's lines end somewhere
_WIDE_TEXT = "Ada.Strings.Wide_Unbounded.Unbounded_Wide_String"


def representation(decl):
    return "Skein.CDR." + (_EXTENSIBILITIES[getattr(decl, "extensibility", "final")] if analysis.uses_xcdr2(decl) else "XCDR1")


def label_of(union):
    """A discriminator that selects the initial member."""
    own = [label for label in union.initial_case.labels if label is not None]
    if own and None not in union.initial_case.labels:
        return own[0]
    taken = {label for case in union.cases if case is not union.initial_case for label in case.labels}
    return next(each for each in _values(union.discriminator, len(taken)) if each not in taken)


def _values(discriminator, count):
    """Of the discriminator's type: all, or more than `count`."""
    kind = model.unaliased(discriminator)
    if isinstance(kind, model.Named):
        return [idl for idl, _, _ in kind.decl.enumerators]
    if kind.idl == "boolean":
        return [False, True]
    return [chr(number) if "char" in kind.idl else number for number in range(count + 1)]


def otherwise(union):
    """The variant for discriminators that select nothing, if there are any."""
    labels = {label for case in union.cases for label in case.labels}
    kind = model.unaliased(union.discriminator)
    is_small = isinstance(kind, model.Named) or kind.idl == "boolean"
    covered = None in labels or (is_small and all(each in labels for each in _values(kind, 0)))
    return [] if covered else ["when others =>", "   null;"]


@dataclass(frozen=True)
class _Boxed(model.Kind):
    """A use of a type within itself."""

    decl: object


@dataclass(frozen=True)
class _Alias(model.Kind):
    decl: object
    kind: object


def _bare(kind):
    """Without names that typedefs give, and bounds."""
    if isinstance(kind, _Alias):
        return _bare(kind.kind)
    kind = kind.rebuilt(_bare)
    return replace(kind, bound=0) if kind.bound else kind


def _unaliased(kind):
    while isinstance(kind, _Alias):
        kind = kind.kind
    return kind


def _is_object(kind):
    """Whether XCDR2 has a size before a sequence of such elements."""
    kind = _unaliased(kind)
    if isinstance(kind, model.Named):
        return isinstance(kind.decl, (model.Struct, model.Union)) or (isinstance(kind.decl, model.Enum) and kind.decl.counted)
    return not isinstance(kind, model.Primitive)


class Types:
    """Types are `fixed` first: as they are used in one declaration."""

    def __init__(self, names, included):
        self._names = names
        self._included = included  # file: those that it includes
        self._instances = {}  # file: {bare type: qualified name of its package, or of an array}
        self._depth = 0  # of loops
        self.enter(None, None)

    def enter(self, file, declare):
        """What follows is of that file. `declare(name, lines)` declares a type that IDL gives no name, and returns its name."""
        self._file, self._declare = file, declare

    def fixed(self, kind, owner):
        """`owner` is what is declared with it, if that may be in a circle."""
        if isinstance(kind, model.Named):
            if isinstance(kind.decl, model.Typedef):
                return _Alias(kind.decl, self.fixed(kind.decl.type, kind.decl))
            return _Boxed(kind.decl) if owner and getattr(kind.decl, "recursive", False) and analysis.reaches(kind.decl, owner) else kind
        if isinstance(kind, model.External):
            return self.fixed(kind.element, owner)
        return kind.rebuilt(lambda part: self.fixed(part, owner))

    # ---- names

    def spelled(self, kind):
        """The Ada type."""
        if isinstance(kind, _Alias):
            self.spelled(kind.kind)
            return self._names.qualified(kind.decl)
        simple = {model.Primitive: lambda: PRIMITIVES[kind.idl][0], model.String: lambda: _TEXT, model.WideString: lambda: _WIDE_TEXT, _Boxed: lambda: "Skein.Box",
                  model.Reference: lambda: "Skein.Reference", model.Named: lambda: self._names.qualified(kind.decl)}.get(type(kind))  # fmt: skip
        if simple:
            return simple()
        return self._instance(kind) + {model.Sequence: ".Vector", model.Map: ".Map", model.Optional: ".Optional", model.Array: ""}[type(kind)]

    def _instance(self, kind):
        """Of a sequence, map or optional type its package; of an array itself."""
        bare = _bare(kind)
        if isinstance(bare, model.Sequence) and isinstance(bare.element, (model.Primitive, model.String, model.WideString, model.Reference, _Boxed)):
            unit = "Skein.Sequences." + ("Boxed_Values" if isinstance(bare.element, _Boxed) else _word(self._names, bare.element) + "s")
            self._names.used.add(unit)
            return unit
        own = self._instances.setdefault(self._file, {})
        for file in sorted(self._included.get(self._file, ()), key=ada_names.unit):
            if bare in self._instances.get(file, ()):
                self._names.used.add(self._instances[file][bare].split(".")[0])
                return self._instances[file][bare]
        if bare not in own:
            own[bare] = self._made(kind, bare)
        return own[bare]

    def _made(self, kind, bare):
        kind = _unaliased(kind)
        if isinstance(kind, model.Map):
            parts = f"{self.spelled(kind.key)}, {self.spelled(kind.value)}, {self._operator(kind.key, '<')}, {self._operator(kind.value, '=')}"
            return self._declare(_word(self._names, bare.value) + "_Maps_By_" + _word(self._names, bare.key), [f"package % is new Ada.Containers.Ordered_Maps ({parts});"])
        element = self.spelled(kind.element)
        word = _word(self._names, bare.element)
        if isinstance(kind, model.Optional):
            return self._declare("Optional_" + word, [f"package % is new Skein.Optionals ({element});"])
        if isinstance(kind, model.Array):
            initial = self.initial(kind.element)
            default = f" with Default_Component_Value => {initial}" if initial else ""
            return self._declare(f"{word}_Array_{kind.size}", [f"type % is array (0 .. {kind.size - 1}) of {element}{default};"])
        return self._declare(word + "_Sequences", [f"package % is new Ada.Containers.Vectors (Standard.Positive, {element}, {self._operator(kind.element, '=')});"])

    def _operator(self, kind, operator):
        kind = _unaliased(kind)
        if isinstance(kind, (model.String, model.WideString, model.Primitive)):
            home = self.spelled(kind).rpartition(".")[0]
        elif isinstance(kind, model.Named):
            home = self._names.package(kind.decl)
        elif isinstance(kind, (_Boxed, model.Reference)):
            home = "Skein.Boxes" if isinstance(kind, _Boxed) else "Skein"
        else:
            home = self._instance(kind)
            home = home.rpartition(".")[0] if isinstance(kind, model.Array) else home
        return f'{home}."{operator}"'

    def argument(self, kind):
        """The type of an in parameter or a result: plain strings."""
        return {model.String: "Standard.String", model.WideString: "Standard.Wide_String"}.get(type(_unaliased(kind))) or self.spelled(kind)

    def as_argument(self, kind, access):
        return {model.String: f"Ada.Strings.Unbounded.To_String ({access})", model.WideString: f"Ada.Strings.Wide_Unbounded.To_Wide_String ({access})"}.get(
            type(_unaliased(kind)), access)  # fmt: skip

    # ---- values

    def variable(self, name, kind):
        """A declaration with the type's initial value."""
        initial = self.initial(kind)
        return f"{name} : {self.spelled(kind)}{' := ' + initial if initial else ''};"

    def initial(self, kind):
        """What a component must be given; empty for types that have an initial value of their own."""
        kind = _unaliased(kind)
        if isinstance(kind, model.Primitive):
            return PRIMITIVES[kind.idl][1]
        if isinstance(kind, model.Named) and isinstance(kind.decl, model.Enum):
            return self.plain_literal(kind, kind.decl.initial or kind.decl.enumerators[0][0])
        return "0" if isinstance(kind, model.Named) and isinstance(kind.decl, model.Bitmask) else ""

    def literal(self, kind, value):
        """As a component of that type takes it."""
        of = _unaliased(kind)
        if isinstance(of, model.Optional):
            return f"{self._instance(of)}.Given ({self.literal(of.element, value)})"
        text = self.plain_literal(of, value)
        if isinstance(of, model.String):
            return f"Ada.Strings.Unbounded.To_Unbounded_String ({text})"
        return f"Ada.Strings.Wide_Unbounded.To_Unbounded_Wide_String ({text})" if isinstance(of, model.WideString) else text

    def plain_literal(self, kind, value):
        if isinstance(kind, model.Named):
            if isinstance(kind.decl, model.Enum):
                return f"{self._names.package(kind.decl)}.{self._names.literal(kind.decl, value)}"
            return str(value)
        if isinstance(kind, (model.String, model.WideString)):
            return _text_literal(value, "Standard.Character" if isinstance(kind, model.String) else "Standard.Wide_Character")
        if isinstance(value, str):
            return f"{PRIMITIVES[kind.idl][0]}'Val ({ord(value)})"
        if kind.idl == "boolean":
            return f"Standard.{bool(value)}"
        if kind.idl in ("float", "double", "long double"):
            mantissa, _, exponent = repr(float(value)).partition("e")
            return (mantissa if "." in mantissa else mantissa + ".0") + (f"E{exponent}" if exponent else "")
        return f"{PRIMITIVES[kind.idl][0]}'First" if value == -(1 << 63) else str(int(value))

    # ---- writing

    def put(self, kind, access, place, into="Into"):
        """Statements that write a value; `place` is told of what is refused."""
        kind = _unaliased(kind)
        if isinstance(kind, (model.Primitive, model.Reference)):
            return [f"Skein.CDR.Put ({into}, {access});"]
        if isinstance(kind, (model.String, model.WideString)):
            return [f'Skein.CDR.Put ({into}, {access}, {kind.bound}, "{place}");']
        if isinstance(kind, model.Named):
            return [f"{self._names.package(kind.decl)}.Put ({into}, {access});"]
        if isinstance(kind, _Boxed):
            home = self._names.package(kind.decl)
            return [f"{home}.Put ({into}, {self._names.qualified(kind.decl)}'({home}.From_Box ({access})));"]
        if isinstance(kind, model.Optional):
            return [f"Skein.CDR.Put ({into}, {access}.Present);", f"if {access}.Present then", *_indented(self.put(kind.element, f"{access}.Value", place, into)), "end if;"]
        return self._put_many(kind, access, place, into)

    def _put_many(self, kind, access, place, into, is_inner=False):
        """A sequence, map or array; an array of arrays is one array on the wire."""
        self._depth += 1
        each, start = f"Skein_Each_{self._depth}", f"Skein_Start_{self._depth}"
        if isinstance(kind, model.Map):
            package = self._instance(kind)
            loop = [f"for {each} in {access}.Iterate loop", *_indented(self.put(kind.key, f"{package}.Key ({each})", place, into)),
                    *_indented(self.put(kind.value, f"{package}.Element ({each})", place, into)), "end loop;"]  # fmt: skip
        else:
            element = _unaliased(kind.element)
            is_nested = isinstance(kind, model.Array) and isinstance(element, model.Array)
            inner = self._put_many(element, each, place, into, True) if is_nested else self.put(element, each, place, into)
            loop = [f"for {each} of {access} loop", *_indented(inner), "end loop;"]
        self._depth -= 1
        if not isinstance(kind, model.Array):
            loop.insert(0, f'Skein.CDR.Put_Length ({into}, Standard.Natural ({access}.Length), {kind.bound}, "{place}");')
        return loop if is_inner or not self._is_sized(kind) else _object(start, into, loop)

    def _is_sized(self, kind):
        """Whether XCDR2 has its size before it."""
        if isinstance(kind, model.Map):
            return True
        element = _unaliased(kind.element)
        while isinstance(kind, model.Array) and isinstance(element, model.Array):
            element = _unaliased(element.element)
        return _is_object(element)

    # ---- reading

    def get(self, kind, access, from_="From"):
        """Statements that read a value."""
        of = _unaliased(kind)
        if isinstance(of, (model.Primitive, model.Reference, model.String, model.WideString)):
            return [f"Skein.CDR.Get ({from_}, {access});"]
        if isinstance(of, model.Named):
            return [f"{self._names.package(of.decl)}.Get ({from_}, {access});"]
        self._depth += 1
        made = self._get_other(of, access, from_, f"Skein_Each_{self._depth}")
        self._depth -= 1
        return made

    def _get_other(self, kind, access, from_, each):
        if isinstance(kind, _Boxed):
            home = self._names.package(kind.decl)
            return _block([f"{each} : {self._names.qualified(kind.decl)};"], [f"{home}.Get ({from_}, {each});", f"{access} := {home}.To_Box ({each});"])
        if isinstance(kind, model.Optional):
            package = self._instance(kind)
            present = [f"{each} : {self.spelled(kind.element)};"]
            return _block([f"{each}_Present : Standard.Boolean;"], [
                f"Skein.CDR.Get ({from_}, {each}_Present);", f"if {each}_Present then",
                *_indented(_block(present, [*self.get(kind.element, each, from_), f"{access} := {package}.Given ({each});"])), "else",
                f"   {access} := {package}.None;", "end if;"])  # fmt: skip
        return self._get_many(kind, access, from_, each)

    def _get_many(self, kind, access, from_, each, is_inner=False):
        if isinstance(kind, model.Array):
            element = _unaliased(kind.element)
            self._depth += 1
            inner = f"{access} ({each})"
            nested = self._get_many(element, inner, from_, f"Skein_Each_{self._depth}", True) if isinstance(element, model.Array) else self.get(element, inner, from_)
            self._depth -= 1
            code = [f"for {each} in {access}'Range loop", *_indented(nested), "end loop;"]
        else:
            values = [f"{each} : {self.spelled(kind.value if isinstance(kind, model.Map) else kind.element)};"]
            if isinstance(kind, model.Map):
                values.append(f"{each}_Key : {self.spelled(kind.key)};")
                read = [*self.get(kind.key, f"{each}_Key", from_), *self.get(kind.value, each, from_), f"{access}.Include ({each}_Key, {each});"]
            else:
                read = [*self.get(kind.element, each, from_), f"{access}.Append ({each});"]
            code = [f"{access}.Clear;", f"for {each}_Number in 1 .. Skein.CDR.Length ({from_}) loop", *_indented(_block(values, read)), "end loop;"]
        if is_inner or not self._is_sized(kind):
            return code
        return _block([f"{each}_Outer : constant Skein.CDR.Offset := Skein.CDR.Enter ({from_});"], [*code, f"Skein.CDR.Leave ({from_}, {each}_Outer);"])

    # ---- structs and unions: (declarations, statements) that write, and that read

    def struct_codes(self, item):
        members = list(zip(item.all_members(), ada_names.members([each.name for each in item.all_members()])))
        if item.extensibility == "mutable":
            return self._mutable_struct_codes(item, members)
        write, read = [], []
        for each, ada in members:
            kind = self.fixed(each.type, item)
            write += self.put(kind, f"Item.{ada}", f"{item.idl_name}.{each.name}")
            read += self.get(kind, f"Item.{ada}")
        if not members:
            write, read = ["Skein.CDR.Put (Into, Interfaces.Unsigned_8'(0));"], _block(["Nothing : Interfaces.Unsigned_8;"], ["Skein.CDR.Get (From, Nothing);"])
        return self._sized(item, write, read)

    def _sized(self, item, write, read):
        if item.extensibility == "final":
            return ([], write), ([], read)
        outer = ["Skein_Outer : constant Skein.CDR.Offset := Skein.CDR.Enter (From);"]
        return ([], _object("Skein_Start", "Into", write)), (outer, [*read, "Skein.CDR.Leave (From, Skein_Outer);"])

    def _mutable_struct_codes(self, item, members):
        write, read = [], []
        for each, ada in members:
            kind = self.fixed(each.type, item)
            of = _unaliased(kind)
            is_optional = isinstance(of, model.Optional)
            place = f"{item.idl_name}.{each.name}"
            put = self._put_member(each.id, each.must_understand, self.put(of.element, f"Item.{ada}.Value", place) if is_optional else self.put(kind, f"Item.{ada}", place))
            write += [f"if Item.{ada}.Present then", *_indented(put), "end if;"] if is_optional else put
            get = self.get(kind, f"Item.{ada}")
            if is_optional:
                value = "Skein_Value"
                get = _block([f"{value} : {self.spelled(of.element)};"], [*self.get(of.element, value), f"Item.{ada} := {self._instance(of)}.Given ({value});"])
            read += [f"when {each.id} =>", *_indented(get)]
        read = ["Item := (others => <>);", "while Skein.CDR.More (From) loop", *_indented(_block(
            ["Skein_Id : Interfaces.Unsigned_32;", "Skein_Inner : Skein.CDR.Offset;"],
            ["Skein.CDR.Enter_Member (From, Skein_Id, Skein_Inner);", "case Skein_Id is", *_indented(read), "   when others =>", "      null;", "end case;",
             "Skein.CDR.Leave (From, Skein_Inner);"])), "end loop;"]  # fmt: skip
        return self._sized(item, write or ["null;"], read)

    def _put_member(self, id_, must_understand, lines):
        flag = ", Must_Understand => True" if must_understand else ""
        return [f"Skein.CDR.Put_Member (Into, {id_}{flag});", *_object("Skein_Member", "Into", lines)]

    def union_codes(self, item, cases, labels):
        discriminator = self.fixed(item.discriminator, item)
        is_mutable = item.extensibility == "mutable"
        write = self.put(discriminator, "Item.Switch", item.idl_name)
        write = self._put_member(0, True, write) if is_mutable else write
        read = self.get(discriminator, "Skein_Switch")
        read = self._get_member(read) if is_mutable else read
        puts, gets = [], []
        for case, ada in cases:
            kind = self.fixed(case.type, item)
            put, get = self.put(kind, f"Item.{ada}", f"{item.idl_name}.{case.name}"), self.get(kind, f"Skein_Made.{ada}")
            puts += [f"when {labels(case)} =>", *_indented(self._put_member(case.id, False, put) if is_mutable else put)]
            gets += [f"when {labels(case)} =>", *_indented(self._get_member(get) if is_mutable else get)]
        write += ["case Item.Switch is", *_indented([*puts, *otherwise(item)]), "end case;"]
        read += _block([f"Skein_Made : {self._names.qualified(item)} (Skein_Switch);"],
                       ["case Skein_Switch is", *_indented([*gets, *otherwise(item)]), "end case;", "Item := Skein_Made;"])  # fmt: skip
        (none, write), (outer, read) = self._sized(item, write, read)
        return (none, write), ([*outer, f"Skein_Switch : {self.spelled(discriminator)};"], read)

    def _get_member(self, lines):
        return _block(["Skein_Id : Interfaces.Unsigned_32;", "Skein_Inner : Skein.CDR.Offset;"],
                      ["Skein.CDR.Enter_Member (From, Skein_Id, Skein_Inner);", *lines, "Skein.CDR.Leave (From, Skein_Inner);"])  # fmt: skip


def _word(names, bare):
    """The part of a name that stands for a type."""
    if isinstance(bare, model.Primitive):
        return PRIMITIVES[bare.idl][0].rpartition(".")[2]
    if isinstance(bare, model.Map):
        return f"{_word(names, bare.value)}_Map_By_{_word(names, bare.key)}"
    if isinstance(bare, model.Array):
        return f"{_word(names, bare.element)}_Array_{bare.size}"
    if isinstance(bare, (model.Sequence, model.Optional)):
        return f"{_word(names, bare.element)}_Sequence" if isinstance(bare, model.Sequence) else f"Optional_{_word(names, bare.element)}"
    return {model.String: "Text", model.WideString: "Wide_Text", _Boxed: "Box", model.Reference: "Reference"}.get(type(bare)) or names.simple(bare.decl)


def _text_literal(value, character):
    parts, plain = [], ""
    units = value if character == "Standard.Character" else [chr(int.from_bytes(unit, "big")) for unit in _utf16(value)]
    for each in units:
        if " " <= each <= "~" and len(plain) < _LONGEST_PIECE:
            plain += '""' if each == '"' else each
        elif " " <= each <= "~":
            parts.append(f'"{plain}"')
            plain = '""' if each == '"' else each
        else:
            parts += [f'"{plain}"', f"{character}'Val ({ord(each)})"]
            plain = ""
    return "\n & ".join([*parts, f'"{plain}"'])


def _utf16(value):
    encoded = value.encode("utf-16-be", "surrogatepass")
    return [encoded[at : at + 2] for at in range(0, len(encoded), 2)]


def _indented(lines):
    return ["   " + line for line in lines]


def _block(declared, code):
    return ["declare", *_indented(declared), "begin", *_indented(code), "end;"]


def _object(start, into, lines):
    """Lines whose output has its size before it."""
    return _block([f"{start} : constant Skein.CDR.Offset := Skein.CDR.Begin_Object ({into});"], [*lines, f"Skein.CDR.End_Object ({into}, {start});"])
