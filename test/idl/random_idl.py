"""Random IDL that is right more often than not, or always."""


class Generator:
    """`strict`: everything that it writes can be compiled. Without, some names may clash, and some types may not be used where they are."""

    def __init__(self, dice, strict=False):
        self.dice = dice
        self.strict = strict
        self.count = 0
        self.types = []  # names
        self.enums = {}  # names: enumerators
        self.exceptions = []
        self.interfaces = []

    def name(self):
        self.count += 1
        return f"{self.dice.choice('abcABC')}{self.count}"

    def file(self):
        return "".join(self.declaration(0) for _ in range(self.dice.randrange(1, 8)))

    def declaration(self, depth):
        kinds = [self.struct, self.struct, self.union, self.enum, self.typedef, self.constant, self.interface, self.bitmask, self.bitset,
                 self.recursive]  # fmt: skip
        kinds += [self.module] if depth < 2 else []
        return self.dice.choice(kinds)(depth)

    def module(self, depth):
        name = self.name()
        types, exceptions, interfaces = list(self.types), list(self.exceptions), list(self.interfaces)
        inside = "".join(self.declaration(depth + 1) for _ in range(self.dice.randrange(1, 4)))

        def outside(before, now):
            return before + [f"{name}::{each}" for each in now[len(before) :]]

        self.enums.update({f"{name}::{each}": values for each, values in self.enums.items() if each in self.types[len(types) :]})
        self.types, self.exceptions = outside(types, self.types), outside(exceptions, self.exceptions)
        self.interfaces = outside(interfaces, self.interfaces)
        return f"module {name} {{\n{inside}}};\n"

    def type(self, depth=0):
        dice = self.dice
        simple = ["boolean", "char", "wchar", "octet", "int8", "short", "uint16", "long", "unsigned long", "int64", "uint64", "float", "double"]
        simple += ["string", "wstring", f"string<{dice.randrange(1, 9)}>"] + self.types * 2
        if depth < 3 and dice.random() < 0.25:
            return f"sequence<{self.type(depth + 1)}{dice.choice(['', ', 3'])}>"
        if depth < 3 and dice.random() < 0.1:
            return f"map<{dice.choice(['long', 'string', 'int8', 'wchar'])}, {self.type(depth + 1)}>"
        return dice.choice(simple)

    def member(self):
        dice = self.dice
        note = dice.choice(["", "", "", "@key ", "@optional ", '@unit("m") ', "@must_understand ", "@default "])
        kind, sizes = self.type(), dice.choice(["", "", "", "[2]", "[3][1]"])
        if note == "@default ":
            kind, sizes = dice.choice(["long", "double", "boolean", "char", "string", "wstring", "uint64"] + list(self.enums)), ""
            note = f"@default({self.value(kind)}) " + dice.choice(["", "@optional "])
        if note == "@key " and self.strict:
            kind = dice.choice(["long", "string", "char", "octet", "uint64"])
        if dice.random() < 0.05:
            return f"  enum {self.name()} {{ {self.name()}, {self.name()} }} {self.name()}{sizes};\n"
        return f"  {note}{kind} {self.name()}{sizes};\n"

    def value(self, kind):
        values = {"long": "-7", "double": "2.5e3", "boolean": "TRUE", "char": r"'\x9f'", "string": r'"a\"\\\n\301"', "wstring": r'L"\u20ac5"',
                  "uint64": "18446744073709551615"}  # fmt: skip
        return values.get(kind) or self.scoped_enumerator(kind)

    def scoped_enumerator(self, enum):
        return "::".join([*enum.split("::")[:-1], self.dice.choice(self.enums[enum])])

    def struct(self, depth):
        dice = self.dice
        kind = dice.choice(["struct", "struct", "exception"])
        name = self.name()
        notes = dice.choice(["", "", "@final ", "@appendable ", "@mutable "])
        text = f"{notes}{kind} {name} {{\n" + "".join(self.member() for _ in range(dice.randrange(0, 5))) + "};\n"
        (self.types if kind == "struct" else self.exceptions).append(name)
        return text

    def recursive(self, depth):
        dice = self.dice
        name, other, a, b = (self.name() for _ in range(4))
        notes = dice.choice(["", "@appendable ", "@mutable "])
        text = dice.choice([
            f"struct {name};\n{notes}struct {name} {{\n  sequence<{name}> {a};\n{self.member()}}};\n",
            f"struct {name};\n{notes}struct {name} {{\n{self.member()}  @optional {name} {a};\n  map<long, {name}> {b};\n}};\n",
            f"union {name};\n{notes}union {name} switch (long) {{\n  case 1: @external {name} {a};\n  default: {self.type()} {b};\n}};\n",
            f"union {name};\n{notes}struct {other} {{\n  @external {name} {a};\n{self.member()}}};\n"
            f"union {name} switch (long) {{\n  case 1: {other} {a};\n  case 2: {self.type()} {b};\n}};\n",
        ])  # fmt: skip
        self.types.append(name)
        return text

    def union(self, depth):
        dice = self.dice
        name = self.name()
        switch = dice.choice(["long", "octet", "int8", "uint64", "boolean", "char", "wchar"] + list(self.enums))
        labels = {"boolean": ["TRUE", "FALSE"], "char": ["'a'", r"'\''", r"'\0'"], "wchar": ["L'a'", r"L'\u20ac'"]}.get(switch)
        labels = labels or (["::".join([*switch.split("::")[:-1], each]) for each in self.enums[switch]] if switch in self.enums else "123")
        cases = "".join(f"  case {label}: {self.type()} {self.name()};\n" for label in labels[: dice.randrange(1, 4)])
        other = dice.choice(["", f"  default: {self.type()} {self.name()};\n"]) if len(labels) == 3 else ""
        self.types.append(name)
        return f"{dice.choice(['', '', '@appendable ', '@mutable '])}union {name} switch ({switch}) {{\n{cases}{other}}};\n"

    def enum(self, depth):
        name = self.name()
        enumerators = [self.name() for _ in range(self.dice.randrange(1, 4))]
        chosen = self.dice.choice([None, *enumerators])
        spelled = [f"{'@default_literal ' if each == chosen else ''}{each}" for each in enumerators]
        spelled[-1] = self.dice.choice(["", "@value(40) "]) + spelled[-1]
        self.types.append(name)
        self.enums[name] = enumerators
        return f"{self.dice.choice(['', '@bit_bound(8) '])}enum {name} {{ {', '.join(spelled)} }};\n"

    def bitmask(self, depth):
        name = self.name()
        self.types.append(name)
        bound = self.dice.choice(["", "@bit_bound(40) "])
        most = 40 if bound or not self.strict else 32
        return f"{bound}bitmask {name} {{ {self.name()}, @position({self.dice.randrange(1, most)}) {self.name()} }};\n"

    def bitset(self, depth):
        name = self.name()
        self.types.append(name)
        return f"bitset {name} {{ bitfield<{self.dice.randrange(1, 30)}> {self.name()}; bitfield<3>; bitfield<5, int8> {self.name()}; }};\n"

    def typedef(self, depth):
        name = self.name()
        text = f"typedef {self.type()} {name}{self.dice.choice(['', '[4]', '[2][3]'])};\n"
        self.types.append(name)
        return text

    def constant(self, depth):
        number = f"{self.dice.randrange(0 if self.strict else -9, 30)} {self.dice.choice('+*|&')} {self.dice.randrange(0, 4)}"
        return f"const {self.dice.choice(['long', 'octet', 'short', 'int8'])} {self.name()} = {number};\n"

    def interface(self, depth):
        dice = self.dice
        types, exceptions = list(self.types), list(self.exceptions)
        name = self.name()
        inside = "".join(dice.choice([self.struct, self.enum, self.union, self.typedef, self.recursive])(9) for _ in range(dice.choice([0, 0, 1, 2])))
        calls = "".join(dice.choice([self.operation, self.operation, self.attribute])() for _ in range(dice.randrange(0, 4)))
        base = f" : {dice.choice(self.interfaces)}" if self.interfaces and dice.random() < 0.4 else ""
        self.enums = {each: values for each, values in self.enums.items() if each in types}
        self.types, self.exceptions = types, exceptions
        self.interfaces.append(name)
        return f"interface {name}{base} {{\n{inside}{calls}}};\n"

    def operation(self):
        dice = self.dice
        kinds = [f"{dice.choice(['in', 'out', 'inout'])} {self.type_or_reference()} {self.name()}" for _ in range(dice.randrange(0, 3))]
        raises = f" raises ({dice.choice(self.exceptions)})" if self.exceptions and dice.random() < 0.3 else ""
        if dice.random() < 0.1:
            return f"  oneway void {self.name()}(in {self.type()} {self.name()});\n"
        note = dice.choice(["", "", "@idempotent ", "@optional "])
        return f"  {note}{dice.choice(['void', self.type()])} {self.name()}({', '.join(kinds)}){raises};\n"

    def type_or_reference(self):
        return self.dice.choice(self.interfaces) if self.interfaces and self.dice.random() < 0.2 else self.type()

    def attribute(self):
        return f"  {self.dice.choice(['', 'readonly '])}attribute {self.type()} {self.name()};\n"
