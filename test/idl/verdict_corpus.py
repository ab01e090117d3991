"""Small IDL files, right and wrong, of one or two concepts each."""

import random
import re

SIGNED = {"int8": 8, "short": 16, "int16": 16, "long": 32, "int32": 32, "long long": 64, "int64": 64}
UNSIGNED = {"octet": 8, "uint8": 8, "unsigned short": 16, "uint16": 16, "unsigned long": 32, "uint32": 32,
            "unsigned long long": 64, "uint64": 64}  # fmt: skip
OTHERS = ["boolean", "char", "wchar", "float", "double", "string", "wstring"]
SIMPLE = list(SIGNED) + list(UNSIGNED) + OTHERS
KEYWORDS = """
    abstract any alias attribute bitfield bitmask bitset boolean case char component connector const consumes context custom
    default double emits enum eventtype exception factory FALSE finder fixed float getraises home import in inout interface int8
    local long manages map mirrorport module multiple native Object octet oneway out port porttype primarykey private provides
    public publishes raises readonly sequence setraises short string struct supports switch TRUE truncatable typedef typeid
    typename typeprefix uint64 union unsigned uses ValueBase valuetype void wchar wstring
""".split()
_TOKEN = re.compile(r'"[^"\n]*"|[A-Za-z_]\w*|\d+|\s+|.', re.DOTALL)


class Dice(random.Random):
    def name(self):
        return self.choice("abfgknpqvxyz") + str(self.randrange(1, 100))

    def integer(self):
        return self.choice([*SIGNED, *UNSIGNED])

    def small(self):
        return self.randrange(1, 9)

    def simple(self):
        return self.choice(SIMPLE)

    def near_limits(self, kind):
        """A value within the range of an integer type or just beyond it."""
        bits = SIGNED.get(kind) or UNSIGNED[kind]
        least, greatest = (-(1 << bits - 1), (1 << bits - 1) - 1) if kind in SIGNED else (0, (1 << bits) - 1)
        return self.choice([least - 1, least, least + 1, 0, 1, greatest - 1, greatest, greatest + 1])


TEMPLATES = []


def template(function):
    TEMPLATES.append(function)
    return function


def files(seed, count):
    """Different files; of each the template's name and the text."""
    made = {}
    number = 0
    while len(made) < count:
        dice = Dice(f"{seed} {number}")
        template = TEMPLATES[number % len(TEMPLATES)]
        text = template(dice)
        if "#" not in text and "::" not in text and dice.random() < 0.3:
            text = f"module w {{\n{text}\n}};"
        made.setdefault(text + "\n", template.__name__)
        number += 1
    return [(name, text) for text, name in made.items()]


# ---- lexical conventions


@template
def integer_literal(d):
    said = d.choice([
        "0", "7", "007", "08", "019", "0x1F", "0XaB", "0x", "0xG1", "12L", "1_000", "1'000", "0b11", "00", "1 2", "- 3", "+4", "--5",
        "0x 5",
    ])  # fmt: skip
    return f"const {d.choice(['long', 'short', 'uint64'])} {d.name()} = {said};"


@template
def floating_literal(d):
    said = d.choice([
        "1.", ".5", "1e3", "1.5E-3", "1e", "1.5f", ".", "1.e5", "0x1p3", "1d", "1.5D", "7", "-2.5", "1e400", "1e39", "1e+2", "1..2", "e5",
        "- .5",
    ])  # fmt: skip
    return f"const {d.choice(['float', 'double'])} {d.name()} = {said};"


@template
def character_literal(d):
    said = d.choice([
        "'a'", r"'\n'", r"'\x41'", r"'\101'", "'ab'", "''", r"'\q'", "'\"'", r"'\''", "L'a'", r"'\0'", r"'\x1ff'", r"'\u0041'", "'é'", "'",
        "\"a\"", "65", r"'\\'", r"'\?'", r"'\377'", r"'\777'", "' '",
    ])  # fmt: skip
    return f"const char {d.name()} = {said};"


@template
def wide_character_literal(d):
    said = d.choice([
        "L'a'", r"L'\n'", r"L'\x41'", r"L'\u20ac'", r"L'\u12345'", "L'é'", "'a'", "L''", "L'ab'", "l'a'", "L\"a\"", "L 'a'", "65",
    ])  # fmt: skip
    return f"const wchar {d.name()} = {said};"


@template
def text_literal(d):
    said = d.choice([
        '"a"', '"a" "b"', r'"a\n"', r'"\x41\101"', '"', '"a', r'"a\0b"', r'"\q"', 'L"a"', "'a'", '""', '"é"', r'"\u0041"', '"a""b"',
        '"a"\n"b"', '"a\nb"', r'"\""', '"a" L"b"', "5", '"//"', '"/*"', r'"\\"', '"a" + "b"',
    ])  # fmt: skip
    return f"const string {d.name()} = {said};"


@template
def wide_text_literal(d):
    said = d.choice(['L"a"', 'L"a" L"b"', r'L"\u20ac"', '"a"', r'L"\0"', 'L"é"', "L'a'", 'L""', 'L"a" "b"', r'L"\n"'])
    return f"const wstring {d.name()} = {said};"


@template
def boolean_literal(d):
    said = d.choice(["TRUE", "FALSE", "true", "True", "false", "1", "0", "TRUE | FALSE", "!TRUE", "(TRUE)", '"TRUE"', "~TRUE"])
    return f"const boolean {d.name()} = {said};"


@template
def comment(d):
    said = d.choice([
        "// a", "/* a */", "/* a\n b */", "/* /* */", "/* /* */ */", "/* a", "// a \\\nlong q;", "/// a", "/** a */", "# a", "-- a", "; ",
        "*/", "/*/ a */",
    ])  # fmt: skip
    return f"struct S {{\n  long a; {said}\n  short b;\n}};"


@template
def identifier(d):
    said = d.choice([
        "a", "a1", "_a", "__a", "_1", "1a", "a_", "a__b", "a-b", "a$", "é", "a.b", "A" * 100, "a b", "_", "a'", "Z9_", "___", "@a", "a::b",
    ])  # fmt: skip
    return d.choice([f"struct {said} {{ long m; }};", f"struct S {{ long {said}; }};", f"const long {said} = 1;", f"enum E {{ {said} }};"])


