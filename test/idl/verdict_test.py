"""Accepted or refused: Skein's verdict on small IDL files, compared with those of idlc and fastddsgen.

verdict_test.py SKEIN_ROOT IDLC FASTDDSGEN [COUNT [SEED]]

Where a tool disagrees, a rule below has to say why; a disagreement without a rule is a failure, and so is, in a run of at least 2,000
files with both tools and the default seed, a rule without a disagreement. A tool that is not there is left out.
"""

import contextlib
import io
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import traceback
from dataclasses import dataclass

ROOT, IDLC, FASTDDSGEN = sys.argv[1:4]
COUNT = int(sys.argv[4]) if len(sys.argv) > 4 else 100
SEED = int(sys.argv[5]) if len(sys.argv) > 5 else 1
sys.path.insert(0, f"{ROOT}/idl/compiler")
sys.dont_write_bytecode = True
try:
    from compilation import Compilation
except ImportError:
    print("Skipped: python3-lark is not installed")
    sys.exit(77)

import verdict_corpus

_IDLC_SECONDS = 3  # idlc never ends on some files, and takes all memory
_BATCH = 50  # files for one start of fastddsgen's Java machine
_BATCH_SECONDS = 120
_FULL = 2000  # from so many files on each rule must have been needed
_JAVA = {"JAVA_TOOL_OPTIONS": "-XX:TieredStopAtLevel=1 -XX:+UseSerialGC"}  # starts in less time
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")


@dataclass
class Verdict:
    accepted: bool  # None after a crash
    said: str


# ---- the three judges


def by_skein(path, out):
    """A crash is neither verdict, so that it differs from both."""
    said = io.StringIO()
    try:
        with contextlib.redirect_stderr(said):
            compilation = Compilation(path, [f"{ROOT}/idl/skein"], [])
            if compilation.accepted:
                compilation.write(out, os.path.basename(path))
    except Exception:
        return Verdict(None, traceback.format_exc())
    return Verdict(compilation.accepted, said.getvalue())


def by_idlc(path, out):
    def limited():
        resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
        resource.setrlimit(resource.RLIMIT_CPU, (_IDLC_SECONDS, _IDLC_SECONDS))

    command = [IDLC, "-l", "c", "-x", "final", "-f", "case-sensitive", "-o", out, path]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, preexec_fn=limited, check=False)
    said = done.stdout.decode(errors="replace")
    return Verdict(done.returncode == 0, said if done.returncode >= 0 else f"{said}ended by signal {-done.returncode}")


def by_fastddsgen(paths, out):
    """The verdicts on all files. The first that it refuses ends it, so that it begins anew behind that one."""
    verdicts = []
    while len(verdicts) < len(paths):
        verdicts += _batch(paths[len(verdicts) :][:_BATCH], out)
    return verdicts


def _batch(paths, out):
    """The verdicts on the first files, at least one. The exit code says nothing; what counts are messages and outputs."""
    command = [FASTDDSGEN, "-cs", "-replace", "-d", out, *map(os.path.basename, paths)]
    with tempfile.TemporaryFile() as output:
        try:
            subprocess.run(command, stdout=output, stderr=subprocess.STDOUT, cwd=os.path.dirname(paths[0]), env=os.environ | _JAVA,
                           timeout=_BATCH_SECONDS, check=False)  # fmt: skip
            end = ""
        except subprocess.TimeoutExpired:
            end = "never ends"
        output.seek(0)
        said = _COLOUR.sub("", output.read().decode(errors="replace"))
    parts = re.split(r"Processing the file [^\n]*\.\.\.\n", said)[1:]
    if not parts:
        raise RuntimeError(f"fastddsgen does not start: {said}")
    parts[-1] += end
    verdicts = []
    for path, part in zip(paths, parts):
        base = os.path.join(out, os.path.basename(path).removesuffix(".idl"))
        written = all(os.path.isfile(base + ending) and os.path.getsize(base + ending) for ending in (".h", ".cxx"))
        verdicts.append(Verdict(written and not re.search("error|exception|never ends", part, re.IGNORECASE), part))
    return verdicts


