"""Accepted or refused: Skein's verdict on small IDL files, compared with that of idlc.

verdict_test.py SKEIN_ROOT IDLC [COUNT [SEED]]

Where idlc disagrees, a rule below has to say why; a disagreement without a rule is a failure, and so is, in a run of at least 4,000
files with the default seed, a rule without a disagreement.
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

ROOT, IDLC = sys.argv[1:3]
COUNT = int(sys.argv[3]) if len(sys.argv) > 3 else 100
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
sys.path.insert(0, f"{ROOT}/idl/compiler")
sys.dont_write_bytecode = True
try:
    from compilation import Compilation
except ImportError:
    print("Skipped: python3-lark is not installed")
    sys.exit(77)

import verdict_corpus

_IDLC_SECONDS = 3  # idlc never ends on some files, and takes all memory
_FULL = 4000  # from so many files on each rule must have been needed


@dataclass
class Verdict:
    accepted: bool  # None after a crash
    said: str


# ---- the two judges


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


# ---- why they disagree


@dataclass
class Rule:
    """Explains why the verdicts differ on a file: who refuses it says `said`, and it has `text`. Both are regular expressions. Sections are
    those of OMG IDL 4.2."""

    name: str
    said: str
    text: str
    why: str
    uses: int = 0

    def explains(self, said, text):
        return re.search(self.said, said) and re.search(self.text, text)


_SYNTAX = r"syntax error"
_NAMED = r"(struct|module|long|short|string|,|>) ({})( [{{:]|;| }}|, y|<5>)".format("|".join(verdict_corpus.KEYWORDS))
_OWN_NAME = r"(struct|module|union|enum) (\w+) [^{]*{[^}]*(struct|const long|long|enum|module|const T|[{,]) \2\b|struct T { long x; } T;"
_UNCHECKED_ANNOTATION = (r"Unknown annotation member|Scoped name '(BAD|m|OTHER)'|Cannot evaluate|Missing assignment|"
                         r"Declaration 'a' collides")  # fmt: skip

# Skein takes what the specification does not have: published IDL is written so, or nothing is lost by it.
_LENIENT = [
    Rule("own name inside", r"collides with", _OWN_NAME,
         "7.5.2: the name of a module, a struct or a union may not be declared anew directly inside it. RTI's own examples do it; in C++ "
         "the member gets another name."),
    Rule("typedef again", r"collides with", r"typedef .* (\w);\s*typedef .* \1;|A, A;", "7.5.2: a name is declared once; IDL that ROS 2 makes repeats its typedefs."),
    Rule("width of an enumeration", r"Enumerator overflow", r"@bit_bound\(1\)", "8.3.4.1: values fit into the bits; Skein counts whole bytes."),
    Rule("annotations unchecked", _UNCHECKED_ANNOTATION, r"@\w",
         "7.4.15: an annotation is declared once, and has the members that it declares, of their types. Skein keeps those that have no "
         "effect, and does not look into them."),
    Rule("member of an annotation", _SYNTAX, r"@annotation foo { sequence",
         "7.4.15: an annotation's members are of types that constants have."),
    Rule("annotation before a name", _SYNTAX, r"long @\w+ a;",
         "7.4.15: an annotation stands before the type. Skein takes one between type and name for that name alone."),
    Rule("empty parentheses", _SYNTAX, r"@\w+\(\)", "7.4.15: the parentheses of an annotation are not empty."),
    Rule("extensibility of a base", r"Extensibility of inherited type", "@mutable",
         "DDS-XTypes 1.3, 7.2.2.4.5: a struct and its base have the same extensibility. Skein warns."),
    Rule("empty module", _SYNTAX, r"module \w+ {[\s\\]*}", "7.4.1.4.2: a module has a definition at least; macros may leave none."),
]  # fmt: skip

# idlc 0.10 refuses what Skein accepts, and that is valid if the rule does not say otherwise.
_IDLC = [
    Rule("wide characters", r"syntax error|'L' cannot be resolved|signal 6", r"\bw(char|string)\b",
         "7.4.1.4.4: valid; idlc has neither wchar nor wstring, and aborts where a type has one."),
    Rule("extended types", r"syntax error", r"\b(map<|bitset|bitfield)", "7.4.13: valid; idlc has no maps and no bitsets."),
    Rule("other building blocks", r"syntax error", r"\b(exception|interface|any|fixed|native|valuetype|typeid|typeprefix|import)\b",
         "7.4.2 to 7.4.6: valid; idlc has data types alone. Skein reads the others, and leaves out with a warning what cannot travel "
         "and is not used."),
    Rule("loose constants", r"Cannot evaluate (enumerator|integer literal|expression) as|name '([Tt]rue|false)'", r"const |case ",
         "7.4.1.4.3 has none of enumerators as numbers, of numbers as booleans and characters, and of `true`; Skein takes what other "
         "compilers take."),
    Rule("recursion", r"Type id not found|signal \d+", r"sequence<[SU]\b|@optional S",
         "7.4.1.4.4: valid, a sequence may hold the type that it is in, and in DDS-XTypes an optional member; idlc 0.10 never ends, or "
         "loses the type."),
    Rule("shift by 32", r"Invalid integer expression", r">> (32|63)",
         "7.4.1.4.3: valid, a shift goes by 0 to 63; idlc reckons in 32 bits."),
    Rule("scoped base", r"'m' collides with", r": m::A", "7.5.1: valid; idlc takes the module for declared anew."),
    Rule("scope of bits", r"collides with", r"bitmask N", "DDS-XTypes 1.3, 7.3.1.2.1.3: bits are known within their bitmask, as Skein has them."),
    Rule("two extensibilities", r"clashes with an earlier annotation", r"@final @mutable",
         "8.3.1: each says something of its own; Skein takes the last."),
    Rule("type in its use", r"syntax error", r"(struct|union|enum) \w+ (switch \(long\) )?{[^{}]*} \w+|switch \(enum",
         "Older IDL declares a type where it uses it, and Skein reads that; in a switch IDL 4.2 does not have it either."),
    Rule("enumeration as a scope", r"does not resolve to an enumerator", r"[EF]::[A-Z]",
         "7.5.2: an enumeration is no scope; Skein takes `E::A` as well as `A`, as C++ does."),
    Rule("label beyond 32 bits", r"INT32_MIN", "",
         "7.4.1.4.4: valid, a label is any value of its type; idlc's type information has 32 bits."),
    Rule("complement", r"Integer expression overflows", r"~|-\(",
         "7.4.1.4.3: valid, `~` of an unsigned type is its greatest value less the operand; idlc reckons in 32 bits without a sign."),
    Rule("name in an annotation", r"Scoped name '\w+' cannot be resolved", r"@\w+\(N\)",
         "7.4.15: valid, a constant is an argument; idlc looks for its name in the annotation."),
    Rule("annotation elsewhere", r"can(not| only) be (applied|assigned)|attempt to set limits", r"@",
         "8.3 says where each annotation has a meaning. Elsewhere Skein gives it none; idlc refuses it."),
    Rule("place of an annotation", r"syntax error", r"sequence<@|a @\w+(\(\d\))? \[|@\w+(\(\d\))? case|[^:]::final",
         "7.4.15 and DDS-XTypes 1.3: valid before a type within a type, a case, and an array's size; idlc has no annotations there."),
    Rule("scoped annotation", r"syntax error|Unrecognized annotation: @m", r"@(m)?::",
         "7.4.15: valid, an annotation's name is a scoped name; idlc has plain ones."),
    Rule("unknown annotation", r"Unrecognized annotation", r"@bogus",
         "7.4.15: valid, what is not known is passed over; idlc does so in some places."),
    Rule("blank in an annotation", r"syntax error", r"@ key", "7.4.15: valid, `@` and the name are two tokens."),
    Rule("keys and numbers", r"currently unsupported|expand on keys", r"@key|long double",
         "8.3.2: valid; idlc has no keys that are arrays of structs, none in unions, none beside those of a base, and no long double."),
    Rule("keylist", r"Duplicate key", r"#pragma keylist S a a",
         "No specification has the pragma; Skein takes a key that is named twice once."),
    Rule("control-Z", r"Illegal control character", "\x1a",
         "7.2 has no such character; old files end in it, and Skein passes it over."),
    Rule("byte order mark", r"syntax error", "\ufeff", "7.2: IDL is Latin-1; Skein's is UTF-8, and may begin with its mark."),
    Rule("accented character", r"invalid character constant", r"'é'",
         "7.2: valid, one character of Latin-1; idlc counts the two bytes of UTF-8."),
    Rule("preprocessor's dialect", r"#directive", r"(?m)^#",
         "7.3: the preprocessor of ISO C++ 2003; Skein's cpp also knows `#warning` and the marks of lines."),
    Rule("keyword of another building block", _SYNTAX, _NAMED,
         "7.2.4 reserves `home` and `port`, too; Skein by design does not, as older IDL has such names (grammar.lark)."),
    Rule("brackets", r"syntax error|cannot be resolved", r">>",
         "7.4.1.4.4: the ends of nested sequences, which older IDL had to write apart; idlc reads them as a shift."),
    Rule("value of an enumerator", _SYNTAX, r"enum E { \w+ = 3",
         "Beyond the specification, which has @value; Skein takes both, as other compilers."),
    Rule("default without a value", r"Invalid default label", r"default:",
         "7.4.1.4.4 has one default at most; where every value has its case, Skein warns and leaves it out."),
]  # fmt: skip

# idlc accepts what Skein refuses, with the specification unless the rule says otherwise.
_ACCEPTED = [
    Rule("size", r"is no size", "",
         "7.4.1.4.4: a size is positive; Skein's greatest is 2^31 - 1. idlc takes 0 and cuts off what is too large."),
    Rule("scope that is none", r"holds no names", "",
         "7.5.1: a constant and a struct's member hold no names; idlc looks for the last part."),
    Rule("range", r"does not fit into", "",
         "7.4.1.4.3: a constant fits its type. idlc errs at 64 bits. An @bit_bound(8) enumeration is signed."),
    Rule("bound of text", r"the text has \d+", "", "7.4.1.4.3: a constant fits its type; idlc does not look at the bound."),
    Rule("zero byte", r"cannot hold a zero", "", "7.2.6.3: text has no zero byte."),
    Rule("underscores in front", r"the character '_'", r"\b_([_\d]|\W)",
         "7.2.3: behind the underscore that escapes it an identifier begins with a letter."),
    Rule("keylist", r"#pragma keylist: ", r"#pragma keylist",
         "No specification has the pragma. A misspelt key would be lost, so Skein refuses it; idlc passes over it."),
    Rule("unknown pragma", r"unknown pragma", r"#pragma", "7.3 lets unknown pragmas be; one that is almost `keylist` is a slip."),
    Rule("names in C++ and C", r"the (flattened|C\+\+) name", "",
         "Valid; but two things would have one name in C++, in the flattened IDL or in C (README, What is refused)."),
    Rule("type of a constant", r"a constant is a number", "", "7.4.1.4.3: a constant has a basic type; idlc takes an array's element for it."),
    Rule("enumerator of another type", r"an enumerator of [\w:]+ is expected", "",
         "7.4.1.4.3: the value is an enumerator of the constant's type; idlc takes any."),
    Rule("annotation in other letters", r"@key: '\w+' cannot be a key", r"@Key",
         "7.4.15: @Key is unknown, and passed over by idlc; Skein takes it for the @key that it is in older IDL."),
    Rule("octal beyond a byte", r"is no byte", r"\\777", "7.2.6.2: a char has one byte; idlc drops the ninth bit."),
    Rule("unknown escape", r"there is no escape|belongs to wide text", r"\\[qu]",
         "7.2.6.2: what stands behind a backslash is one of a list; idlc warns."),
    Rule("number or text", r"a number is expected here", "",
         "7.4.1.4.3: a floating-point constant is a number; idlc does not look."),
    Rule("hexadecimal without digits", r"'x' stands", r"0x", "7.2.6.1: 0x is followed by a digit."),
    Rule("member of a distant base", r"there is a member '\w+' already", r"struct C : B",
         "7.5.2: a struct has a name once, inherited ones included; idlc looks at its direct base."),
    Rule("shift in a bound", r"'>' stands", r">> 1>",
         "7.4.1.4.4: `>>` would end two sequences; idlc takes it for a shift, Skein wants parentheses."),
]  # fmt: skip

RULES = _LENIENT + _IDLC + _ACCEPTED


def is_explained(number, name, text, skein, idlc):
    """Whether the verdicts are one, or a rule says why they are not."""
    if skein.accepted == idlc.accepted:
        return True
    said = idlc.said if skein.accepted else skein.said
    if skein.accepted is not None and (rule := next((rule for rule in RULES if rule.explains(said, text)), None)):
        rule.uses += 1
        return True
    print(f"\nfile {number} ({name}), where idlc differs without a rule:\n{text}")
    for judge, each in (("skein", skein), ("idlc", idlc)):
        print(f"{judge}: {'accepted' if each.accepted else 'refused'}\n{each.said.strip()}")
    return False


def main():
    if not shutil.which(IDLC):
        print("Skipped: idlc is not installed")
        return 77
    differing = unexplained = 0
    with tempfile.TemporaryDirectory() as folder:
        for number, (name, text) in enumerate(verdict_corpus.files(SEED, COUNT)):
            path = os.path.join(folder, f"f{number}.idl")
            with open(path, "w", encoding="utf-8", newline="") as stream:
                stream.write(text)
            skein, idlc = by_skein(path, os.path.join(folder, "skein")), by_idlc(path, folder)
            differing += skein.accepted != idlc.accepted
            unexplained += not is_explained(number, name, text, skein, idlc)
    for rule in RULES:
        if rule.uses:
            print(f"{rule.uses:5} {rule.name}: {rule.why}")
    unused = [rule.name for rule in RULES if not rule.uses] if COUNT >= _FULL and SEED == 1 else []
    if unused:
        print(f"rules that explain nothing: {', '.join(unused)}")
    said = f"{unexplained} are unexplained" if unexplained else "all explained"
    print(f"{COUNT} files, idlc differs on {differing}: {said}")
    return 1 if unexplained or unused else 0


if __name__ == "__main__":
    sys.exit(main())