@template
def keyword_as_name(d):
    said = d.choice(KEYWORDS)
    return d.choice([
        f"struct {said} {{ long m; }};", f"struct S {{ long {said}; }};", f"module {said} {{ const long c = 1; }};",
        f"enum E {{ A, {said} }};",
    ])  # fmt: skip


@template
def keyword_in_other_case(d):
    said = d.choice(KEYWORDS).swapcase()
    return d.choice([
        f"struct {said} {{ long m; }};", f"struct S {{ long {said}; }};", "Struct S { long a; };", "struct S { Long a; };", "MODULE m {};",
        "const LONG a = 1;",
    ])  # fmt: skip


@template
def escaped_name(d):
    word = d.choice(["struct", "long", "a", "class", "int", "Boolean"])
    return d.choice([
        f"struct S {{ long _{word}; }};", f"struct _{word} {{ long m; }};", f"enum E {{ _{word} }};", "struct S { long a; long _a; };",
        "struct _S { long a; }; struct T { S s; };", "struct S { long a; }; struct T { _S s; };", "const long _c = 1; const long d = c;",
        f"module _{word} {{ const long c = 1; }};", f"struct S {{ long __{word}; }};", "typedef long _t; typedef t u;",
    ])  # fmt: skip


@template
def name_of_cpp(d):
    said = d.choice("class int auto template new delete operator this NULL std and static for register".split())
    return f"struct S {{ long {said}; }};"


# ---- constants


@template
def constant_range(d):
    kind = d.integer()
    return f"const {kind} {d.name()} = {d.near_limits(kind)};"


@template
def constant_range_hexadecimal(d):
    kind = d.integer()
    value = d.near_limits(kind)
    return f"const {kind} {d.name()} = {'-' if value < 0 else ''}{d.choice([hex, lambda n: f'0{n:o}'])(abs(value))};"


@template
def constant_expression(d):
    a, b = d.randrange(0, 20), d.randrange(0, 5)
    said = d.choice([
        f"{a} + {b}", f"{a} - {b}", f"{a} * {b}", f"{a} / {b}", f"{a} % {b}", f"{a} << {b}", f"{a} >> {b}", f"{a} | {b}", f"{a} ^ {b}",
        f"{a} & {b}", f"({a} + {b}) * 2", f"~{a}", f"-{a}", f"+{a}", f"-({a} - {b})", f"{a} +", f"* {a}", f"({a}", f"{a} ** {b}",
        f"{a} && {b}", f"{a} == {b}", f"{a} ? 1 : 2", f"!{a}", f"{a} +- {b}", f"1 + {a} << {b}",
    ])  # fmt: skip
    return f"const {d.choice(['long', 'int64', 'uint16', 'octet', 'short'])} {d.name()} = {said};"


@template
def constant_shift(d):
    by = d.choice([-1, 0, 1, 7, 8, 15, 16, 31, 32, 63, 64, 100])
    return f"const {d.integer()} {d.name()} = {d.choice([1, 2, 255])} {d.choice(['<<', '>>'])} {by};"


@template
def floating_expression(d):
    said = d.choice([
        "1.5 + 2", "1 / 2.0", "1.0 / 0", "1.0 / 0.0", "5.0 % 2.0", "1.0 << 2", "~1.0", "-1.0", "1.5 * 1.5", "1.0 | 1", "(1.0)", "1 / 2",
        "1e300 * 1e300", "1e30 * 1e30",
    ])  # fmt: skip
    return f"const {d.choice(['float', 'double'])} {d.name()} = {said};"


@template
def constant_of_other_type(d):
    kind = d.choice(["long", "octet", "double", "float", "boolean", "char", "wchar", "string", "wstring", "uint64"])
    said = d.choice(["1", "1.5", "'a'", "L'a'", '"a"', 'L"a"', "TRUE", "-1"])
    return f"const {kind} {d.name()} = {said};"


@template
def constant_reference(d):
    value = d.choice([3, 200, 70000])
    said = d.choice(["a", "a + 1", "-a", "a * a", "b", "c", "S", "::a", "m::a", "A", "a::b", "::m::a", "m"])
    kind = d.choice(["long", "short", "octet", "double", "boolean", "string"])
    return f"const long a = {value};\nstruct S {{ long x; }};\nconst {kind} b = {said};"


@template
def constant_of_type(d):
    kind = d.choice(["S", "E", "T", "Q", "sequence<long>", "A", "F", "void", "any", "fixed"])
    value = d.choice(["1", "X", "E::X", '"a"', "{1}"])
    types = "struct S { long x; }; enum E { X, Y }; typedef long T; typedef sequence<long> Q; typedef long A[2]; typedef T F;"
    return f"{types}\nconst {kind} c = {value};"


@template
def constant_text_bound(d):
    length = d.randrange(0, 6)
    wide = d.choice([("string", ""), ("wstring", "L")])
    return f'const {wide[0]}<{d.randrange(1, 5)}> {d.name()} = {wide[1]}"{"a" * length}";'


@template
def constant_enumerator(d):
    said = d.choice(["A", "B", "E::A", "F::C", "C", "1", "Z", "E::C", "e", "A + 1", "E", "::A", "A | B", "(A)"])
    return f"enum E {{ A, B }};\nenum F {{ C }};\nconst {d.choice(['E', 'E', 'E', 'long'])} c = {said};"


# ---- modules, scopes and names


@template
def module(d):
    return d.choice([
        "module a { const long x = 1; };\nmodule a { const long y = x; };", "module a { };",
        "module a { module b { struct S { long x; }; }; };", "module a { const long x = 1; };\nmodule a { const long x = 2; };",
        "module a { module a { const long x = 1; }; };", "module a { const long x = 1; }", "module { const long x = 1; };", "module a;",
        "module a::b { const long x = 1; };", "struct a { long x; };\nmodule a { const long x = 1; };",
        "module a { const long x = 1; };\nstruct a { long x; };", "module a { struct a { long x; }; };",
        "module a { typedef long T; };\nmodule b { typedef a::T T; };", "module a { struct S; };\nmodule a { struct S { long x; }; };",
        "module a { struct S { long x; }; ; };", "module a { enum E { X }; }; module b { enum E { X }; };",
    ])  # fmt: skip


