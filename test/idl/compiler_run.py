"""The IDL compiler's command, run in this process: its modules are loaded once for all files."""

import contextlib
import io
import runpy
import sys
from unittest import mock


def run_compiler(root, *arguments):
    """The exit code, and what it wrote to its standard error."""
    said = io.StringIO()
    with mock.patch.object(sys, "argv", ["skein-idl", *arguments]), contextlib.redirect_stderr(said):
        try:
            runpy.run_path(f"{root}/idl/compiler", run_name="__main__")
        except SystemExit as end:
            return int(end.code or 0), said.getvalue()
    raise AssertionError("the compiler's command ended without an exit code")
