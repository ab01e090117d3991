"""Small IDL files, right and wrong, of one or two concepts each."""

import random
import re
import string

SIGNED = {"int8": 8, "short": 16, "int16": 16, "long": 32, "int32": 32, "long long": 64, "int64": 64}
UNSIGNED = {"octet": 8, "uint8": 8, "unsigned short": 16, "uint16": 16, "unsigned long": 32, "uint32": 32,
            "unsigned long long": 64, "uint64": 64}  # fmt: skip
OTHERS = ["boolean", "char", "float", "double", "string"]
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
    """Throws what `$name` stands for in a text of a template: one of its own alternatives, or what the functions here say."""

    def __init__(self, seed, choices):
        super().__init__(seed)
        self._choices = {**_COMMON, **choices}
        self._thrown = {}

    def __getitem__(self, name):
        if name in self._choices:
            of = self._choices[name]
            return self.fill(of if isinstance(of, str) else self.choice(of))
        return getattr(self, name)()

    def fill(self, text):
        return string.Template(text).substitute(self)

    def a(self):
        """A name, always the same."""
        return self._thrown.setdefault("a", self.choice("cfgknpqvxyz") + str(self.randrange(1, 100)))

    def b(self):
        return self.a() + "x"

    def n(self):
        return str(self.randrange(1, 9))

    def whole(self):
        """An integer type, always the same."""
        return self._thrown.setdefault("whole", self.choice([*SIGNED, *UNSIGNED]))

    def limit(self):
        """A value within its range or just beyond it."""
        kind = self.whole()
        bits = SIGNED.get(kind) or UNSIGNED[kind]
        least, greatest = (-(1 << bits - 1), (1 << bits - 1) - 1) if kind in SIGNED else (0, (1 << bits) - 1)
        return str(self.choice([least - 1, least, least + 1, 0, 1, greatest - 1, greatest, greatest + 1]))

    def odd_limit(self):
        value = int(self.limit())
        return f"{'-' if value < 0 else ''}{self.choice([hex, lambda n: f'0{n:o}'])(abs(value))}"

    def damaged(self):
        """A file in which a token is missing, doubled or another."""
        parts = _TOKEN.findall(self.choice(_WHOLE))
        at = self.choice([at for at, part in enumerate(parts) if not part.isspace()])
        other = self.choice([";", "{", "}", "long", "a", "1", ":", "::", ",", "<", ">", "struct", "@", "=", "[", "(", "string"])
        parts[at : at + 1] = self.choice([[], [parts[at], " ", parts[at]], [other]])
        return "".join(parts)


def files(seed, count):
    """Different files; of each the template's name and the text."""
    made = {}
    number = 0
    while len(made) < count:
        name = list(TEMPLATES)[number % len(TEMPLATES)]
        dice = Dice(f"{seed} {number}", TEMPLATES[name])
        text = dice["text"]
        if "#" not in text and "::" not in text and dice.random() < 0.3:
            text = f"module w {{\n{text}\n}};"
        made.setdefault(text + "\n", name)
        number += 1
    return [(name, text) for text, name in made.items()]


_COMMON = {
    "kind": SIMPLE,
    "sizes": "const long N = 5; const short M = -2; const double Z = 3.0; enum E { X, Y };",
    "bound": [
        "$n", "1$n", "7000$n", "0", "-1", "1.5", "N", "N + 1", "2 * 3", '"a"', "X", "'a'", "TRUE", "M", "N - 5", "(3)", "0x10", "010",
        "2147483647", "2147483648", "4294967295", "4294967296", "1 << 3", "Z", "", "S", "1 | 2", "~0", "N::N",
    ],
    "keyable": "struct P { long x; string s; };\nstruct K { @key long x; long y; };\nenum E { A, B };\n"
               "union V switch (long) { case 1: long a; };\ntypedef string T;\ntypedef long L[2];",
}