@template
def scoped_name(d):
    used = d.choice([
        "S", "a::S", "::a::S", "a::b::T", "b::T", "::b::T", "T", "a::T", "::S", "a::b::S", "a:: b ::T", "a.S", "a::", "::", "a::b", "x::S",
        "c::S", "a::S::x",
    ])  # fmt: skip
    return f"module a {{ struct S {{ long x; }}; module b {{ struct T {{ long x; }}; }}; }};\nmodule c {{ struct U {{ {used} m; }}; }};"


@template
def lookup_outwards(d):
    used = d.choice(["S", "T", "a::T", "b::T", "::T", "::S", "a::b::T", "c::T", "U", "V"])
    inner = f"module b {{ typedef short T; struct U {{ {used} m; }}; typedef long V; }};"
    return f"struct S {{ long x; }};\nmodule a {{ typedef long T; {inner} }};"


@template
def hiding(d):
    return d.choice([
        "typedef long T;\nmodule a { typedef string T; const T c = \"x\"; };",
        "typedef string T;\nmodule a { const T c = \"x\"; typedef long T; };",
        "typedef long T;\nmodule a { struct S { T x; }; typedef short T; };", "typedef long T;\nstruct S { T T; };",
        "typedef long T;\nstruct S { T t; };", "typedef long T;\nstruct S { ::T T; };",
        "module a { typedef long T; };\nmodule b { struct S { a::T T; }; };", "module a { typedef long T; };\nstruct S { a::T a; };",
        "const long N = 3;\nstruct S { long N[N]; };", "const long N = 3;\nstruct S { sequence<long, N> x; long N; };",
        "struct S { long S; };", "enum E { E };", "module a { const long a = 1; };", "struct S { struct T { long x; } T; };",
        "union U switch (long) { case 1: long U; };",
    ])  # fmt: skip


@template
def case_of_names(d):
    return d.choice([
        "struct S { long a; long A; };", "struct Foo { long x; };\nstruct foo { long x; };",
        "struct Foo { long x; };\nstruct B { foo x; };", "enum E { a, A };", "const long a = 1; const long A = 2;",
        "module M { const long x = 1; };\nmodule m { const long y = 1; };", "struct Foo { long foo; };",
        "module M { typedef long T; };\ntypedef m::T U;", "typedef long T; struct S { T t; };",
        "enum E { A }; union U switch (E) { case a: long x; };", "const long N = 2; struct S { long a[n]; };",
        "union U switch (long) { case 1: long a; case 2: long A; };",
    ])  # fmt: skip


@template
def declared_twice(d):
    one = [
        "struct X { long a; };", "typedef long X;", "const long X = 1;", "enum X { P, Q };", "union X switch (long) { case 1: long a; };",
        "enum Z { X };", "struct X;", "module X { const long b = 1; };", "bitmask X { B0 };", "exception X { long a; };",
        "interface X { };",
    ]  # fmt: skip
    return d.choice(one) + "\n" + d.choice(one)


# ---- types


@template
def spelling_of_type(d):
    kind = d.choice(SIMPLE + [
        "int", "long long long", "unsigned", "signed long", "unsigned octet", "unsigned char", "int128", "uint7", "long double", "bool",
        "byte", "string*", "unsigned int8", "long unsigned", "unsigned  long\nlong", "size_t", "void", "long short", "double long", "Long",
        "unsigned float", "uint", "float32",
    ])  # fmt: skip
    return d.choice([
        f"struct S {{ {kind} a; }};", f"typedef {kind} T;", f"struct S {{ sequence<{kind}> a; }};", f"struct S {{ {kind} a[2]; }};",
    ])  # fmt: skip


@template
def unknown_type(d):
    name = d.name()
    return d.choice([
        f"struct S {{ {name} a; }};", f"typedef {name} T;", f"struct S {{ sequence<{name}> a; }};", f"const {name} c = 1;",
        f"struct S : {name} {{ long a; }};", f"union U switch ({name}) {{ case 1: long a; }};",
        f"union U switch (long) {{ case 1: {name} a; }};", f"struct S {{ long a[{name}]; }};", f"struct S {{ string<{name}> a; }};",
        f"struct S {{ {name}::T a; }};", f"struct S {{ ::{name} a; }};",
    ])  # fmt: skip


@template
def typedef(d):
    kind = d.simple()
    return d.choice([
        f"typedef {kind} A; typedef A B; struct S {{ B x; }};", f"typedef {kind} A, B, C;", f"typedef {kind} A[{d.small()}], B;",
        f"typedef sequence<{kind}> A; struct S {{ A x[2]; }};", "typedef A A;", f"typedef {kind} A; typedef {kind} A;", f"typedef {kind};",
        "typedef struct S { long x; } T;", "typedef enum E { X } T;", f"typedef {kind} A, A;", f"typedef {kind} A B;",
        f"typedef {kind} A,;", "typedef struct S { long x; };", "typedef struct { long x; } T;",
        "typedef union U switch (long) { case 1: long a; } T;", "typedef B A; typedef long B;",
        f"typedef sequence<{kind}, {d.small()}> A; typedef sequence<A> B;", f"typedef {kind} A[2]; struct S {{ A x[3]; sequence<A> y; }};",
    ])  # fmt: skip


def _bound(d):
    return d.choice([
        str(d.small()), str(d.randrange(9, 70000)), "0", "-1", "1.5", "N", "N + 1", "2 * 3", '"a"', "X", "'a'", "TRUE", "M", "N - 5", "(3)",
        "0x10", "010", "2147483647", "2147483648", "4294967295", "4294967296", "1 << 3", "Z", "", "S", "1 | 2", "~0", "N::N",
    ])  # fmt: skip


