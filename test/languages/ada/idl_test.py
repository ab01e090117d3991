"""Ada for IDL: idl_test.py ROOT FOLDER|SEED... Of each file in these folders of ROOT, and of a random file for each seed, random values of all types, which
C++ has written, are read and written by Ada, and come back as they were."""

import functools
import glob
import json
import os
import random
import re
import struct
import subprocess
import sys
import tempfile

import skein

ROOT, *PARTS = sys.argv[1:]
sys.path.append(os.path.join(ROOT, "test", "idl"))
from random_idl import Generator

ADA = os.path.join(ROOT, "src", "languages", "ada")
VALUES = 8
_INTEGERS = {"Int8": 7, "Octet": 8, "Short": 15, "UnsignedShort": 16, "Long": 31, "UnsignedLong": 32, "LongLong": 63, "UnsignedLongLong": 64}


class Draw:
    """Random values of the types of one description."""

    def __init__(self, dice, described, classes):
        self.dice = dice
        self.classes = classes
        self.declared = {each["name"]: each for each in described["declarations"]}

    def value(self, kind, depth=0):
        name, dice = kind["kind"], self.dice
        if name in _INTEGERS:
            bits = _INTEGERS[name]
            return dice.choice([0, 1, 2**bits - 1, dice.getrandbits(bits), *([-(2**bits)] if bits % 2 else [])])
        if name in ("Float", "Double", "LongDouble"):
            return dice.choice([0.0, -1.0, dice.getrandbits(20) / 64])
        if name == "Boolean":
            return dice.random() < 0.5
        if name in ("Char", "WideChar"):
            return dice.choice("az\x7f" if name == "Char" else "az\u20ac\uffff")
        if name in ("String", "WideString"):
            text = dice.choice(["", "a", "ab \u20ac", "x" * 70])
            return text if len(text.encode()) <= (kind["bound"] or 999) else "a"
        return self._compound(kind, depth)

    def _compound(self, kind, depth):
        name, dice = kind["kind"], self.dice
        if name == "OptionalMember":
            return None if depth > 4 or dice.random() < 0.5 else self.value(kind["elements"][0], depth + 1)
        if name in ("Sequence", "Array"):
            count = kind["bound"] if name == "Array" else 0 if depth > 4 else dice.randint(0, min(kind["bound"] or 3, 3))
            drawn = [self.value(kind["elements"][0], depth + 1) for _ in range(count)]
            return bytes(drawn) if kind["elements"][0]["kind"] == "Octet" else drawn
        if name == "Map":
            count = 0 if depth > 4 else dice.randint(0, min(kind["bound"] or 3, 3))
            return {self.value(kind["elements"][0]): self.value(kind["elements"][1], depth + 1) for _ in range(count)}
        return skein.Reference("a/B", bytes(range(16)), "c") if name == "Reference" else self.of(kind["name"], depth)

    def of(self, name, depth=0):
        """A value of a declared type."""
        declared, made = self.declared[name], self.classes[name]
        if depth > 6 and declared["kind"] in ("Struct", "Union"):
            return made()
        if declared["kind"] == "Enumeration":
            return self.dice.choice(list(made))
        if declared["kind"] == "Bitmask":
            return made(sum(1 << each["value"] for each in declared["values"] if self.dice.random() < 0.5))
        if declared["kind"] == "Union":
            case = self.dice.choice(declared["members"])
            return made(**{skein._types.case_name(case["name"]): self.value(case["type"], depth + 1)})
        fields = [each for each in declared["fields"] if each["name"]]
        drawn = {each["name"]: self.value(each["type"], depth + 1) for each in declared["members"]} | {each["name"]: self._bits(each) for each in fields}
        return made(**{skein._types.python_name(each): value for each, value in drawn.items()})

    def _bits(self, field):
        if field["kind"] == "Boolean":
            return self.dice.random() < 0.5
        bits = self.dice.getrandbits(field["width"])
        return bits - (1 << field["width"]) if _INTEGERS[field["kind"]] % 2 and bits >> (field["width"] - 1) else bits


def files(folder):
    """Without those that have the name of another one: examples have the same service."""
    found = [path for part in PARTS if not part.isdigit() for path in glob.glob(os.path.join(ROOT, part, "**", "*.idl"), recursive=True)]
    for seed in filter(str.isdigit, PARTS):
        found.append(os.path.join(folder, f"random_{seed}.idl"))
        with open(found[-1], "w", encoding="utf-8") as stream:
            stream.write(Generator(random.Random(seed), strict=True).file())
    return sorted({os.path.basename(path): path for path in found}.values())


def ada_types(body):
    """{IDL name: Ada name} of the types of a generated package."""
    found, around = {}, []
    for line in body.splitlines():
        if opened := re.match(r" *package body (\w+) is$", line):
            around.append(opened[1])
        elif around and re.match(rf" *end {around[-1]};$", line):
            around.pop()
        elif made := re.search(r'function (\w+)_Topic_Type return .*Skein\."\+" \("([^"]+)"\)', line):
            found[made[2]] = ".".join([*around, made[1]])
    return found