# ---- why they disagree


@dataclass
class Rule:
    """Explains why `judge` ("": either tool) differs from Skein in a file: who refuses it says `said`, and it has `text`. Both are regular
    expressions. Sections are those of OMG IDL 4.2."""

    name: str
    judge: str
    said: str
    text: str
    why: str
    uses: int = 0

    def explains(self, judge, said, text):
        return self.judge in ("", judge) and re.search(self.said, said) and re.search(self.text, text)


_SYNTAX = r"syntax error|mismatched input|Unexpected input|no viable|extraneous|missing '|token recognition"
_NAMED = r"(struct|module|long|short|string|,|>) ({})( [{{:]|;| }}|, y|<5>)".format("|".join(verdict_corpus.KEYWORDS))
_OWN_NAME = r"(struct|module|union|enum) (\w+) [^{]*{[^}]*(struct|const long|long|enum|module|const T|[{,]) \2\b|struct T { long x; } T;"
_UNCHECKED_ANNOTATION = (r"Unknown annotation member|Scoped name '(BAD|m|OTHER)'|Cannot evaluate|Missing assignment|"
                         r"Declaration 'a' collides|a was defined|foo is already")  # fmt: skip

# Skein takes what the specification does not have: published IDL is written so, or nothing is lost by it.
_LENIENT = [
    Rule("own name inside", "", r"collides with|already defined|was defined", _OWN_NAME,
         "7.5.2: the name of a module, a struct or a union may not be declared anew directly inside it. RTI's own examples do it; in C++ "
         "the member gets another name."),
    Rule("name used before", "", r"already defined", r"sequence<long, N> x; long N;|a::T a;|const T c = \"x\"; typedef long T;",
         "7.5.3: a name that was used in a scope may not be declared there later with another meaning. Skein's C++ writes names in full."),
    Rule("annotations unchecked", "", _UNCHECKED_ANNOTATION, r"@\w",
         "7.4.15: an annotation is declared once, and has the members that it declares, of their types. Skein keeps those that have no "
         "effect, and does not look into them."),
    Rule("member of an annotation", "", _SYNTAX, r"@annotation foo { sequence",
         "7.4.15: an annotation's members are of types that constants have."),
    Rule("annotation before a name", "", _SYNTAX, r"long @\w+ a;",
         "7.4.15: an annotation stands before the type. Skein takes one between type and name for that name alone."),
    Rule("empty parentheses", "", _SYNTAX, r"@\w+\(\)", "7.4.15: the parentheses of an annotation are not empty."),
    Rule("extensibility of a base", "", r"Extensibility of inherited type", "@mutable",
         "DDS-XTypes 1.3, 7.2.2.4.5: a struct and its base have the same extensibility. Skein warns."),
    Rule("parameter without direction", "", _SYNTAX, r"f\(long a\)", "7.4.3: a parameter is in, out or inout; without a word it is in."),
    Rule("empty module", "", _SYNTAX, r"module \w+ {[\s\\]*}", "7.4.1.4.2: a module has a definition at least; macros may leave none."),
]  # fmt: skip