_SIZES = "const long N = 5; const short M = -2; const double Z = 3.0; enum E { X, Y };\n"


@template
def sequence_bound(d):
    return f"{_SIZES}struct S {{ sequence<{d.simple()}, {_bound(d)}> a; }};"


@template
def text_bound(d):
    return f"{_SIZES}struct S {{ {d.choice(['string', 'wstring'])}<{_bound(d)}> a; }};"


@template
def array_size(d):
    return f"{_SIZES}struct S {{ {d.simple()} a{d.choice(['', '[2]'])}[{_bound(d)}]; }};"


@template
def sequence_form(d):
    return d.choice([
        f"struct S {{ sequence<sequence<{d.simple()}>> a; }};", f"struct S {{ sequence<sequence<{d.simple()}> > a; }};",
        "struct S { sequence<long>[3] a; };", "struct S { long[3] a; };", "struct S { sequence<long a> b; };",
        "struct S { sequence<> a; };", "struct S { sequence a; };", "struct S { sequence long a; };",
        f"struct S {{ sequence<{d.simple()}> a[{d.small()}]; }};", "struct S { sequence<long,> a; };",
        "struct S { sequence<long, 2, 3> a; };", "struct S { sequence<long[3]> a; };",
        f"struct S {{ sequence<sequence<{d.simple()}, 2>, {d.small()}> a; }};", "struct S { sequence<string<3>> a; };",
        "struct S { sequence<3> a; };", "struct S { sequence(long) a; };", f"sequence<{d.simple()}> a;",
        "struct S { sequence<sequence<sequence<long>>> a; };", "struct S { sequence<struct T { long x; }> a; };",
        "struct S { sequence<S> a; };", "struct S { sequence<long, 8 >> 1> a; };", "struct S { sequence<long, (8 >> 1)> a; };",
        "struct S { string<3>> a; };", "struct S { string<> a; };", "struct S { list<long> a; };",
    ])  # fmt: skip


@template
def struct(d):
    a, b = d.name(), d.name()
    return d.choice([
        f"struct S {{ {d.simple()} {a}; {d.simple()} {b}x; }};", "struct S { };", f"struct S {{ long {a}; short {a}; }};",
        f"struct S {{ long {a} }};", f"struct S {{ long {a}; }}", f"struct S {{ long {a}, {b}x, c; }};", f"struct S {{ long {a}, {a}; }};",
        "struct S { S a; };", "struct S { S a[2]; };", "struct S { long; };", f"struct S {{ {a}; }};", f"struct {{ long {a}; }};",
        f"struct S {{ long {a};; }};", f"struct S {{ long {a}, ; }};", f"struct S long {a}; ;", f"struct S {{ {{ long {a}; }} }};",
        f"struct S {{ long {a}; }};;", f"struct S {{ long {a} = 3; }};", f"struct S {{ const long {a} = 3; }};",
        f"struct S {{ typedef long T; T {a}; }};", f"struct S {{ long {a}; }} x;", f"struct S {{ long {a}[2], {b}x[3][4]; }};",
        f"struct S ( long {a}; );", f"struct S {{ public long {a}; }};", f"struct S {{ long {a}: 3; }};", f"struct S {{ long *{a}; }};",
        f"struct S {{ void {a}; }};",
    ])  # fmt: skip


@template
def struct_inside(d):
    return d.choice([
        "struct S { struct T { long x; } t; };", "struct S { enum E { A, B } e; };",
        "struct S { union U switch (long) { case 1: long x; } u; };", "struct S { struct T { long x; }; T t; };",
        "struct S { struct { long x; } t; };", "struct S { struct T { long x; } t; T u; };",
        "struct S { enum E { A } e; }; struct V { S::E f; };", "struct S { struct T { long x; } t, u[2]; };",
    ])  # fmt: skip


@template
def inheritance(d):
    return d.choice([
        "struct A { long a; };\nstruct B : A { long b; };", "struct B : A { long b; };", "struct A { long a; };\nstruct B : A { long a; };",
        "struct B : B { long b; };", "struct A;\nstruct B : A { long b; };\nstruct A { long a; };",
        "typedef long A;\nstruct B : A { long b; };", "enum A { X };\nstruct B : A { long b; };",
        "union A switch (long) { case 1: long a; };\nstruct B : A { long b; };",
        "struct A { long a; };\ntypedef A T;\nstruct B : T { long b; };", "struct A { long a; };\nstruct B : A { };",
        "struct A { long a; };\nstruct C { long c; };\nstruct B : A, C { long b; };",
        "struct A { long a; };\nstruct B : A { long b; };\nstruct C : B { long c; };",
        "struct A { long a; };\nstruct B : A { long b; };\nstruct C : B { long a; };",
        "module m { struct A { long a; }; };\nstruct B : m::A { long b; };", "struct A { long a; };\nstruct B : ::A { long b; };",
        "struct A { long a; };\nstruct B : { long b; };", "struct A { long a; };\nstruct B extends A { long b; };",
        "struct A { @key long a; };\nstruct B : A { @key long b; };", "struct A { @key long a; };\nstruct B : A { long b; };",
        "union B : A switch (long) { case 1: long a; };", "exception A { long a; };\nstruct B : A { long b; };",
        "@mutable struct A { long a; };\n@final struct B : A { long b; };",
        "@appendable struct A { long a; };\n@appendable struct B : A { long b; };", "typedef sequence<long> A;\nstruct B : A { long b; };",
    ])  # fmt: skip


@template
def forward_declaration(d):
    return d.choice([
        "struct S;\nstruct S { long a; };", "struct S;", "struct S;\nstruct T { S s; };\nstruct S { long a; };",
        "struct S;\nstruct S;\nstruct S { long a; };", "struct S { long a; };\nstruct S;", "struct S { long a; };\nstruct S { long a; };",
        "union U;\nunion U switch (long) { case 1: long a; };", "union U;", "struct S;\nunion S switch (long) { case 1: long a; };",
        "union S;\nstruct S { long a; };", "struct S;\ntypedef S T;\nstruct S { long a; };", "enum E;\nenum E { A };",
        "interface I;\nstruct S { long a; };", "struct S;\nstruct T { S s[2]; };\nstruct S { long a; };",
        "struct S;\nmodule m { struct S { long a; }; };", "module m { struct S; };\nstruct S { long a; };", "struct S : T;",
        "@final struct S;\n@final struct S { long a; };",
    ])  # fmt: skip


