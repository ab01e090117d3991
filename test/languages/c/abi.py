"""The binary interface of skein.h: abi.py ROOT COMPILER LIBRARY [--write]

Compares what the header declares with the table of functions (api.h), with what the library exports, and with the snapshot abi.txt: names,
signatures, sizes and offsets. What has been released stays as it is: functions are only added, at the table's end, with a new version.
--write makes api.h and abi.txt anew."""

import os
import re
import subprocess
import sys
import tempfile

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_FUNCTION = re.compile(r"^(?!static|typedef)(\w[\w ]*?[ *]+)(skein_\w+)\(([^;{]*)\);", re.MULTILINE)
_STRUCT = re.compile(r"typedef struct (skein_\w+) \{(.*?)\} \1;", re.DOTALL)
_ENUM = re.compile(r"enum \{(.*?)\};", re.DOTALL)
_NUMBER = re.compile(r"typedef (\w+) (skein_\w+);")
_FIELD = re.compile(r"\(\*(\w+)\)|(\w+)(?:\[\w+\])?;")


def declarations(text):
    """Without comments and line breaks within."""
    text = re.sub(r"^#.*?[^\\]$", "", _COMMENT.sub("", text), flags=re.MULTILINE)
    return re.sub(r"\n[ \t]+", " ", text)


def functions(text):
    """[(result, name, parameters)], in the order of the header."""
    found = _FUNCTION.findall(declarations(text))
    return [(result.strip(), name, " ".join(parameters.split())) for result, name, parameters in found]


def table(all_functions):
    """The text of api.h."""
    members = "\n".join(f"  {result} (*{name.removeprefix('skein_')})({parameters});" for result, name, parameters in all_functions)
    return f"""/* The functions of skein.h as a table, for programs that load the library at run time: one symbol to look up. */
#ifndef SKEIN_C_API_H
#define SKEIN_C_API_H

#include "skein/c/skein.h"

#ifdef __cplusplus
extern "C" {{
#endif

/* Later versions only add functions, at the end. */
#define SKEIN_API_VERSION 1

/* Each does what the function of skein.h does that has its name behind `skein_`. */
typedef struct skein_api {{
  uint32_t version;
{members}
}} skein_api;

/* The table, with all that the version has; NULL if the library does not have that version. It is valid until the process ends. */
const skein_api* skein_api_of(uint32_t version);

#ifdef __cplusplus
}}
#endif

#endif
"""


def constants(text):
    return [name for body in _ENUM.findall(declarations(text)) for name in re.findall(r"\b(SKEIN_\w+)\b", body)]


def structs(text):
    """{name: [field]}"""
    return {
        name: [pointer or plain for pointer, plain in _FIELD.findall(re.sub(r"\)\([^;]*\);", ");", body))] for name, body in _STRUCT.findall(declarations(text))
    }


def probe(text):
    """A C program that prints numbers and layouts, and compares the table with the functions."""
    lines = ["#include <stdio.h>", '#include "skein/c/api.h"', "int main(void) {", "  const skein_api* api = skein_api_of(SKEIN_API_VERSION);"]
    for name in constants(text):
        lines.append(f'  printf("{name} = %d\\n", (int){name});')
    for original, name in _NUMBER.findall(declarations(text)):
        lines.append(f'  printf("{name}: {original}, %zu bytes\\n", sizeof({name}));')
    for name, fields in structs(text).items():
        lines.append(f'  printf("struct {name}: %zu bytes\\n", sizeof({name}));')
        lines += [f'  printf("  {field} at %zu, %zu\\n", offsetof({name}, {field}), sizeof ((({name}*)0)->{field}));' for field in fields]
    lines += ['  printf("struct skein_api\\n");', "  if (!api || skein_api_of(0) || skein_api_of(SKEIN_API_VERSION + 1)) return 2;"]
    for _, name, _ in functions(text):
        member = name.removeprefix("skein_")
        lines.append(f'  if (api->{member} != {name}) return fprintf(stderr, "the table has another {name}\\n"), 1;')
        lines.append(f'  printf("  {member} at %zu\\n", offsetof(skein_api, {member}));')
    return "\n".join([*lines, "  return 0;", "}", ""])


def snapshot(text, root, compiler, library):
    with tempfile.TemporaryDirectory() as folder:
        source, program = os.path.join(folder, "probe.c"), os.path.join(folder, "probe")
        with open(source, "w", encoding="utf-8") as stream:
            stream.write(probe(text))
        flags = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{root}/include"]
        paths = [library, f"-Wl,-rpath,{os.path.dirname(library)}", f"-Wl,-rpath-link,{os.path.dirname(library)}"]
        subprocess.run([compiler, *flags, source, *paths, "-o", program], check=True)
        layouts = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    signatures = "".join(f"{result} {name}({parameters})\n" for result, name, parameters in functions(text))
    return signatures + layouts


def exported(library):
    """The names of the library that begin as the interface's do."""
    told = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    return {name.split("@")[0] for name in re.findall(r" T (skein_\w+(?:@+\S+)?)$", told, re.MULTILINE)}


def statements(text):
    """However their lines are broken."""
    joined = re.sub(r"\s*\n +", " ", _COMMENT.sub("", text))
    return [re.sub(r"\( ", "(", " ".join(line.split())) for part in joined.split(";") for line in part.splitlines() if line.strip()]


def differences(path, expected):
    """Says in what a file differs, however its lines are broken."""
    with open(path, encoding="utf-8") as stream:
        found = statements(stream.read())
    expected = statements(expected)
    lines = sorted(set(expected) ^ set(found)) or (["the order"] if expected != found else [])
    for line in lines:
        print(f"{path}: differs in: {line}; `{' '.join(sys.argv)} --write` makes it anew, if no release has it")
    return len(lines)


def kept(path, text):
    """How many differences a file has from its text, which --write gives it."""
    if "--write" in sys.argv:
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)
    return differences(path, text)


def main():
    root, compiler, library = sys.argv[1:4]
    with open(f"{root}/include/skein/c/skein.h", encoding="utf-8") as stream:
        text = stream.read()
    if kept(f"{root}/include/skein/c/api.h", table(functions(text))):
        return 1
    failed = kept(f"{root}/test/languages/c/abi.txt", snapshot(text, root, compiler, library))
    names = {name for _, name, _ in functions(text)} | {"skein_api_of"}
    for name in exported(library) ^ names:
        failed += 1
        print(f"{name}: is {'not declared' if name not in names else 'not exported'}")
    print(f"{len(names)} functions, {len(structs(text))} structs, {failed} differences")
    return 1 if failed else 0


sys.exit(main())