# idlc 0.10 refuses what Skein accepts, and that is valid if the rule does not say otherwise.
_IDLC = [
    Rule("idlc: wide characters", "idlc", r"syntax error|'L' cannot be resolved|signal 6", r"\bw(char|string)\b",
         "7.4.1.4.4: valid; idlc has neither wchar nor wstring, and aborts where a type has one."),
    Rule("idlc: extended types", "idlc", r"syntax error", r"\b(map<|bitset|bitfield)", "7.4.13: valid; idlc has no maps and no bitsets."),
    Rule("idlc: other building blocks", "idlc", r"syntax error", r"\b(exception|interface|any|fixed|native|valuetype|typeid|typeprefix|import)\b",
         "7.4.2 to 7.4.6: valid; idlc has data types alone. Skein reads the others, and leaves out with a warning what cannot travel "
         "and is not used."),
    Rule("idlc: loose constants", "idlc", r"Cannot evaluate (enumerator|integer literal) as|name '([Tt]rue|false)'", r"const |case ",
         "7.4.1.4.3 has none of enumerators as numbers, of numbers as booleans and characters, and of `true`; Skein takes what other "
         "compilers take."),
    Rule("idlc: recursion", "idlc", r"Type id not found|signal \d+", r"sequence<[SU]\b|@optional S",
         "7.4.1.4.4: valid, a sequence may hold the type that it is in, and in DDS-XTypes an optional member; idlc 0.10 never ends, or "
         "loses the type."),
    Rule("idlc: shift by 32", "idlc", r"Invalid integer expression", r">> (32|63)",
         "7.4.1.4.3: valid, a shift goes by 0 to 63; idlc reckons in 32 bits."),
    Rule("idlc: two extensibilities", "idlc", r"clashes with an earlier annotation", r"@final @mutable",
         "8.3.1: each says something of its own; Skein takes the last."),
    Rule("idlc: type in its use", "idlc", r"syntax error", r"(struct|union|enum) \w+ (switch \(long\) )?{[^{}]*} \w+|switch \(enum",
         "Older IDL declares a type where it uses it, and Skein reads that; in a switch IDL 4.2 does not have it either."),
    Rule("idlc: enumeration as a scope", "idlc", r"does not resolve to an enumerator", r"[EF]::[A-Z]",
         "7.5.2: an enumeration is no scope; Skein takes `E::A` as well as `A`, as C++ does."),
    Rule("idlc: label beyond 32 bits", "idlc", r"INT32_MIN", "",
         "7.4.1.4.4: valid, a label is any value of its type; idlc's type information has 32 bits."),
    Rule("idlc: complement", "idlc", r"Integer expression overflows", r"~",
         "7.4.1.4.3: valid, `~` of an unsigned type is its greatest value less the operand; idlc reckons in 32 bits."),
    Rule("idlc: name in an annotation", "idlc", r"Scoped name '\w+' cannot be resolved", r"@\w+\(N\)",
         "7.4.15: valid, a constant is an argument; idlc looks for its name in the annotation."),
    Rule("idlc: annotation elsewhere", "idlc", r"can(not| only) be (applied|assigned)|attempt to set limits", r"@",
         "8.3 says where each annotation has a meaning. Elsewhere Skein gives it none; idlc refuses it."),
    Rule("idlc: place of an annotation", "idlc", r"syntax error", r"sequence<@|a @\w+(\(\d\))? \[|@\w+(\(\d\))? case|[^:]::final",
         "7.4.15 and DDS-XTypes 1.3: valid before a type within a type, a case, and an array's size; idlc has no annotations there."),
    Rule("idlc: scoped annotation", "idlc", r"syntax error|Unrecognized annotation: @m", r"@(m)?::",
         "7.4.15: valid, an annotation's name is a scoped name; idlc has plain ones."),
    Rule("idlc: unknown annotation", "idlc", r"Unrecognized annotation", r"@bogus",
         "7.4.15: valid, what is not known is passed over; idlc does so in some places."),
    Rule("idlc: blank in an annotation", "idlc", r"syntax error", r"@ key", "7.4.15: valid, `@` and the name are two tokens."),
    Rule("idlc: kinds of keys", "idlc", r"currently unsupported", r"@key",
         "8.3.2: valid; idlc has no keys that are arrays of structs, and none in unions."),
    Rule("idlc: keylist", "idlc", r"Duplicate key", r"#pragma keylist S a a",
         "No specification has the pragma; Skein takes a key that is named twice once."),
    Rule("idlc: control-Z", "idlc", r"Illegal control character", "\x1a",
         "7.2 has no such character; old files end in it, and Skein passes it over."),
    Rule("idlc: byte order mark", "idlc", r"syntax error", "\ufeff", "7.2: IDL is Latin-1; Skein's is UTF-8, and may begin with its mark."),
    Rule("idlc: accented character", "idlc", r"invalid character constant", r"'é'",
         "7.2: valid, one character of Latin-1; idlc counts the two bytes of UTF-8."),
    Rule("idlc: preprocessor's dialect", "idlc", r"#directive", r"(?m)^#",
         "7.3: the preprocessor of ISO C++ 2003; Skein's cpp also knows `#warning` and the marks of lines."),
]  # fmt: skip