@template
def recursion(d):
    return d.choice([
        "struct S { sequence<S> a; };", "struct S;\nstruct S { sequence<S> a; };", "struct S;\ntypedef sequence<S> Q;\nstruct S { Q a; };",
        "struct S;\nstruct T { sequence<S> s; };\nstruct S { long a; };", "struct S;\nstruct T { sequence<S> s; };\nstruct S { T a; };",
        "union U;\ntypedef sequence<U> Q;\nunion U switch (long) { case 1: Q a; case 2: long b; };",
        "union U switch (long) { case 1: sequence<U> a; };", "union U switch (long) { case 1: U a; };",
        "struct S;\nstruct S { sequence<S, 1> a; long b; };", "struct S { @optional S a; };", "struct S;\nstruct T { sequence<S> s; };",
    ])  # fmt: skip


# ---- enumerations and unions


@template
def enumeration(d):
    a, b = d.name(), d.name() + "x"
    return d.choice([
        f"enum E {{ {a}, {b} }};", "enum E { };", f"enum E {{ {a}, {b}, }};", f"enum E {{ {a}, {a} }};",
        f"enum E {{ {a} }}; enum F {{ {a} }};", f"enum E {{ {a} {b} }};", f"enum E {{ {a} = 3, {b} }};", f"enum E {{ {a}; {b} }};",
        f"enum {{ {a} }};", f"enum E {{ {a}, {b} }}", f"enum E {{ {a}, @default_literal {b} }};", f"enum E {{ {a}, 3 }};",
        f"enum E : long {{ {a} }};", f"enum class E {{ {a} }};", f"enum E {{ {a} }}; struct {a} {{ long x; }};",
        f"module m {{ enum E {{ {a} }}; }}; enum F {{ {a} }};", f"enum E {{ {a} }}; struct S {{ E e; E {b}[2]; sequence<E> c; }};",
        f"enum E {{ ,{a} }};", f"enum E {{ {a}, {b} }}; struct S {{ long {a}; }};", f"enum E {{ {a} }}; struct S {{ {a} x; }};",
        f"enum E {{ @default_literal {a}, @default_literal {b} }};", f"enum E {{ \"{a}\" }};",
    ])  # fmt: skip


@template
def enumeration_values(d):
    return d.choice(["", "", "@bit_bound(8) ", "@bit_bound(16) ", "@bit_bound(0) ", "@bit_bound(33) ", "@bit_bound(1) "]) + (
        f"enum E {{ @value({d.choice([0, 1, 5, -1, 127, 128, 255, 300, 65536, 2147483647, 2147483648])}) A, "
        f"{d.choice(['', '@value(1) ', '@value(6) ', '@value(0) ', '@value(A) '])}B }};")  # fmt: skip


@template
def union_switch(d):
    kind, label = d.choice([
        ("long", "1"), ("short", "1"), ("octet", "1"), ("int8", "1"), ("uint8", "1"), ("uint16", "1"), ("unsigned long", "1"),
        ("long long", "1"), ("uint64", "1"), ("char", "'a'"), ("wchar", "L'a'"), ("boolean", "TRUE"), ("E", "A"), ("T", "2"),
        ("float", "1"), ("double", "1.0"), ("string", '"a"'), ("wstring", 'L"a"'), ("S", "1"), ("sequence<long>", "1"),
        ("enum F { B }", "B"), ("", "1"), ("M", "1"), ("M", "B0"), ("@key long", "1"), ("any", "1"), ("V", "B"), ("string<3>", '"a"'),
        ("long a", "1"), ("W", "1"),
    ])  # fmt: skip
    types = "enum E { A, C }; typedef short T; struct S { long x; }; typedef E V; typedef S W;"
    return f"{types}\nunion U switch ({kind}) {{ case {label}: {d.simple()} a; }};"


@template
def union_label_range(d):
    kind = d.integer()
    return f"union U switch ({kind}) {{ case {d.near_limits(kind)}: long a; case 5: short b; }};"


@template
def union_label_twice(d):
    kind, labels = d.choice([
        ("long", ["1", "2", "1 + 1", "N", "0x1", "2"]), ("char", ["'a'", "'b'", r"'\x61'"]), ("boolean", ["TRUE", "FALSE"]),
        ("E", ["A", "B", "E::A"]), ("octet", ["1", "2", "3"]), ("short", ["-1", "1", "-1"]),
    ])  # fmt: skip
    one, two = d.choice(labels), d.choice(labels)
    between = d.choice([": short a; case ", ": case "])
    return f"const long N = 2; enum E {{ A, B, C }};\nunion U switch ({kind}) {{ case {one}{between}{two}: long b; }};"


@template
def union_label_of_other_type(d):
    kind = d.choice(["long", "char", "boolean", "E", "octet", "T", "wchar", "uint64"])
    label = d.choice([
        "1", "'a'", "TRUE", "A", "E::B", "1.5", '"a"', "X", "N", "L'a'", "F::X", "(1)", "-1", "A | B", "~0", "Z", "::A", "1 << 2", "S",
    ])  # fmt: skip
    types = "const short N = 2; enum E { A, B }; enum F { X }; typedef long T; struct S { long x; };"
    return f"{types}\nunion U switch ({kind}) {{ case {label}: long a; }};"


