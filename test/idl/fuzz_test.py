"""Random and damaged IDL: the compiler neither crashes nor says anything without its place; what it accepts, it compiles.

fuzz_test.py SKEIN_ROOT [COUNT [SEED]]     (a finding prints the seed and keeps the file)
"""

import contextlib
import glob
import io
import os
import random
import re
import shutil
import sys
import tempfile
import traceback

ROOT = sys.argv[1]
COUNT = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 1
sys.path[:0] = [os.path.dirname(os.path.abspath(__file__)), f"{ROOT}/idl/compiler"]
sys.dont_write_bytecode = True
try:
    from compilation import Compilation
except ImportError:
    print("Skipped: python3-lark is not installed")
    sys.exit(77)
from random_idl import Generator

_TOKEN = re.compile(r'"[^"\n]*"|[A-Za-z_]\w*|\d+|\s+|.', re.DOTALL)
_PLACE = re.compile(r"[^\s:]+:\d+(:\d+)?: (error|warning): \S")
_WORDS = """struct union enum interface module typedef const exception sequence string wstring map bitset bitmask bitfield long short octet
    double any fixed in out inout raises oneway attribute readonly void case default switch @key @optional @appendable @mutable @id(3) @id
    @default(1) @bit_bound(8) @stream @value @position @hashid ::A A B a b 0 1 -1 1.5 'c' "t" L"w" TRUE ; { } ( ) < > [ ] , : :: = + - ~ << |
    #include #pragma /* */ //""".split()


def damaged(text, dice):
    """A few tokens or characters are taken away, doubled, exchanged or replaced."""
    parts = _TOKEN.findall(text) if dice.random() < 0.7 else list(text)
    for _ in range(dice.randrange(1, 6)):
        if not parts:
            break
        at = dice.randrange(len(parts))
        kind = dice.randrange(5)
        if kind == 0:
            del parts[at : at + dice.randrange(1, 4)]
        elif kind == 1:
            parts.insert(at, parts[dice.randrange(len(parts))])
        elif kind == 2:
            parts[at] = dice.choice(_WORDS)
        elif kind == 3:
            parts[at] = chr(dice.choice([0, 9, 34, 39, 64, 92, 127, 233, 0x20AC, 0x1D11E]))
        else:
            other = dice.randrange(len(parts))
            parts[at], parts[other] = parts[other], parts[at]
    return "".join(parts)


def fault(path, out):
    """What the compiler did wrong with a file; None if nothing."""
    said = io.StringIO()
    try:
        with contextlib.redirect_stderr(said):
            compilation = Compilation(path, [f"{ROOT}/idl/skein"], [])
            if compilation.accepted:
                compilation.write(out, "x.idl")
    except BaseException:
        return traceback.format_exc()
    findings = [line for line in said.getvalue().splitlines() if ": error: " in line or ": warning: " in line]
    if not compilation.accepted and not any(": error: " in line for line in findings):
        return "refused without a finding: " + said.getvalue()
    stray = [line for line in findings if not _PLACE.match(line) and line not in sources(path)]
    return f"a finding without a place: {stray[0]}" if stray else None


def sources(path):
    with open(path, encoding="utf-8", errors="replace") as stream:
        return stream.read().splitlines()


def main():
    seeds = []
    for name in sorted(glob.glob(f"{ROOT}/test/**/*.idl", recursive=True) + glob.glob(f"{ROOT}/idl/*/*.idl")):
        with open(name, encoding="utf-8") as stream:
            seeds.append(stream.read())
    accepted_by_chance = 0
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "x.idl")
        for number in range(COUNT):
            dice = random.Random(f"{SEED} {number}")
            text = Generator(dice).file() if dice.random() < 0.6 else dice.choice(seeds)
            if dice.random() < 0.7:
                text = damaged(text, dice)
            with open(path, "w", encoding="utf-8", errors="replace") as stream:
                stream.write(text)
            shutil.rmtree(os.path.join(folder, "out"), ignore_errors=True)
            if wrong := fault(path, os.path.join(folder, "out")):
                kept = shutil.copy(path, os.path.join(tempfile.gettempdir(), f"skein_idl_fuzz_{SEED}_{number}.idl"))
                print(f"seed {SEED}, file {number}, kept as {kept}: {wrong}")
                return 1
            accepted_by_chance += os.path.isdir(os.path.join(folder, "out"))
    print(f"{COUNT} files, of which {accepted_by_chance} were accepted")
    return 0 if 0 < accepted_by_chance < COUNT else 1


sys.exit(main())