# fastddsgen 2.3 likewise.
_FASTDDSGEN = [
    Rule("fastddsgen: octal numbers", "fastddsgen", r"mismatched input '0\d+'", r"\b0\d",
         "7.2.6.1: valid; fastddsgen reads no octal numbers."),
    Rule("fastddsgen: outermost scope", "fastddsgen", r"'::\w*' was not defined", r"::\w+",
         "7.5.1: valid; fastddsgen finds no name that begins with `::`."),
    Rule("fastddsgen: recursion", "fastddsgen", r"'[SU]' was not defined|isBounded|StackOverflow", r"sequence<[SU]\b|@optional S",
         "7.4.1.4.4: valid; fastddsgen knows no type inside itself, and crashes where it was announced."),
    Rule("fastddsgen: escaped name", "fastddsgen", r"'_\w+' was not defined", r"\b_[a-zA-Z]",
         "7.2.3: valid, an escaped name is the name without its underscore; to fastddsgen it is another."),
    Rule("fastddsgen: bits in a struct", "fastddsgen", r"isBounded", r"bit(set|mask)",
         "7.4.13: valid; fastddsgen crashes where a struct has one."),
    Rule("fastddsgen: nothing at all", "fastddsgen", r"'<EOF>'", r"^(\s|//.*|#.*)*$",
         "7.4.1.4.1 wants a definition; Skein, as idlc, takes an empty file, as what a preprocessor may leave."),
    Rule("fastddsgen: announced interface", "fastddsgen", r"Illegal identifier: I is already", r"interface I;",
         "7.4.3: valid; fastddsgen takes the definition for another interface."),
    Rule("fastddsgen: announced twice", "fastddsgen", r"was redefined", r"(?s)(struct|union) (\w+);.*\1 \2;|};\n(struct|union) \w+;",
         "7.4.1.4.4: valid; fastddsgen takes one forward declaration."),
    Rule("fastddsgen: type in a union", "fastddsgen", r"no such attribute: labels|m_discriminator", r"case 1: (struct|enum)|switch \(enum",
         "Older IDL declares a type where it uses it; fastddsgen crashes."),
    Rule("fastddsgen: scope of a struct", "fastddsgen", r"'[ST]' was not defined", r"S::E|struct T { long x; } t; T u",
         "Older IDL: a struct is the scope of what is declared in it; in fastddsgen it is none."),
    Rule("fastddsgen: annotation in a module", "fastddsgen", r"no such attribute: parent", r"@annotation",
         "7.4.15: valid; fastddsgen crashes where a module has an annotation's declaration."),
    Rule("fastddsgen: place of an annotation", "fastddsgen", r"'@'|<@", r"@",
         "7.4.15: an annotation may stand before any declaration or type; fastddsgen has not all those places."),
    Rule("fastddsgen: quoted marks", "fastddsgen", r"token recognition error", r"\\[\"']",
         "7.2.6.3: valid; fastddsgen reads no escaped quotation mark."),
    Rule("fastddsgen: control-Z", "fastddsgen", r"token recognition error", "\x1a",
         "7.2 has no such character; old files end in it, and Skein passes it over."),
]  # fmt: skip