@template
def union_default(d):
    return "enum E { A, B };\n" + d.choice([
        "union U switch (long) { case 1: long a; default: short b; };", "union U switch (long) { default: short b; };",
        "union U switch (long) { default: long a; default: short b; };", "union U switch (long) { default: short b; case 1: long a; };",
        "union U switch (long) { case 1: default: long a; };", "union U switch (long) { default: case 1: long a; };",
        "union U switch (boolean) { case TRUE: long a; case FALSE: short b; default: char c; };",
        "union U switch (boolean) { case TRUE: long a; default: short b; };",
        "union U switch (E) { case A: long a; case B: short b; default: char c; };",
        "union U switch (E) { case A: case B: long a; default: char c; };", "union U switch (E) { case A: long a; default: char c; };",
        "union U switch (E) { case A: case B: default: long a; };", "union U switch (long) { case 1: long a; default: };",
        "union U switch (long) { default long a; };", "union U switch (long) { case default: long a; };",
    ])  # fmt: skip


@template
def union_form(d):
    kind = d.simple()
    return d.choice([
        "union U switch (long) { };", f"union U switch (long) {{ case 1: {kind} a; case 2: {kind} a; }};",
        f"union U switch (long) {{ case 1: {kind}; }};", f"union U switch (long) {{ case 1 {kind} a; }};",
        f"union U (long) {{ case 1: {kind} a; }};", f"union U {{ case 1: {kind} a; }};", f"union U switch long {{ case 1: {kind} a; }};",
        f"union U switch (long) {{ {kind} a; }};", f"union U switch (long) {{ case: {kind} a; }};",
        f"union U switch (long) {{ case 1: {kind} a, b; }};", f"union U switch (long) {{ case 1: {kind} a; {kind} b; }};",
        f"union U switch (long) {{ case 1: {kind} a }};", f"union U switch (long) {{ case 1, 2: {kind} a; }};",
        f"union U switch (long) {{ case 1: {kind} a[{d.small()}]; }};", f"union U switch (long) {{ case 1: sequence<{kind}> a; }};",
        "union U switch (long) { case 1: struct T { long x; } a; };",
        f"union U switch (long) {{ case 1: case 2: case 3: {kind} a; case 4: long b; }};", f"union U switch (long) {{ case 1: {kind} a; }}",
        f"union switch (long) {{ case 1: {kind} a; }};", "union U switch (long) { case 1: void; };",
        f"union U switch (long) {{ 1: {kind} a; }};", f"union U switch (long) {{ case 1..3: {kind} a; }};",
        f"union U switch (enum E {{ A }}) {{ case A: {kind} a; }};", f"union U switch (long) {{ case 1: @id(3) {kind} a; }};",
        "union U switch (long) { case 1: enum E { A, B } e; };",
    ])  # fmt: skip


# ---- keys and annotations


_KEYABLE = """struct P { long x; string s; };
struct K { @key long x; long y; };
enum E { A, B };
union V switch (long) { case 1: long a; };
typedef string T;
typedef long L[2];
"""


@template
def key(d):
    kind = d.choice(SIMPLE + ["P", "K", "E", "V", "T", "L", "sequence<long>", "sequence<string>", "string<5>", "map<long, long>"])
    said = d.choice(["@key", "@key", "@key", "@key(TRUE)", "@key(FALSE)", "@Key", "@ key", "@key()", "@key(1)"])
    return _KEYABLE + f"struct S {{ {said} {kind} a{d.choice(['', '', '', '[2]'])}; long b; }};"


@template
def key_elsewhere(d):
    return d.choice([
        "struct S { @key @optional long a; long b; };", "struct S { long @key a; };", "@key struct S { long a; };",
        "struct S { long a @key; };", "union U switch (@key long) { case 1: long a; };", "union U switch (long) { case 1: @key long a; };",
        "typedef @key long T;", "@key typedef long T;", "struct S { @key @key long a; };", "struct S { @key long a, b; };",
        "struct S { key long a; };", "enum E { @key A };", "@key module m { const long a = 1; };", "@key const long a = 1;",
        "struct S { sequence<@key long> a; };", "struct S { @key struct T { long x; } t; };",
    ])  # fmt: skip


@template
def keylist(d):
    return "struct S { long a; string b; sequence<long> c; };\n" + d.choice([
        "#pragma keylist S a", "#pragma keylist S a b", "#pragma keylist S z", "#pragma keylist S", "#pragma keylist T a",
        "#pragma keylist", "#pragma keylist S c", "#pragma keylist S a a", "#pragma keylists S a", "#pragma keylist S a.b",
        "#pragma keylist S a,b", "#pragma keylist S A",
    ])  # fmt: skip


@template
def annotation_on_struct(d):
    said = d.choice([
        "@final", "@appendable", "@mutable", "@nested", "@topic", "@nested(FALSE)", "@extensibility(FINAL)", "@extensibility(MUTABLE)",
        "@extensibility(OTHER)", "@extensibility(3)", "@final @mutable", "@autoid(HASH)", "@autoid(SEQUENTIAL)", "@autoid(OTHER)", "@bogus",
        "@bogus(1)", "@bogus(a = 1, b = 2)", "@", "@final(", "@final()", "@default_nested", "@1", "@data_representation(XCDR2)",
        "@verbatim(text = \"a\")", "@topic(name = \"x\")", "@bit_bound(8)", "@m::bogus", "@::final", "@final;", "@extensibility",
        "@final @final",
    ])  # fmt: skip
    return f"{said} struct S {{ {d.simple()} a; }};"


@template
def annotation_on_member(d):
    kind = d.choice(["long", "short", "octet", "double", "string", "boolean"])
    said = d.choice([
        "@id(3)", "@id(-1)", '@id("a")', "@id", "@id()", "@id(0x10000000)", "@id(268435455)", "@id(1)", "@hashid", '@hashid("q")',
        "@optional", "@optional(TRUE)", "@external", "@must_understand", "@default(1)", '@default("a")', "@default(1.5)", "@default(TRUE)",
        "@default", "@default(300)", "@default(-1)", "@range(min = 1, max = 5)", "@range(1, 5)", "@min(1)", "@max(5)", '@unit("m")',
        "@unit(m)", "@unit", "@try_construct(USE_DEFAULT)", "@try_construct(BAD)", "@bogus", "@bogus(x)", "@non_serialized", "@final",
        "@position(3)", "@value(3)", "@default(value = 1)", "@id(value = 4)", "@id(3, 4)", "@id(N)", "@id(1 + 3)", "@optional(1)",
    ])  # fmt: skip
    return f"const long N = 7;\n{d.choice(['', '@mutable '])}struct S {{ char z; {said} {kind} a; long b; }};"


