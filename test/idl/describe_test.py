"""Types at run time: what generated code says of itself, printed as IDL and compiled again, gives the same code: descriptions, hashes,
signatures, and what tells one version of a type from another. By its description alone, each type has the same bytes and the same JSON as
in generated code. For random type systems and for the IDL of the tests.

describe_test.py SKEIN_ROOT CXX LIBSKEIN FOLDER_OF_GENERATED_HEADERS [COUNT [SEED]]
"""

import contextlib
import io
import os
import random
import re
import shutil
import subprocess
import sys

ROOT, CXX, LIBRARY, GENERATED = sys.argv[1:5]
COUNT = int(sys.argv[5]) if len(sys.argv) > 5 else 12
SEED = int(sys.argv[6]) if len(sys.argv) > 6 else 1
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, f"{ROOT}/idl/compiler"]
sys.dont_write_bytecode = True
try:
    from compilation import Compilation
except ImportError:
    print("Skipped: python3-lark is not installed")
    sys.exit(77)
from random_idl import Generator

# What must be the same: descriptions; names, hashes and signatures of operations; hashes of exceptions; members of types that grow.
_FACTS = re.compile(r'"[\w:]+", \{\{".*?", \d+\}|\{"\w+", 0x\w{8}U, 0x\w{16}ULL, .*|"[\w:]+", 0x\w{8}U|\{0x\w{8}U, 0x\w{8}U, 0x\w{8}U, .*|\{"\\000\\001.*?", \d+\}\}')
_TYPES = re.compile(r"^const ::skein::TypeSupport& type_support\(const (\S+)\*\);", re.MULTILINE)
_INTERFACES = re.compile(r"^const ::skein::InterfaceInfo& (\S+)::interface_info\(\) \{", re.MULTILINE)
_NAMESPACE = re.compile(r"^namespace (\S+) \{|^\}  // namespace (\S+)", re.MULTILINE)


def compiled(path, out, namespace):
    """The generated header and source; None where the file was refused."""
    said = io.StringIO()
    with contextlib.redirect_stderr(said):
        compilation = Compilation(path, [f"{ROOT}/idl/skein"], [], (namespace,))
        if not compilation.accepted:
            return None, said.getvalue()
        compilation.write(out, os.path.basename(path))
    texts = []
    for suffix in (".hpp", ".cpp"):
        with open(os.path.join(out, os.path.basename(path) + suffix), encoding="utf-8") as stream:
            texts.append(stream.read())
    return texts, said.getvalue()


def facts(source):
    return set(_FACTS.findall(source))


def described(header, source):
    """C++ that adds all types and interfaces of a file to `known`."""
    lines = [f"  known = skein::describe(*type_support_of<{name}>(), std::move(known));" for name in _TYPES.findall(header)]
    namespace = ""
    for match in re.finditer(f"{_NAMESPACE.pattern}|{_INTERFACES.pattern}", source, re.MULTILINE):
        if match[1] or match[2]:
            namespace = match[1] or ""
        else:
            lines.append(f"  known = skein::describe({namespace}::{match[3]}::interface_info(), std::move(known));")
    return lines


def write(path, text):
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(text)


def inputs(folder):
    """Paths of what is tested, and the namespaces of what is made of it."""
    for number in range(COUNT):
        path = os.path.join(folder, f"random{number}.idl")
        write(path, Generator(random.Random(f"{SEED} {number}"), strict=True).file())
        yield path, f"random{number}"
    for name in ("geometry", "everything", "extensible", "modern", "beyond_idlc", "planner", "recursive", "external"):
        yield os.path.join(HERE, name + ".idl"), "tests"


def program(folder, systems):
    """Prints each type system into NAME.printed.idl."""
    lines = ["#include <fstream>", '#include "dynamic_check.hpp"', '#include "skein/describe.hpp"', *(f'#include "{os.path.basename(path)}.cpp"' for path in systems)]
    lines += ["template <class T> const skein::TypeSupport* type_support_of() { return &type_support(static_cast<const T*>(nullptr)); }"]
    lines += ["int main() {"]
    for path, (header, source) in systems.items():
        lines += ["  {", "  skein::types::TypeSystem known;", *described(header, source)]
        lines += [f'  std::ofstream("{folder}/{os.path.basename(path)}") << skein::to_idl(known);']
        lines += ["  const skein::idl::DynamicTypes dynamic(known);"]
        lines += [f"  check_dynamic<{name}>(dynamic);" for name in _TYPES.findall(header)] + ["  }"]
    return "\n".join(lines + ["  return report();", "}", ""])


def build_and_run(folder, text):
    source, binary = os.path.join(folder, "print.cpp"), os.path.join(folder, "print")
    write(source, text)
    flags = ["-std=c++20", "-O0", "-Wall", "-Wextra", "-Werror", f"-I{ROOT}/include", f"-I{ROOT}/src", f"-I{HERE}", f"-I{GENERATED}", f"-I{folder}/first"]
    compiler = [f"{ROOT}/test/tools/cached_compiler", CXX] if shutil.which("ccache") else [CXX]
    subprocess.run([*compiler, *flags, "-c", source, "-o", f"{binary}.o"], check=True, timeout=280)
    subprocess.run([CXX, f"{binary}.o", LIBRARY, f"-Wl,-rpath,{os.path.dirname(LIBRARY)}", "-o", binary], check=True, timeout=60)
    subprocess.run([binary], check=True, timeout=120)


@contextlib.contextmanager
def empty_folder():
    """One of always the same name: the compiler's cache knows what was compiled there."""
    folder = os.path.abspath(f"describe_{COUNT}")
    shutil.rmtree(folder, ignore_errors=True)
    os.mkdir(folder)
    yield folder
    shutil.rmtree(folder)


def main():
    with empty_folder() as folder:
        for name in ("first", "printed", "second"):
            os.mkdir(os.path.join(folder, name))
        systems = {}
        for path, namespace in inputs(folder):
            texts, said = compiled(path, f"{folder}/first", namespace)
            if texts is None:
                print(f"{path} was refused: {said}")
                return 1
            systems[path] = texts
        build_and_run(folder, program(f"{folder}/printed", systems))
        failures = 0
        for path, (_, source) in systems.items():
            printed = f"{folder}/printed/{os.path.basename(path)}"
            texts, said = compiled(printed, f"{folder}/second", "again")
            lost = facts(source) - facts(texts[1]) if texts else {said}
            if lost:
                failures += 1
                with open(path, encoding="utf-8") as one, open(printed, encoding="utf-8") as other:
                    print(f"---- {path}\n{one.read()}\n---- printed\n{other.read()}\n---- lost", *sorted(lost), sep="\n")
        count = sum(len(facts(source)) for _, source in systems.values())
        print(f"{len(systems)} type systems with {count} facts, of which {failures} came back as others")
        return 1 if failures else 0


sys.exit(main())