# fastddsgen accepts what Skein refuses: it reads, and checks hardly anything.
_UNCHECKED = [
    Rule("fastddsgen: type of a constant", "fastddsgen",
         r"(is|are) expected here|is no constant|are numbers|needs a? ?whole numbers?|size is a whole number|a constant is a", "",
         "7.4.1.4.3: a constant's value has its type, and an operator its operands'; fastddsgen copies the text into the C++."),
    Rule("fastddsgen: name in an expression", "fastddsgen", r"there is no '", r"=|\[|<|case",
         "7.5: names are known; fastddsgen copies those in expressions into the C++."),
    Rule("fastddsgen: arithmetic", "fastddsgen", r"division by zero|a shift goes by", "",
         "7.4.1.4.3: no division by zero, shifts by 0 to 63; fastddsgen does not reckon."),
    Rule("fastddsgen: character", "fastddsgen", r"is no character of", r"'", "7.2.6.2: a char has one byte; fastddsgen copies it."),
    Rule("fastddsgen: declared twice", "fastddsgen", r"declared (twice|already)|there is a (bit|member|bit field) '", "",
         "7.5.2: a name is declared once in a scope, an enumerator in that of its enumeration; fastddsgen looks at some kinds only."),
    Rule("fastddsgen: label or default twice", "fastddsgen", r"there is a case|the default literal already", "",
         "7.4.1.4.4 and 8.3: a value has one case, an enumeration one default; fastddsgen compares texts, if any."),
    Rule("fastddsgen: identifiers of members", "fastddsgen", r"would have the identifier|identifier is from", "",
         "DDS-XTypes 1.3, 7.3.1.2.1.1: identifiers differ and have 28 bits."),
    Rule("fastddsgen: oneway", "fastddsgen", r"is oneway, so", "oneway", "7.4.3 and 7.4.6: nothing comes back from a oneway operation."),
    Rule("fastddsgen: bits", "fastddsgen", r"@bit_bound is from|the position|another bit|another enumerator|a bit field|a bitset has", "",
         "8.3.4 and 7.4.13: bits are where there is room, once each."),
    Rule("fastddsgen: base", "fastddsgen", r"the base of|no type", "",
         "7.4.13: a base is a struct, or a bitset, that was defined; fastddsgen takes any name."),
    Rule("fastddsgen: not defined", "fastddsgen", r"defined nowhere|is not defined yet", "",
         "7.4.1.4.4: what is announced is defined, before anything but a sequence holds it."),
    Rule("fastddsgen: discriminator", "fastddsgen", r"a union is switched by", "",
         "7.4.1.4.4: a discriminator is a whole number, a character, a boolean or an enumeration."),
    Rule("fastddsgen: key of a map", "fastddsgen", r"the key of a map", "map<",
         "DDS-XTypes 1.3, 7.2.2.4.3: whole numbers and text; Skein also takes what has an order and is equal to itself alone."),
    Rule("fastddsgen: extensibility", "fastddsgen", r"@extensibility is", "@ext", "8.3.1: one of three values; fastddsgen does not look."),
    Rule("fastddsgen: behind the last definition", "fastddsgen", r"stands where|no meaning here", r"}?;\s*(;|extra|\w+ (switch|:|{))",
         "7.4.1.4.1: a specification is nothing but definitions; fastddsgen ends where none begins."),
    Rule("fastddsgen: forms of C++", "fastddsgen", r"stands where|no meaning here|belongs to wide text",
         r"\d[fFlL]\b|L\"a\" \"b\"|\$|#ident|\\u",
         "7.2: IDL has none of C++'s suffixes of numbers, `$` in names, `#ident`, and mixtures of wide and other text."),
    Rule("fastddsgen: line end in text", "fastddsgen", r"no meaning here", r"\"a\nb\"", "7.2.6.3: text ends on its line."),
    Rule("fastddsgen: unknown base", "fastddsgen", r"there is no '", r"struct \w+ : ",
         "7.5: a base is known; fastddsgen passes over one that is not."),
    Rule("fastddsgen: value of an annotation", "fastddsgen", r"@\w+ needs a (number|value)", r"@(id|position|default)",
         "8.3: @id, @position and @default have a value; fastddsgen does not look."),
    Rule("fastddsgen: optional key", "fastddsgen", r"a key and optional", r"@key @optional",
         "DDS-XTypes 1.3, 7.2.2.4.4.4: a key is always there; fastddsgen does not look."),
    Rule("fastddsgen: not supported", "fastddsgen", r"(is|are) not supported", "",
         "Valid, and refused by name (README, What is refused): nothing of the kind travels in DDS."),
]  # fmt: skip