# By their names: alternatives of what `$name` stands for in them, `text` first of all.
TEMPLATES = {
    # ---- lexical conventions
    "integer_literal": dict(text="const $kind $a = $said;", kind=["long", "short", "uint64"], said=[
        "0", "7", "007", "08", "019", "0x1F", "0XaB", "0x", "0xG1", "12L", "1_000", "1'000", "0b11", "00", "1 2", "- 3", "+4", "--5",
        "0x 5",
    ]),
    "floating_literal": dict(kind=["float", "double"], text="const $kind $a = $said;", said=[
        "1.", ".5", "1e3", "1.5E-3", "1e", "1.5f", ".", "1.e5", "0x1p3", "1d", "1.5D", "7", "-2.5", "1e400", "1e39", "1e+2", "1..2", "e5",
        "- .5",
    ]),
    "character_literal": dict(text="const char $a = $said;", said=[
        "'a'", r"'\n'", r"'\x41'", r"'\101'", "'ab'", "''", r"'\q'", "'\"'", r"'\''", "L'a'", r"'\0'", r"'\x1ff'", r"'\u0041'", "'é'", "'",
        '"a"', "65", r"'\\'", r"'\?'", r"'\377'", r"'\777'", "' '",
    ]),
    "text_literal": dict(text="const string $a = $said;", said=[
        '"a"', '"a" "b"', r'"a\n"', r'"\x41\101"', '"', '"a', r'"a\0b"', r'"\q"', 'L"a"', "'a'", '""', '"é"', r'"\u0041"', '"a""b"',
        '"a"\n"b"', '"a\nb"', r'"\""', '"a" L"b"', "5", '"//"', '"/*"', r'"\\"', '"a" + "b"',
    ]),
    "boolean_literal": dict(text="const boolean $a = $said;", said=[
        "TRUE", "FALSE", "true", "True", "false", "1", "0", "TRUE | FALSE", "!TRUE", "(TRUE)", '"TRUE"', "~TRUE",
    ]),
    "comment": dict(text="struct S {\n  long a; $said\n  short b;\n};", said=[
        "// a", "/* a */", "/* a\n b */", "/* /* */", "/* /* */ */", "/* a", "// a \\\nlong q;", "/// a", "/** a */", "# a", "-- a", "; ",
        "*/", "/*/ a */",
    ]),
    "identifier": dict(said=[
        "a", "a1", "_a", "__a", "_1", "1a", "a_", "a__b", "a-b", "a$$", "é", "a.b", "A" * 100, "a b", "_", "a'", "Z9_", "___", "@a", "a::b",
    ], text=["struct $said { long m; };", "struct S { long $said; };", "const long $said = 1;", "enum E { $said };"]),
    "keyword_as_name": dict(said=KEYWORDS, text=[
        "struct $said { long m; };", "struct S { long $said; };", "module $said { const long c = 1; };", "enum E { A, $said };",
    ]),
    "keyword_in_other_case": dict(said=[word.swapcase() for word in KEYWORDS], text=[
        "struct $said { long m; };", "struct S { long $said; };", "Struct S { long a; };", "struct S { Long a; };", "MODULE m {};",
        "const LONG a = 1;",
    ]),
    "escaped_name": dict(word=["struct", "long", "a", "class", "int", "Boolean"], text=[
        "struct S { long _$word; };", "struct _$word { long m; };", "enum E { _$word };", "struct S { long a; long _a; };",
        "struct _S { long a; }; struct T { S s; };", "struct S { long a; }; struct T { _S s; };", "const long _c = 1; const long d = c;",
        "module _$word { const long c = 1; };", "struct S { long __$word; };", "typedef long _t; typedef t u;",
    ]),
    "name_of_cpp": dict(text="struct S { long $said; };", said="class int auto template new delete operator this NULL std and static for register".split()),
    # ---- constants
    "constant_range": dict(text="const $whole $a = $limit;"),
    "constant_range_other_base": dict(text="const $whole $a = $odd_limit;"),
    "constant_expression": dict(text="const $kind $a = $said;", kind=["long", "int64", "uint16", "octet", "short"], said=[
        "$n + $n", "$n - $n", "$n * $n", "$n / $n", "$n % $n", "$n << $n", "$n >> $n", "$n | $n", "$n ^ $n", "$n & $n", "$n / 0", "$n % 0",
        "($n + $n) * 2", "~$n", "-$n", "+$n", "-($n - $n)", "$n +", "* $n", "($n", "$n ** $n", "$n && $n", "$n == $n", "$n ? 1 : 2", "!$n",
        "$n +- $n", "1 + $n << $n",
    ]),
    "constant_shift": dict(text="const $whole $a = $number $way $by;", number=["1", "2", "255"], way=["<<", ">>"],
                           by=["-1", "0", "1", "7", "8", "15", "16", "31", "32", "63", "64", "100"]),
    "floating_expression": dict(kind=["float", "double"], text="const $kind $a = $said;", said=[
        "1.5 + 2", "1 / 2.0", "1.0 / 0", "1.0 / 0.0", "5.0 % 2.0", "1.0 << 2", "~1.0", "-1.0", "1.5 * 1.5", "1.0 | 1", "(1.0)", "1 / 2",
        "1e300 * 1e300", "1e30 * 1e30",
    ]),
    "constant_of_other_type": dict(text="const $kind $a = $said;", said=["1", "1.5", "'a'", "L'a'", '"a"', 'L"a"', "TRUE", "-1"], kind=[
        "long", "octet", "double", "float", "boolean", "char", "wchar", "string", "wstring", "uint64",
    ]),
    "constant_reference": dict(text="const long a = $value;\nstruct S { long x; };\nconst $kind b = $said;", value=["3", "200", "70000"],
                               kind=["long", "short", "octet", "double", "boolean", "string"],
                               said=["a", "a + 1", "-a", "a * a", "b", "c", "S", "::a", "m::a", "A", "a::b", "::m::a", "m"]),
    "constant_of_type": dict(
        kind=["S", "E", "T", "Q", "sequence<long>", "A", "F", "void", "any", "fixed"], value=["1", "X", "E::X", '"a"', "{1}"],
        types="struct S { long x; }; enum E { X, Y }; typedef long T; typedef sequence<long> Q; typedef long A[2]; typedef T F;",
        text="$types\nconst $kind c = $value;"),
    "constant_text_bound": dict(text=['const string<$n> $a = "$said";', 'const wstring<$n> $a = L"$said";'], said=["a" * n for n in range(6)]),
    "constant_enumerator": dict(kind=["E", "E", "E", "long"], text="enum E { A, B };\nenum F { C };\nconst $kind c = $said;", said=[
        "A", "B", "E::A", "F::C", "C", "1", "Z", "E::C", "e", "A + 1", "E", "::A", "A | B", "(A)",
    ]),
    # ---- modules, scopes and names
    "module": dict(text=[
        "module a { const long x = 1; };\nmodule a { const long y = x; };", "module a { };",
        "module a { module b { struct S { long x; }; }; };", "module a { const long x = 1; };\nmodule a { const long x = 2; };",
        "module a { module a { const long x = 1; }; };", "module a { const long x = 1; }", "module { const long x = 1; };", "module a;",
        "module a::b { const long x = 1; };", "struct a { long x; };\nmodule a { const long x = 1; };",
        "module a { const long x = 1; };\nstruct a { long x; };", "module a { struct a { long x; }; };",
        "module a { typedef long T; };\nmodule b { typedef a::T T; };", "module a { struct S; };\nmodule a { struct S { long x; }; };",
        "module a { struct S { long x; }; ; };", "module a { enum E { X }; }; module b { enum E { X }; };",
    ]),
    "scoped_name": dict(
        text="module a { struct S { long x; }; module b { struct T { long x; }; }; };\nmodule c { struct U { $used m; }; };", used=[
        "S", "a::S", "::a::S", "a::b::T", "b::T", "::b::T", "T", "a::T", "::S", "a::b::S", "a:: b ::T", "a.S", "a::", "::", "a::b", "x::S",
        "c::S", "a::S::x",
    ]),
    "lookup_outwards": dict(
        text="struct S { long x; };\nmodule a { typedef long T; $inner };",
        used=["S", "T", "a::T", "b::T", "::T", "::S", "a::b::T", "c::T", "U", "V"], inner=[
        "module b { typedef short T; struct U { $used m; }; typedef long V; };",
    ]),
    "hiding": dict(text=[
        'typedef long T;\nmodule a { typedef string T; const T c = "x"; };',
        'typedef string T;\nmodule a { const T c = "x"; typedef long T; };',
        "typedef long T;\nmodule a { struct S { T x; }; typedef short T; };", "typedef long T;\nstruct S { T T; };",
        "typedef long T;\nstruct S { T t; };", "typedef long T;\nstruct S { ::T T; };",
        "module a { typedef long T; };\nmodule b { struct S { a::T T; }; };", "module a { typedef long T; };\nstruct S { a::T a; };",
        "const long N = 3;\nstruct S { long N[N]; };", "const long N = 3;\nstruct S { sequence<long, N> x; long N; };",
        "struct S { long S; };", "enum E { E };", "module a { const long a = 1; };", "struct S { struct T { long x; } T; };",
        "union U switch (long) { case 1: long U; };",
    ]),
    "case_of_names": dict(text=[
        "struct S { long a; long A; };", "struct Foo { long x; };\nstruct foo { long x; };",
        "struct Foo { long x; };\nstruct B { foo x; };", "enum E { a, A };", "const long a = 1; const long A = 2;",
        "module M { const long x = 1; };\nmodule m { const long y = 1; };", "struct Foo { long foo; };",
        "module M { typedef long T; };\ntypedef m::T U;", "typedef long T; struct S { T t; };",
        "enum E { A }; union U switch (E) { case a: long x; };", "const long N = 2; struct S { long a[n]; };",
        "union U switch (long) { case 1: long a; case 2: long A; };",
    ]),
    "declared_twice": dict(text="$one\n$one", one=[
        "struct X { long a; };", "typedef long X;", "const long X = 1;", "enum X { P, Q };", "union X switch (long) { case 1: long a; };",
        "enum Z { X };", "struct X;", "module X { const long b = 1; };", "bitmask X { B0 };", "exception X { long a; };",
        "interface X { };",
    ]),
    # ---- types
    "spelling_of_type": dict(
        text=["struct S { $kind a; };", "typedef $kind T;", "struct S { sequence<$kind> a; };", "struct S { $kind a[2]; };"], kind=[
        *SIMPLE, "int", "long long long", "unsigned", "signed long", "unsigned octet", "unsigned char", "int128", "uint7", "long double",
        "bool", "byte", "string*", "unsigned int8", "long unsigned", "unsigned  long\nlong", "size_t", "void", "long short", "double long",
        "Long", "unsigned float", "uint", "float32",
    ]),
    "unknown_type": dict(text=[
        "struct S { $a a; };", "typedef $a T;", "struct S { sequence<$a> a; };", "const $a c = 1;", "struct S : $a { long a; };",
        "union U switch ($a) { case 1: long a; };", "union U switch (long) { case 1: $a a; };", "struct S { long a[$a]; };",
        "struct S { string<$a> a; };", "struct S { $a::T a; };", "struct S { ::$a a; };",
    ]),
    "typedef": dict(text=[
        "typedef $kind A; typedef A B; struct S { B x; };", "typedef $kind A, B, C;", "typedef $kind A[$n], B;",
        "typedef sequence<$kind> A; struct S { A x[2]; };", "typedef A A;", "typedef $kind A; typedef $kind A;", "typedef $kind;",
        "typedef struct S { long x; } T;", "typedef enum E { X } T;", "typedef $kind A, A;", "typedef $kind A B;", "typedef $kind A,;",
        "typedef struct S { long x; };", "typedef struct { long x; } T;", "typedef union U switch (long) { case 1: long a; } T;",
        "typedef B A; typedef long B;", "typedef sequence<$kind, $n> A; typedef sequence<A> B;",
        "typedef $kind A[2]; struct S { A x[3]; sequence<A> y; };",
    ]),
    "sequence_bound": dict(text="$sizes\nstruct S { sequence<$kind, $bound> a; };"),
    "text_bound": dict(text="$sizes\nstruct S { $text_type<$bound> a; };", text_type=["string", "wstring"]),
    "array_size": dict(text="$sizes\nstruct S { $kind a$first[$bound]; };", first=["", "[2]"]),
    "sequence_form": dict(text=[
        "struct S { sequence<sequence<$kind>> a; };", "struct S { sequence<sequence<$kind> > a; };", "struct S { sequence<long>[3] a; };",
        "struct S { long[3] a; };", "struct S { sequence<long a> b; };", "struct S { sequence<> a; };", "struct S { sequence a; };",
        "struct S { sequence long a; };", "struct S { sequence<$kind> a[$n]; };", "struct S { sequence<long,> a; };",
        "struct S { sequence<long, 2, 3> a; };", "struct S { sequence<long[3]> a; };", "struct S { sequence<sequence<$kind, 2>, $n> a; };",
        "struct S { sequence<string<3>> a; };", "struct S { sequence<3> a; };", "struct S { sequence(long) a; };", "sequence<$kind> a;",
        "struct S { sequence<sequence<sequence<long>>> a; };", "struct S { sequence<struct T { long x; }> a; };",
        "struct S { sequence<S> a; };", "struct S { sequence<long, 8 >> 1> a; };", "struct S { sequence<long, (8 >> 1)> a; };",
        "struct S { string<3>> a; };", "struct S { string<> a; };", "struct S { list<long> a; };",
    ]),
    "struct": dict(text=[
        "struct S { $kind $a; $kind ${b}x; };", "struct S { };", "struct S { long $a; short $a; };", "struct S { long $a };",
        "struct S { long $a; }", "struct S { long $a, ${b}x, c; };", "struct S { long $a, $a; };", "struct S { S a; };",
        "struct S { S a[2]; };", "struct S { long; };", "struct S { $a; };", "struct { long $a; };", "struct S { long $a;; };",
        "struct S { long $a, ; };", "struct S long $a; ;", "struct S { { long $a; } };", "struct S { long $a; };;",
        "struct S { long $a = 3; };", "struct S { const long $a = 3; };", "struct S { typedef long T; T $a; };",
        "struct S { long $a; } x;", "struct S { long $a[2], ${b}x[3][4]; };", "struct S ( long $a; );", "struct S { public long $a; };",
        "struct S { long $a: 3; };", "struct S { long *$a; };", "struct S { void $a; };",
    ]),
    "struct_inside": dict(text=[
        "struct S { struct T { long x; } t; };", "struct S { enum E { A, B } e; };",
        "struct S { union U switch (long) { case 1: long x; } u; };", "struct S { struct T { long x; }; T t; };",
        "struct S { struct { long x; } t; };", "struct S { struct T { long x; } t; T u; };",
        "struct S { enum E { A } e; }; struct V { S::E f; };", "struct S { struct T { long x; } t, u[2]; };",
    ]),
    "inheritance": dict(text=[
        "struct A { long a; };\nstruct B : A { long b; };", "struct B : A { long b; };",
        "struct A { long a; };\nstruct B : A { long a; };", "struct B : B { long b; };",
        "struct A;\nstruct B : A { long b; };\nstruct A { long a; };", "typedef long A;\nstruct B : A { long b; };",
        "enum A { X };\nstruct B : A { long b; };", "union A switch (long) { case 1: long a; };\nstruct B : A { long b; };",
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
    ]),
    "forward_declaration": dict(text=[
        "struct S;\nstruct S { long a; };", "struct S;", "struct S;\nstruct T { S s; };\nstruct S { long a; };",
        "struct S;\nstruct S;\nstruct S { long a; };", "struct S { long a; };\nstruct S;", "struct S { long a; };\nstruct S { long a; };",
        "union U;\nunion U switch (long) { case 1: long a; };", "union U;", "struct S;\nunion S switch (long) { case 1: long a; };",
        "union S;\nstruct S { long a; };", "struct S;\ntypedef S T;\nstruct S { long a; };", "enum E;\nenum E { A };",
        "interface I;\nstruct S { long a; };", "struct S;\nstruct T { S s[2]; };\nstruct S { long a; };",
        "struct S;\nmodule m { struct S { long a; }; };", "module m { struct S; };\nstruct S { long a; };", "struct S : T;",
        "@final struct S;\n@final struct S { long a; };",
    ]),
    "recursion": dict(text=[
        "struct S { sequence<S> a; };", "struct S;\nstruct S { sequence<S> a; };", "struct S;\ntypedef sequence<S> Q;\nstruct S { Q a; };",
        "struct S;\nstruct T { sequence<S> s; };\nstruct S { long a; };", "struct S;\nstruct T { sequence<S> s; };\nstruct S { T a; };",
        "union U;\ntypedef sequence<U> Q;\nunion U switch (long) { case 1: Q a; case 2: long b; };",
        "union U switch (long) { case 1: sequence<U> a; };", "union U switch (long) { case 1: U a; };",
        "struct S;\nstruct S { sequence<S, 1> a; long b; };", "struct S { @optional S a; };", "struct S;\nstruct T { sequence<S> s; };",
    ]),
    # ---- enumerations and unions
    "enumeration": dict(text=[
        "enum E { $a, $b };", "enum E { };", "enum E { $a, $b, };", "enum E { $a, $a };", "enum E { $a }; enum F { $a };",
        "enum E { $a $b };", "enum E { $a = 3, $b };", "enum E { $a; $b };", "enum { $a };", "enum E { $a, $b }",
        "enum E { $a, @default_literal $b };", "enum E { $a, 3 };", "enum E : long { $a };", "enum class E { $a };",
        "enum E { $a }; struct $a { long x; };", "module m { enum E { $a }; }; enum F { $a };",
        "enum E { $a }; struct S { E e; E $b[2]; sequence<E> c; };", "enum E { ,$a };", "enum E { $a, $b }; struct S { long $a; };",
        "enum E { $a }; struct S { $a x; };", "enum E { @default_literal $a, @default_literal $b };", 'enum E { "$a" };',
    ]),
    "enumeration_values": dict(
        text="${bound}enum E { @value($value) A, ${next}B };", next=["", "@value(1) ", "@value(6) ", "@value(0) ", "@value(A) "],
        bound=["", "", "@bit_bound(8) ", "@bit_bound(16) ", "@bit_bound(0) ", "@bit_bound(33) ", "@bit_bound(1) "],
        value=["0", "1", "5", "-1", "127", "128", "255", "300", "65536", "2147483647", "2147483648"]),
    "union_switch": dict(types="enum E { A, C }; typedef short T; struct S { long x; }; typedef E V; typedef S W;",
                         text="$types\nunion U switch ($said: $kind a; };", said=[
        "long) { case 1", "short) { case 1", "octet) { case 1", "int8) { case 1", "uint8) { case 1", "uint16) { case 1",
        "unsigned long) { case 1", "long long) { case 1", "uint64) { case 1", "char) { case 'a'", "wchar) { case L'a'",
        "boolean) { case TRUE", "E) { case A", "T) { case 2", "float) { case 1", "double) { case 1.0", 'string) { case "a"',
        'wstring) { case L"a"', "S) { case 1", "sequence<long>) { case 1", "enum F { B }) { case B", ") { case 1", "M) { case 1",
        "M) { case B0", "@key long) { case 1", "any) { case 1", "V) { case B", 'string<3>) { case "a"', "long a) { case 1", "W) { case 1",
    ]),
    "union_label_range": dict(text="union U switch ($whole) { case $limit: long a; case 5: short b; };"),
    "union_label_twice": dict(
        text=["$types\nunion U switch (long) { case $long$between$long: long b; };", "$types\nunion U switch (E) { case $E$between$E: long b; };",
              "$types\nunion U switch (char) { case $char$between$char: long b; };", "$types\nunion U switch (boolean) { case $truth$between$truth: long b; };",
              "union U switch (octet) { case $n$between$n: long b; };", "union U switch (short) { case $short$between$short: long b; };"],
        types="const long N = 2; enum E { A, B, C };", between=[": short a; case ", ": case "], long=["1", "2", "1 + 1", "N", "0x1", "2"],
        E=["A", "B", "E::A"], char=["'a'", "'b'", r"'\x61'"], truth=["TRUE", "FALSE"], short=["-1", "1", "-1"]),
    "union_label_of_other_type": dict(
        text="$types\nunion U switch ($kind) { case $label: long a; };",
        kind=["long", "char", "boolean", "E", "octet", "T", "wchar", "uint64"],
        types="const short N = 2; enum E { A, B }; enum F { X }; typedef long T; struct S { long x; };", label=[
        "1", "'a'", "TRUE", "A", "E::B", "1.5", '"a"', "X", "N", "L'a'", "F::X", "(1)", "-1", "A | B", "~0", "Z", "::A", "1 << 2", "S",
    ]),
    "union_default": dict(text="enum E { A, B };\n$union", union=[
        "union U switch (long) { case 1: long a; default: short b; };", "union U switch (long) { default: short b; };",
        "union U switch (long) { default: long a; default: short b; };", "union U switch (long) { default: short b; case 1: long a; };",
        "union U switch (long) { case 1: default: long a; };", "union U switch (long) { default: case 1: long a; };",
        "union U switch (boolean) { case TRUE: long a; case FALSE: short b; default: char c; };",
        "union U switch (boolean) { case TRUE: long a; default: short b; };",
        "union U switch (E) { case A: long a; case B: short b; default: char c; };",
        "union U switch (E) { case A: case B: long a; default: char c; };", "union U switch (E) { case A: long a; default: char c; };",
        "union U switch (E) { case A: case B: default: long a; };", "union U switch (long) { case 1: long a; default: };",
        "union U switch (long) { default long a; };", "union U switch (long) { case default: long a; };",
    ]),
    "union_form": dict(text=[
        "union U switch (long) { };", "union U switch (long) { case 1: $kind a; case 2: $kind a; };",
        "union U switch (long) { case 1: $kind; };", "union U switch (long) { case 1 $kind a; };", "union U (long) { case 1: $kind a; };",
        "union U { case 1: $kind a; };", "union U switch long { case 1: $kind a; };", "union U switch (long) { $kind a; };",
        "union U switch (long) { case: $kind a; };", "union U switch (long) { case 1: $kind a, b; };",
        "union U switch (long) { case 1: $kind a; $kind b; };", "union U switch (long) { case 1: $kind a };",
        "union U switch (long) { case 1, 2: $kind a; };", "union U switch (long) { case 1: $kind a[$n]; };",
        "union U switch (long) { case 1: sequence<$kind> a; };", "union U switch (long) { case 1: struct T { long x; } a; };",
        "union U switch (long) { case 1: case 2: case 3: $kind a; case 4: long b; };", "union U switch (long) { case 1: $kind a; }",
        "union switch (long) { case 1: $kind a; };", "union U switch (long) { case 1: void; };", "union U switch (long) { 1: $kind a; };",
        "union U switch (long) { case 1..3: $kind a; };", "union U switch (enum E { A }) { case A: $kind a; };",
        "union U switch (long) { case 1: @id(3) $kind a; };", "union U switch (long) { case 1: enum E { A, B } e; };",
    ]),
    # ---- keys and annotations
    "key": dict(
        size=["", "", "", "[2]"], text="$keyable\nstruct S { $said $kind a$size; long b; };",
        said=["@key", "@key", "@key", "@key(TRUE)", "@key(FALSE)", "@Key", "@ key", "@key()", "@key(1)"], kind=[
        *SIMPLE, "P", "K", "E", "V", "T", "L", "sequence<long>", "sequence<string>", "string<5>", "map<long, long>",
    ]),
    "key_elsewhere": dict(text=[
        "struct S { @key @optional long a; long b; };", "struct S { long @key a; };", "@key struct S { long a; };",
        "struct S { long a @key; };", "union U switch (@key long) { case 1: long a; };", "union U switch (long) { case 1: @key long a; };",
        "typedef @key long T;", "@key typedef long T;", "struct S { @key @key long a; };", "struct S { @key long a, b; };",
        "struct S { key long a; };", "enum E { @key A };", "@key module m { const long a = 1; };", "@key const long a = 1;",
        "struct S { sequence<@key long> a; };", "struct S { @key struct T { long x; } t; };",
    ]),
    "keylist": dict(text="struct S { long a; string b; sequence<long> c; };\n$pragma", pragma=[
        "#pragma keylist S a", "#pragma keylist S a b", "#pragma keylist S z", "#pragma keylist S", "#pragma keylist T a",
        "#pragma keylist", "#pragma keylist S c", "#pragma keylist S a a", "#pragma keylists S a", "#pragma keylist S a.b",
        "#pragma keylist S a,b", "#pragma keylist S A",
    ]),
    "annotation_on_struct": dict(text="$said struct S { $kind a; };", said=[
        "@final", "@appendable", "@mutable", "@nested", "@topic", "@nested(FALSE)", "@extensibility(FINAL)", "@extensibility(MUTABLE)",
        "@extensibility(OTHER)", "@extensibility(3)", "@final @mutable", "@autoid(HASH)", "@autoid(SEQUENTIAL)", "@autoid(OTHER)",
        "@bogus", "@bogus(1)", "@bogus(a = 1, b = 2)", "@", "@final(", "@final()", "@default_nested", "@1", "@data_representation(XCDR2)",
        '@verbatim(text = "a")', '@topic(name = "x")', "@bit_bound(8)", "@m::bogus", "@::final", "@final;", "@extensibility",
        "@final @final",
    ]),
    "annotation_on_member": dict(
        how=["", "@mutable "], kind=["long", "short", "octet", "double", "string", "boolean"],
        text="const long N = 7;\n${how}struct S { char z; $said $kind a; long b; };", said=[
        "@id(3)", "@id(-1)", '@id("a")', "@id", "@id()", "@id(0x10000000)", "@id(268435455)", "@id(1)", "@hashid", '@hashid("q")',
        "@optional", "@optional(TRUE)", "@external", "@must_understand", "@default(1)", '@default("a")', "@default(1.5)", "@default(TRUE)",
        "@default", "@default(300)", "@default(-1)", "@range(min = 1, max = 5)", "@range(1, 5)", "@min(1)", "@max(5)", '@unit("m")',
        "@unit(m)", "@unit", "@try_construct(USE_DEFAULT)", "@try_construct(BAD)", "@bogus", "@bogus(x)", "@non_serialized", "@final",
        "@position(3)", "@value(3)", "@default(value = 1)", "@id(value = 4)", "@id(3, 4)", "@id(N)", "@id(1 + 3)", "@optional(1)",
    ]),
    "identifiers_of_members": dict(text="${how}struct S { ${id}long a; ${id}short b; ${id}char c; };", how=["", "@mutable ", "@appendable "],
                                   id=["", "", "", "", "@id(0) ", "@id(1) ", "@id(2) ", "@id(3) "]),
    "annotation_declaration": dict(text=[
        "@annotation foo { long a; };\n@foo(a = 1) struct S { long x; };",
        "@annotation foo { long a default 3; };\n@foo struct S { long x; };", "@annotation foo { };\n@foo struct S { long x; };",
        "@annotation foo { long a; };\n@foo(b = 1) struct S { long x; };",
        '@annotation foo { long a; };\n@foo(a = "x") struct S { long x; };', "@annotation foo { long a }; struct S { long x; };",
        "@annotation { long a; };", "@annotation foo { long value; };\n@foo(3) struct S { long x; };",
        "@annotation foo { enum E { A, B }; E e default A; };\n@foo(e = B) struct S { long x; };",
        "@annotation foo { sequence<long> a; };", "@annotation foo { long a; };\n@annotation foo { long a; };",
        "annotation foo { long a; };", "module m { @annotation foo { long a; }; };\n@m::foo(a = 1) struct S { long x; };",
        "@annotation foo { long a; long a; };", "@annotation foo { string a default 3; };", "@annotation foo { any a; };",
        "@annotation foo { const long c = 1; typedef long T; };",
    ]),
    "annotation_elsewhere": dict(said=["@bogus", "@final", "@nested", "@default(1)", "@id(2)"], text=[
        "$said module m { const long c = 1; };", "$said const long c = 1;", "$said typedef long T;", "$said enum E { A };",
        "enum E { $said A };", "union U switch ($said long) { case 1: long a; };", "$said union U switch (long) { case 1: long a; };",
        "struct S { sequence<$said long> a; };", "struct S { long a $said; };", "struct S { long a $said [2]; };", "$said",
        "struct S { $said };", "struct $said S { long a; };", "union U switch (long) { $said case 1: long a; };", "typedef $said long T;",
        "const $said long c = 1;",
    ]),
    # ---- extended types
    "bitmask": dict(how=["", "", "@bit_bound(8) ", "@bit_bound(64) ", "@bit_bound(65) ", "@bit_bound(0) ", "@bit_bound(2) "], text=[
        "${how}bitmask M { A, B };", "${how}bitmask M { @position($bit) A, B };", "${how}bitmask M { };", "${how}bitmask M { A, A };",
        "${how}bitmask M { @position(1) A, @position(1) B };", "${how}bitmask M { A, B, };", "${how}bitmask { A };",
        "${how}bitmask M { @position(3) A, @position(1) B, C };", "${how}bitmask M { A = 1 };", "${how}bitmask M { A, B, C };",
        "${how}bitmask M { @position(-1) A };", "${how}bitmask M { @position A };", "${how}bitmask M { A };\nstruct S { M m; };",
        "${how}bitmask M { A };\nbitmask N { A };", "${how}bitmask M { @position(1) A, B, @position(2) C };", "${how}bitmask M;",
        "${how}bitmask M { @position(\"a\") A };",
    ], bit=list(map(str, range(70)))),
    # ---- what DDS needs not
    "names_made_of_names": dict(text=[
        "module a_b { const long c = 1; };\nmodule a { const long b_c = 1; };",
        "module a { struct S { long x; }; };\nstruct a_S { long x; };", "struct S { struct T { long x; } t; };\nstruct S_T { long x; };",
        "module a { enum E { X }; };\nconst long a_X = 1;", "struct S { long x; };\nmodule S_T { const long c = 1; };",
        "enum E { A }; const long E_A = 1;", "struct S { long x; };\nstruct S_ { long x; };",
    ]),
    # ---- the whole file
    "preprocessor": dict(text=[
        "#define N $n\nstruct S { long a[N]; };", "#ifdef X\nnonsense\n#endif\nstruct S { long a; };",
        "#ifndef X\nnonsense\n#endif\nstruct S { long a; };", "#if 0\nnonsense\n#else\nstruct S { long a; };\n#endif",
        '#include "missing.idl"\nstruct S { long a; };', "#include <missing.idl>\nstruct S { long a; };",
        "#error no\nstruct S { long a; };", "#pragma once\nstruct S { long a; };", '#pragma prefix "a"\nstruct S { long a; };',
        "#if 1\nstruct S { long a; };", "struct S { long a; };\n#endif", "#define T(x) long x\nstruct S { T(a); };",
        "#define N\n#undef N\nstruct S { N a; };", "#nonsense\nstruct S { long a; };", "#warning careful\nstruct S { long a; };",
        "#if 0\n#elif 1\nstruct S { long a; };\n#endif", "struct S { long \\\n a; };", "#define EMPTY\nEMPTY struct S { long a; };",
        "#define N $n\n#define M (N * 2)\nconst long c = M;", "#pragma\nstruct S { long a; };", "#\nstruct S { long a; };",
        '# 7 "x.idl"\nstruct S { long a; };', "#include\nstruct S { long a; };", "#define\nstruct S { long a; };",
        "#if\nstruct S { long a; };\n#endif", "#define A(x\nstruct S { long a; };", "#define a b\nstruct S { long a; long b; };",
        "#define CAT(x, y) x##y\nstruct S { long CAT(a, b); };", "#if defined(X) || 1\nstruct S { long a; };\n#endif",
        "  #define N 3\nconst long c = N;", '#ident "a"\nstruct S { long a; };', "#line 5\nstruct S { long a; };",
        "const long c = __LINE__;",
    ]),
    "whole_file": dict(text=[
        "", " ", "// nothing", ";", "}", "{", "\t", "struct", "module", "long a;", "const", "\\", "a", "1", '"a"', "@", "@key", "::",
        "struct S { long a; }; extra", "using m;", "namespace a { };", "\x1a", "\f", "struct S { long a; };\x1a",
        "\ufeffstruct S { long a; };", "struct\fS { long\va; };", "struct S { long a; };\r", "é", "struct S { long a; } // ;", "#",
        "struct S { long a; };\x00",
    ]),
    **dict.fromkeys(("token_missing", "token_doubled", "token_replaced"), dict(text="$damaged")),
}  # fmt: skip

_WHOLE = [
    "struct S { @key long a; string<5> b; sequence<double, 3> c; };",
    "enum E { A, B }; union U switch (E) { case A: long a; default: string b; };",
    "module m { const long N = 2 * 3; typedef float F[N]; };", "struct A { long x, y; };\nstruct B : A { sequence<A> z; };",
    "@appendable struct S { @id(1) long a; @optional short b; };",
]  # fmt: skip