_PROGRAM = """with Ada.Streams; with Ada.Text_IO.Text_Streams; with Skein.CDR; with Skein.Types; {withs}
procedure Back is
   use Ada.Text_IO.Text_Streams; use Skein;
   Given : constant Stream_Access := Stream (Ada.Text_IO.Standard_Input);
   Told  : constant Stream_Access := Stream (Ada.Text_IO.Standard_Output);
   procedure Send (Message : Bytes) is
   begin
      Integer'Write (Told, Message'Length);
      Bytes'Write (Told, Message);
   end Send;
   generic
      type Value is private;
      Of_Type : Types.Topic_Type;
      with procedure Put (Into : in out CDR.Writer; Item : Value);
      with procedure Get (From : in out CDR.Reader; Item : out Value);
   procedure Come_Back (Message : Bytes);
   procedure Come_Back (Message : Bytes) is
      From : CDR.Reader := CDR.Read (Message'Address, Message'Length);
      Into : CDR.Writer (Of_Type.Representation);
      Item : Value;
   begin
      Get (From, Item);
      Put (Into, Item);
      Send (CDR.Message (Into));
   end Come_Back;
{instances}
begin
   loop
      declare
         Number  : constant Integer := Integer'Input (Given);
         Message : Bytes (1 .. Ada.Streams.Stream_Element_Offset (Integer'Input (Given)));
      begin
         Bytes'Read (Given, Message);
         case Number is
{choices}
            when others => exit;
         end case;
      end;
   end loop;
end Back;
"""


def program(types):
    """Of which the type with that number takes a message, and writes it again."""
    units = sorted({ada.split(".")[0] for ada in types})
    instances, choices = [], []
    for number, ada in enumerate(types):
        home = ada.rpartition(".")[0]
        instances.append(f"   procedure Back_{number} is new Come_Back ({ada}, {ada}_Topic_Type, {home}.Put, {home}.Get);")
        choices.append(f"            when {number} => Back_{number} (Message);")
    return _PROGRAM.format(withs=" ".join(f"with {unit};" for unit in units), instances="\n".join(instances), choices="\n".join(choices))


def compiled(paths, folder):
    """{Ada type: (file, IDL name)} of all that is not refused for every language."""
    types = {}
    for path in paths:
        command = ["/usr/bin/python3", "-B", os.path.join(ROOT, "idl", "compiler"), "--language", "ada", "--out", folder,
                   f"-I{os.path.dirname(path)}", f"-I{os.path.join(ROOT, 'idl')}", f"-I{os.path.join(ROOT, 'idl', 'navigation')}", path]  # fmt: skip
        before = set(glob.glob(os.path.join(folder, "**", "*.adb"), recursive=True))
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if "Traceback" in done.stderr:
            raise AssertionError(done.stderr)
        for body in set(glob.glob(os.path.join(folder, "**", "*.adb"), recursive=True)) - before:
            with open(body, encoding="utf-8") as stream:
                types.update((ada, (path, idl)) for idl, ada in ada_types(stream.read()).items())
    return types


def build(types, folder):
    with open(os.path.join(folder, "back.adb"), "w", encoding="utf-8") as stream:
        stream.write(program(types))
    folders = {os.path.dirname(each) for each in glob.glob(os.path.join(folder, "**", "*.ads"), recursive=True)}
    command = ["gnatmake", "-q", "-O0", "-gnata", *(f"-aI{each}" for each in [*sorted(folders), ADA]), "-aO" + os.environ["SKEIN_ADA_OBJECTS"], "back.adb"]
    subprocess.run([*command, "-largs", *os.environ["SKEIN_LINK"].split()], cwd=folder, check=True)
    return os.path.join(folder, "back")


def values(types):
    """(number of the type, what encodes it, its IDL name, value)"""
    modules = {}
    for number, (path, idl) in enumerate(types.values()):
        if path not in modules:
            modules[path] = skein.load(path, include=(os.path.join(ROOT, "idl"), os.path.dirname(path), os.path.join(ROOT, "idl", "navigation")))
        known = functools.reduce(getattr, map(skein._types.python_name, idl.split("::")), modules[path])._skein_types
        described = json.loads(known.describe())["types"]
        draw = Draw(random.Random(f"{path} {idl}"), described, skein._types.build(known, described, ""))
        for _ in range(VALUES):
            yield number, known, idl, draw.of(idl)


def main():
    with tempfile.TemporaryDirectory() as folder:
        types = compiled(files(folder), folder)
        sent = list(values(types))
        ada = build(types, folder)
        given = b"".join(struct.pack("<ii", number, len(message)) + message for number, message in ((each[0], each[1].encode(*each[2:])) for each in sent))
        told = subprocess.run([ada], input=given + struct.pack("<ii", -1, 0), stdout=subprocess.PIPE, check=True).stdout
        wrong = at = 0
        for number, known, idl, value in sent:
            (size,) = struct.unpack_from("<i", told, at)
            back, value = known.decode(idl, told[at + 4 : at + 4 + size]), known.decode(idl, known.encode(idl, value))
            at += 4 + size
            if back != value:
                wrong += 1
                print(f"{idl}: {value} came back as {back}")
        print(f"{len(sent)} values of {len(types)} types came back, {wrong} of them wrong")
        return 1 if wrong or not types else 0


sys.exit(main())
