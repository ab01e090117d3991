"""Python for every IDL file of the source tree: idl_test.py ROOT. It is loaded, its stub parses and names the same, and its values come back."""

import ast
import enum
import glob
import math
import os
import random
import subprocess
import sys
import tempfile
import types
import unittest

import skein

ROOT = sys.argv.pop()
COMPILER = ["/usr/bin/python3", "-B", os.path.join(ROOT, "idl", "compiler"), "--language", "python"]


def files():
    for folder in ("idl", "test", "examples", "benchmarks", "src", "brokerless_discovery"):
        yield from sorted(glob.glob(os.path.join(ROOT, folder, "**", "*.idl"), recursive=True))


def classes(scope, found):
    """All classes of types in a module, by their IDL names."""
    for each in vars(scope).values():
        if isinstance(each, type) and each.__module__ == found["module"]:
            if hasattr(each, "_skein_types"):
                found[each._skein_name] = each
            classes(each, found)
    return found


def names_of(body, prefix=""):
    for each in body:
        if isinstance(each, ast.ClassDef):
            yield prefix + each.name
            yield from names_of(each.body, prefix + each.name + ".")


def resolved(module, name):
    for part in name.split("."):
        module = getattr(module, part)
    return module


def compiled(path, folder):
    """The module, and the names of the classes in its stub; None for what the compiler refuses for every language."""
    command = [*COMPILER, "--out", folder, "-I", os.path.join(ROOT, "idl"), "-I", os.path.dirname(path), path]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        if "Traceback" in done.stderr:
            raise AssertionError(done.stderr)
        return None
    (source,) = glob.glob(os.path.join(folder, "**", "*.py"), recursive=True)
    module = types.ModuleType(os.path.basename(source).removesuffix(".py"))
    with open(source, encoding="utf-8") as code, open(source + "i", encoding="utf-8") as stub:
        exec(compile(code.read(), source, "exec"), module.__dict__)
        text = stub.read()
        compile(text, source + "i", "exec")
        return module, list(names_of(ast.parse(text).body))


class Every(unittest.TestCase):
    def test_file_is_loaded_as_its_stub_says_and_its_values_come_back(self):
        loaded = 0
        for path in files():
            with self.subTest(file=path), tempfile.TemporaryDirectory() as folder:
                if (made := compiled(path, folder)) is None:
                    continue
                module, names = made
                loaded += 1
                for name in names:
                    self.assertTrue(resolved(module, name))
                found = classes(module, {"module": module.__name__})
                for name in found.keys() - {"module"}:
                    with self.subTest(type=name):
                        self.comes_back(found[name], name)
        self.assertGreater(loaded, 20)

    def comes_back(self, made, name):
        known = made._skein_types
        for value in [made(), *(self.changed(made(), random.Random(seed), 3) for seed in range(5))]:
            back = known.decode(name, known.encode(name, value))
            self.assertEqual(known.encode(name, back), known.encode(name, value))
            self.assertEqual(repr(back), repr(value))

    def changed(self, value, draw, depth):
        """One of the same type with other numbers, text and members."""
        if isinstance(value, enum.Enum):
            return value if isinstance(value, enum.Flag) else draw.choice(list(type(value)))
        if isinstance(value, (bool, type(None))):
            return value if value is None else draw.random() < 0.5
        if isinstance(value, int):
            return draw.randint(0, 1)
        if isinstance(value, float):
            return math.floor(draw.random() * 64) / 8
        if isinstance(value, str):
            return value  # of a bound that is not known here
        if isinstance(value, skein.Union):
            value.value = self.changed(value.value, draw, depth - 1)
        for name in getattr(value, "_skein_members", ()) if depth else ():
            setattr(value, name, self.changed(getattr(value, name), draw, depth - 1))
        return value


if __name__ == "__main__":
    unittest.main(verbosity=2)