_EITHER = [
    Rule("keyword of another building block", "", _SYNTAX, _NAMED,
         "7.2.4 reserves `home` and `port`, too; Skein by design does not, as older IDL has such names (grammar.lark)."),
    Rule("brackets", "", r"syntax error|no viable alternative|'>>'", r">>",
         "7.4.1.4.4: the ends of nested sequences, which older IDL had to write apart; both tools read them as a shift."),
    Rule("value of an enumerator", "", _SYNTAX, r"enum E { \w+ = 3",
         "Beyond the specification, which has @value; Skein takes both, as other compilers."),
    Rule("default without a value", "", r"Invalid default label|All enumeration elements|cannot have more than two", r"default:",
         "7.4.1.4.4 has one default at most; where every value has its case, Skein warns and leaves it out."),
]  # fmt: skip

# A tool accepts what Skein refuses, with the specification unless the rule says otherwise.
_ACCEPTED = [
    Rule("size", "", r"is no size", "",
         "7.4.1.4.4: a size is positive; Skein's greatest is 2^31 - 1. The tools take 0 and cut off what is too large."),
    Rule("scope that is none", "", r"holds no names", "",
         "7.5.1: a constant and a struct's member hold no names; the tools look for the last part."),
    Rule("range", "", r"does not fit into", "",
         "7.4.1.4.3: a constant fits its type. idlc errs at 64 bits, fastddsgen does not look. An @bit_bound(8) enumeration is signed."),
    Rule("bound of text", "", r"the text has \d+", "", "7.4.1.4.3: a constant fits its type; the tools do not look at the bound."),
    Rule("zero byte", "", r"cannot hold a zero", "", "7.2.6.3: text has no zero byte."),
    Rule("underscores in front", "", r"the character '_'", r"\b_([_\d]|\W)",
         "7.2.3: behind the underscore that escapes it an identifier begins with a letter."),
    Rule("keylist", "", r"#pragma keylist: ", r"#pragma keylist",
         "No specification has the pragma. A misspelt key would be lost, so Skein refuses it; the tools pass over it."),
    Rule("unknown pragma", "", r"unknown pragma", r"#pragma", "7.3 lets unknown pragmas be; one that is almost `keylist` is a slip."),
    Rule("names in C++ and C", "", r"the (flattened|C\+\+) name", "",
         "Valid; but two things would have one name in C++, in the flattened IDL or in C (README, What is refused)."),
    Rule("idlc: enumerator of another type", "idlc", r"an enumerator of \w+ is expected", "",
         "7.4.1.4.3: the value is an enumerator of the constant's type; idlc takes any."),
    Rule("idlc: annotation in other letters", "idlc", r"@key: '\w+' cannot be a key", r"@Key",
         "7.4.15: @Key is unknown, and passed over by idlc; Skein takes it for the @key that it is in older IDL."),
    Rule("idlc: octal beyond a byte", "idlc", r"is no byte", r"\\777", "7.2.6.2: a char has one byte; idlc drops the ninth bit."),
    Rule("idlc: unknown escape", "idlc", r"there is no escape", r"\\q",
         "7.2.6.2: what stands behind a backslash is one of a list; idlc warns."),
    Rule("idlc: number or text", "idlc", r"a number is expected here", "",
         "7.4.1.4.3: a floating-point constant is a number; idlc does not look."),
    Rule("idlc: hexadecimal without digits", "idlc", r"'x' stands", r"0x", "7.2.6.1: 0x is followed by a digit."),
    Rule("idlc: member of a distant base", "idlc", r"there is a member '\w+' already", r"struct C : B",
         "7.5.2: a struct has a name once, inherited ones included; idlc looks at its direct base."),
    Rule("shift in a bound", "", r"'>' stands", r">> 1>",
         "7.4.1.4.4: `>>` would end two sequences; the tools take it for a shift, Skein wants parentheses."),
]  # fmt: skip