@template
def identifiers_of_members(d):
    one, two, three = (d.choice(["", "", f"@id({d.randrange(0, 4)}) "]) for _ in range(3))
    return f"{d.choice(['', '@mutable ', '@appendable '])}struct S {{ {one}long a; {two}short b; {three}char c; }};"


@template
def annotation_declaration(d):
    return d.choice([
        "@annotation foo { long a; };\n@foo(a = 1) struct S { long x; };",
        "@annotation foo { long a default 3; };\n@foo struct S { long x; };", "@annotation foo { };\n@foo struct S { long x; };",
        "@annotation foo { long a; };\n@foo(b = 1) struct S { long x; };",
        "@annotation foo { long a; };\n@foo(a = \"x\") struct S { long x; };", "@annotation foo { long a }; struct S { long x; };",
        "@annotation { long a; };", "@annotation foo { long value; };\n@foo(3) struct S { long x; };",
        "@annotation foo { enum E { A, B }; E e default A; };\n@foo(e = B) struct S { long x; };", "@annotation foo { sequence<long> a; };",
        "@annotation foo { long a; };\n@annotation foo { long a; };", "annotation foo { long a; };",
        "module m { @annotation foo { long a; }; };\n@m::foo(a = 1) struct S { long x; };", "@annotation foo { long a; long a; };",
        "@annotation foo { string a default 3; };", "@annotation foo { any a; };", "@annotation foo { const long c = 1; typedef long T; };",
    ])  # fmt: skip


@template
def annotation_elsewhere(d):
    said = d.choice(["@bogus", "@final", "@nested", "@default(1)", "@id(2)"])
    return d.choice([
        f"{said} module m {{ const long c = 1; }};", f"{said} const long c = 1;", f"{said} typedef long T;", f"{said} enum E {{ A }};",
        f"enum E {{ {said} A }};", f"union U switch ({said} long) {{ case 1: long a; }};",
        f"{said} union U switch (long) {{ case 1: long a; }};", f"struct S {{ sequence<{said} long> a; }};",
        f"struct S {{ long a {said}; }};", f"struct S {{ long a {said} [2]; }};", f"{said}", f"struct S {{ {said} }};",
        f"struct {said} S {{ long a; }};", f"union U switch (long) {{ {said} case 1: long a; }};", f"typedef {said} long T;",
        f"const {said} long c = 1;",
    ])  # fmt: skip


# ---- extended types


@template
def bitmask(d):
    return d.choice(["", "", "@bit_bound(8) ", "@bit_bound(64) ", "@bit_bound(65) ", "@bit_bound(0) ", "@bit_bound(2) "]) + d.choice([
        "bitmask M { A, B };", f"bitmask M {{ @position({d.randrange(0, 70)}) A, B }};", "bitmask M { };", "bitmask M { A, A };",
        "bitmask M { @position(1) A, @position(1) B };", "bitmask M { A, B, };", "bitmask { A };",
        "bitmask M { @position(3) A, @position(1) B, C };", "bitmask M { A = 1 };", "bitmask M { A, B, C };",
        "bitmask M { @position(-1) A };", "bitmask M { @position A };", "bitmask M { A };\nstruct S { M m; };",
        "bitmask M { A };\nbitmask N { A };", "bitmask M { @position(1) A, B, @position(2) C };", "bitmask M;",
        "bitmask M { @position(\"a\") A };",
    ])  # fmt: skip


@template
def bitset(d):
    n = d.choice([1, 3, 8, 9, 32, 63, 64, 65, 0])
    return d.choice([
        f"bitset B {{ bitfield<{n}> a; }};", f"bitset B {{ bitfield<{n}> a; bitfield<2> b; }};",
        f"bitset B {{ bitfield<{n}, {d.choice(SIMPLE)}> a; }};", "bitset B { };", "bitset B { bitfield<3> a; bitfield<3> a; };",
        "bitset B { bitfield<3>; bitfield<2> b; };", "bitset B { bitfield<3> a, b; };",
        "bitset A { bitfield<3> a; };\nbitset B : A { bitfield<2> b; };", "bitset A { bitfield<3> a; };\nbitset B : A { bitfield<2> a; };",
        "bitset B { bitfield a; };", "bitset B { long a; };", "bitset B { bitfield<3> a };", "bitset B : A { bitfield<2> a; };",
        "bitset B { bitfield<3> a; };\nstruct S { B b; };", "const long N = 4;\nbitset B { bitfield<N> a; };",
        "bitset B { bitfield<3> a; bitfield<3> };", "bitset B { @position(3) bitfield<3> a; };", "bitset B;",
    ])  # fmt: skip


@template
def map_type(d):
    one, two = d.choice(SIMPLE + ["P", "E", "sequence<long>", "V"]), d.choice(SIMPLE + ["P", "E", "sequence<long>"])
    said = d.choice([
        f"map<{one}, {two}>", f"map<{one}, {two}, {d.randrange(0, 5)}>", f"map<{one}>", "map<>", "map", f"map<{one}, {two}, 2, 3>",
        f"map<long, map<long, {two}>>", "map<long, long, -1>", f"map<Z, {two}>",
    ])  # fmt: skip
    types = "struct P { long x; }; enum E { A }; union V switch (long) { case 1: long a; };"
    return f"{types}\nstruct S {{ {said} a; }};"


# ---- what DDS needs not


@template
def exception(d):
    return d.choice([
        "exception X { long a; };", "exception X { };", "exception X { long a; long a; };", "exception X { long a; };\nstruct S { X x; };",
        "exception X;", "exception X : Y { long a; };", "exception X { long a };",
    ])  # fmt: skip


