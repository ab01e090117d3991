"""Puts the templates for C together: `x.idl.h` and `x.idl.c`."""

import os
import re

import model

from . import c_interface, c_types, description


def _base(file):
    return re.sub(r"\W", "_", os.path.basename(file.path).removesuffix(".idl"))


def _types(file):
    return f"bool {_base(file)}_types(skein_interface* out, skein_error error)"


def header(file):
    name = os.path.basename(file.path)
    guard = re.sub(r"\W", "_", file.header.removesuffix(".hpp")).upper() + "_H"
    lines = [f"/* Generated from {name} by the IDL compiler of Skein. Do not edit. */", f"#ifndef {guard}", f"#define {guard}", "",
             '#include "skein/c/skein.h"', *(f'#include "{include}.h"' for include in file.includes), "",
             "#ifdef __cplusplus", 'extern "C" {', "#endif", ""]  # fmt: skip
    lines += [line for item in file.items for line in c_types.announced(item)] + [""]
    for item in file.items:
        lines += c_interface.definition(item) if isinstance(item, model.Interface) else c_types.definition(item)
        if isinstance(item, model.Exception_):
            lines += [line for said, declaration, _ in c_interface.exception_functions(item) for line in (*c_types.documentation(said), declaration + ";")]
    lines += ["/* The types of this file and of those that it includes, for topics: give their names as `NAME_TYPE`. */", _types(file) + ";", ""]
    return [*lines, "#ifdef __cplusplus", "}", "#endif", "", "#endif"]


def source(file):
    name = os.path.basename(file.path)
    lines = [f"/* Generated from {name} by the IDL compiler of Skein. Do not edit. */", f'#include "{file.header.removesuffix(".hpp")}.h"', "",
             "#include <stdlib.h>", "#include <string.h>", ""]  # fmt: skip
    for item in file.items:
        if isinstance(item, model.Interface):
            lines += c_interface.source(item)
        if isinstance(item, model.Exception_):
            lines += [line for _, declaration, body in c_interface.exception_functions(item) for line in (declaration + " {", *body, "}", "")]
    lines += c_interface.c_types_bytes("types_description", description.interface_description(None, c_types.types_of(file.items)))
    return [*lines, "", _types(file) + " {", "  return skein_interface_new(types_description, sizeof types_description, out, error);", "}"]