RULES = _LENIENT + _IDLC + _FASTDDSGEN + _EITHER + _ACCEPTED + _UNCHECKED


def explanation(judge, skein, verdict, text):
    """The rule that explains why a tool's verdict is not Skein's; None without one."""
    if skein.accepted is None:
        return None
    said = verdict.said if skein.accepted else skein.said
    return next((rule for rule in RULES if rule.explains(judge, said, text)), None)


def compared(path, text, skein, verdicts):
    """Whether every tool's verdict is Skein's or explained."""
    explained = True
    for judge, verdict in verdicts.items():
        if verdict.accepted == skein.accepted:
            continue
        if rule := explanation(judge, skein, verdict, text):
            rule.uses += 1
            continue
        explained = False
        print(f"\n{path}, where {judge} differs without a rule:\n{text}")
        for name, each in {"skein": skein, **verdicts}.items():
            print(f"{name}: {'accepted' if each.accepted else 'refused'}\n{each.said.strip()}")
    return explained


def main():
    tools = [name for name, program in (("idlc", IDLC), ("fastddsgen", FASTDDSGEN)) if shutil.which(program)]
    if not tools:
        print("Skipped: neither idlc nor fastddsgen is installed")
        return 77
    files = verdict_corpus.files(SEED, COUNT)
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, f"f{number}.idl") for number in range(COUNT)]
        out = {judge: os.path.join(folder, judge) for judge in ("skein", *tools)}
        for judge in tools:
            os.mkdir(out[judge])
        for path, (_, text) in zip(paths, files):
            with open(path, "w", encoding="utf-8", newline="") as stream:
                stream.write(text)
        skein = [by_skein(path, out["skein"]) for path in paths]
        by_tool = {}
        if "idlc" in tools:
            by_tool["idlc"] = [by_idlc(path, out["idlc"]) for path in paths]
        if "fastddsgen" in tools:
            by_tool["fastddsgen"] = by_fastddsgen(paths, out["fastddsgen"])
    return judged(files, skein, by_tool)


def judged(files, skein, by_tool):
    """Says what was found; the exit code."""
    unexplained = agreed = 0
    for number, (name, text) in enumerate(files):
        verdicts = {judge: verdicts[number] for judge, verdicts in by_tool.items()}
        agreed += all(each.accepted == skein[number].accepted for each in verdicts.values())
        unexplained += not compared(f"file {number} ({name})", text, skein[number], verdicts)
    for rule in RULES:
        if rule.uses:
            print(f"{rule.uses:5} {rule.name}: {rule.why}")
    unused = [rule.name for rule in RULES if not rule.uses] if COUNT >= _FULL and SEED == 1 and len(by_tool) == 2 else []
    if unused:
        print(f"rules that explain nothing: {', '.join(unused)}")
    said = [f"all agree on {agreed}"]
    for judge, verdicts in by_tool.items():
        said.append(f"{judge} differs on {sum(one.accepted != other.accepted for one, other in zip(skein, verdicts))}")
    print(f"{COUNT} files: {', '.join(said)}; {f'{unexplained} are unexplained' if unexplained else 'all explained'}")
    return 1 if unexplained or unused else 0


if __name__ == "__main__":
    sys.exit(main())