@template
def interface(d):
    return d.choice([
        "interface I { };", "interface I { void f(); };", "interface I { long f(in long a, out string b); };",
        "interface I { void f(long a); };", "interface I { void f(in long a, in long a); };", "interface I { void f(); void f(); };",
        "interface I { attribute long a; };", "interface I { readonly attribute long a; };", "interface I;",
        "interface I;\ninterface I { };", "interface I { };\ninterface J : I { void g(); };", "interface J : I { void g(); };",
        "exception X { long a; };\ninterface I { void f() raises (X); };", "interface I { void f() raises (X); };",
        "interface I { oneway void f(in long a); };", "interface I { oneway long f(); };", "interface I { f(); };",
        "interface I { oneway void f(out long a); };", "interface I { void f(in void a); };",
        "interface I { struct S { long a; }; S f(); };", "interface I { void f() };", "interface I { long a; };",
        "struct S { long a; };\ninterface I : S { };", "interface I { void f(); };\ninterface J : I { void f(); };",
        "interface I { };\ninterface J : I, I { };", "interface I { const long c = 1; };\ninterface J : I { void f(in string<c> a); };",
        "interface I { };\nstruct S { I i; };",
    ])  # fmt: skip


@template
def other_building_block(d):
    return d.choice([
        "struct S { any a; };", "struct S { fixed<5, 2> a; };", "struct S { Object a; };", "struct S { long double a; };", "typedef any T;",
        "typedef fixed<5, 2> T;", "typedef long double T;", "native N;", "native N;\nstruct S { N n; };", "valuetype V { public long a; };",
        "valuetype V long;", "valuetype V;", "local interface I { };", "abstract interface I { };", "component C { };",
        "home H manages C { };", "typeid m \"x\";", "import m;", "module m<typename T> { struct S { T a; }; };", "const fixed c = 1.5d;",
        "interface I { };\ntypeprefix I \"a\";", "eventtype V { };", "porttype P { };", "connector C { };", "typeprefix m \"a\";",
        "struct S { ValueBase a; };",
    ])  # fmt: skip


@template
def names_made_of_names(d):
    return d.choice([
        "module a_b { const long c = 1; };\nmodule a { const long b_c = 1; };",
        "module a { struct S { long x; }; };\nstruct a_S { long x; };", "struct S { struct T { long x; } t; };\nstruct S_T { long x; };",
        "module a { enum E { X }; };\nconst long a_X = 1;", "struct S { long x; };\nmodule S_T { const long c = 1; };",
        "enum E { A }; const long E_A = 1;", "struct S { long x; };\nstruct S_ { long x; };",
    ])  # fmt: skip


# ---- preprocessor and damage


@template
def preprocessor(d):
    n = d.small()
    return d.choice([
        f"#define N {n}\nstruct S {{ long a[N]; }};", "#ifdef X\nnonsense\n#endif\nstruct S { long a; };",
        "#ifndef X\nnonsense\n#endif\nstruct S { long a; };", "#if 0\nnonsense\n#else\nstruct S { long a; };\n#endif",
        '#include "missing.idl"\nstruct S { long a; };', "#include <missing.idl>\nstruct S { long a; };",
        "#error no\nstruct S { long a; };", "#pragma once\nstruct S { long a; };", '#pragma prefix "a"\nstruct S { long a; };',
        "#if 1\nstruct S { long a; };", "struct S { long a; };\n#endif", "#define T(x) long x\nstruct S { T(a); };",
        "#define N\n#undef N\nstruct S { N a; };", "#nonsense\nstruct S { long a; };", "#warning careful\nstruct S { long a; };",
        "#if 0\n#elif 1\nstruct S { long a; };\n#endif", "struct S { long \\\n a; };", "#define EMPTY\nEMPTY struct S { long a; };",
        f"#define N {n}\n#define M (N * 2)\nconst long c = M;", "#pragma\nstruct S { long a; };", "#\nstruct S { long a; };",
        "# 7 \"x.idl\"\nstruct S { long a; };", "#include\nstruct S { long a; };", "#define\nstruct S { long a; };",
        "#if\nstruct S { long a; };\n#endif", "#define A(x\nstruct S { long a; };", "#define a b\nstruct S { long a; long b; };",
        "#define CAT(x, y) x##y\nstruct S { long CAT(a, b); };", "#if defined(X) || 1\nstruct S { long a; };\n#endif",
        "  #define N 3\nconst long c = N;", "#ident \"a\"\nstruct S { long a; };", "#line 5\nstruct S { long a; };",
        "const long c = __LINE__;",
    ])  # fmt: skip


@template
def whole_file(d):
    return d.choice([
        "", " ", "// nothing", ";", "}", "{", "\t", "struct", "module", "long a;", "const", "\\", "a", "1", "\"a\"", "@", "@key", "::",
        "struct S { long a; }; extra", "using m;", "namespace a { };", "\x1a", "\f", "struct S { long a; };\x1a",
        "\ufeffstruct S { long a; };", "struct\fS { long\va; };", "struct S { long a; };\r", "é", "struct S { long a; } // ;", "#",
        "struct S { long a; };\x00",
    ])  # fmt: skip


_WHOLE = [
    "struct S { @key long a; string<5> b; sequence<double, 3> c; };",
    "enum E { A, B }; union U switch (E) { case A: long a; default: string b; };",
    "module m { const long N = 2 * 3; typedef float F[N]; };", "struct A { long x, y; };\nstruct B : A { sequence<A> z; };",
    "@appendable struct S { @id(1) long a; @optional short b; };",
]  # fmt: skip


@template
def token_missing(d):
    parts = _TOKEN.findall(d.choice(_WHOLE))
    del parts[d.choice([at for at, part in enumerate(parts) if not part.isspace()])]
    return "".join(parts)


@template
def token_doubled(d):
    parts = _TOKEN.findall(d.choice(_WHOLE))
    at = d.choice([at for at, part in enumerate(parts) if not part.isspace()])
    return "".join([*parts[: at + 1], " ", *parts[at:]])


@template
def token_replaced(d):
    parts = _TOKEN.findall(d.choice(_WHOLE))
    at = d.choice([at for at, part in enumerate(parts) if not part.isspace()])
    parts[at] = d.choice([";", "{", "}", "long", "a", "1", ":", "::", ",", "<", ">", "struct", "@", "=", "[", "(", "string"])
    return "".join(parts)
