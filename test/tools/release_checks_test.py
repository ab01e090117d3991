"""What stops a release, in repositories made for it."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

CHECKS = pathlib.Path(__file__).with_name("release_checks.py")
GIT = ["git", "-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false", "-c", "tag.gpgsign=false"]


def files(version="0.1.0", heading=None, wire=1, abi=1, symbols=("f()", "g()"), members=("string service;", "string entity;"), soversion=0):
    """A tree that may be released as `version`."""
    libraries = "".join(
        f'{name}.so.{soversion} libskein{soversion} #MINVER#, skein-abi-{abi}\n'
        + "".join(f' (c++)"skein::{symbol}@{name}.so.{soversion}" 0.1.0~\n' for symbol in symbols)
        + f" (symver|optional){name}.so.{soversion} {version}~\n"
        for name in ("libskein", "libskein_c")
    )
    described = "".join(f"    {member}  ///< {{of {member}}}\n" for member in members).replace("{", "").replace("}", "")
    return {
        "CMakeLists.txt": f"cmake_minimum_required(VERSION 3.25)\nproject(skein VERSION {version} LANGUAGES CXX)\n",
        "CHANGELOG.md": f"# Changelog\n\n## {heading or f'{version} (2026-12-01)'}\n### Added\n- All of it.\n\n"
                        f"*Wire*: {wire}; *ABI*: {abi}; *SOVERSION*: {soversion}\n\n## 0.0.1 (unreleased)\n",
        "debian/changelog": f"skein ({version}) bookworm; urgency=medium\n\n  * News.\n",
        "debian/libskein0.symbols": libraries,
        "include/skein/detail/abi.hpp": f"#pragma once\n#define SKEIN_ABI {abi}\n",
        "brokerless_discovery/table.hpp": f'inline constexpr std::string_view kWire = "{wire}";\n',
        "idl/skein/discovery.idl": f"  struct ServiceDescription {{\n{described}  }};\n",
        "README.md": f"Version {version}: young.\n",
        "SHIPPING.md": f"podman run localhost/skein:{version} launch\n",
    }  # fmt: skip


class Release(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        self.git("init", "--quiet", "--initial-branch=main")
        self.commit(files())

    def git(self, *words):
        subprocess.run([*GIT, *words], cwd=self.root, check=True, stdout=subprocess.DEVNULL)

    def write(self, tree):
        for path, text in tree.items():
            (self.root / path).parent.mkdir(parents=True, exist_ok=True)
            (self.root / path).write_text(text)

    def commit(self, tree):
        self.write(tree)
        self.git("add", ".")
        self.git("commit", "--quiet", "--allow-empty", "--message", "Change")

    def release(self, tree, version):
        """`tree` was released, with that tag."""
        self.commit(tree)
        self.git("tag", f"v{version}")

    def run_checks(self, *version):
        done = subprocess.run([sys.executable, "-B", CHECKS, self.root, *version], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        return done.returncode, done.stdout

    def assertPasses(self, *told, version=()):
        code, output = self.run_checks(*version)
        self.assertEqual(code, 0, output)
        self.assertEqual(output.count("ok: "), 7, output)
        for text in told:
            self.assertIn(text, output)

    def assertStops(self, cause, remedy="", version=()):
        code, output = self.run_checks(*version)
        self.assertEqual(code, 1, output)
        failed = output.partition("failed: ")[2]
        self.assertIn(cause, failed.partition("\nremedy: ")[0])
        self.assertIn(remedy, failed.partition("\nremedy: ")[2])

    def test_the_first_release_passes_and_is_called_so(self):
        self.assertPasses("the first release", "nothing was promised before")
        self.assertPasses(version=["0.1.0"])

    def test_changed_and_unknown_files_stop_it(self):
        self.write({"README.md": "Version 0.1.0: old.\n"})
        self.assertStops("README.md", "commit")
        self.git("checkout", "--quiet", "README.md")
        self.write({"new": ""})
        self.assertStops("?? new")

    def test_a_commit_that_is_not_mains_tip_stops_it(self):
        self.git("checkout", "--quiet", "-b", "other")
        self.commit({"new": ""})
        self.assertStops("refs/heads/main is", "tip of main")

    def test_the_origins_main_counts_where_there_is_one(self):
        copy = self.root / "copy"
        subprocess.run(["git", "clone", "--quiet", self.root, copy], check=True)
        self.root = copy
        self.assertPasses()
        self.commit({"new": ""})
        self.assertStops("refs/remotes/origin/HEAD is")

    def test_a_clone_without_main_stops_it(self):
        self.git("branch", "--quiet", "--move", "trunk")
        self.assertStops("neither origin/HEAD nor a branch main")

    def test_each_place_that_names_another_version_stops_it(self):
        for path in ("CMakeLists.txt", "CHANGELOG.md", "debian/changelog", "README.md", "SHIPPING.md"):
            with self.subTest(path):
                self.commit({**files(), path: files("0.1.1")[path]})
                self.assertStops(f"{path}", "make both the same", ["0.1.0"])

    def test_another_version_than_the_trees_is_not_released(self):
        self.assertStops("0.2.0 is to be released, and CMakeLists.txt is of 0.1.0", version=["0.2.0"])
        for wrong in ("v0.1.0", "0.1", "0.1.0-rc1"):
            self.assertStops(f"'{wrong}' is no version", version=[wrong])

    def test_a_changelog_without_any_entry_stops_it(self):
        self.commit({"CHANGELOG.md": "# Changelog\n"})
        self.assertStops("CHANGELOG.md is of nothing")

    def test_an_entry_without_a_day_stops_it(self):
        for heading in ("0.1.0", "0.1.0 (unreleased)", "0.1.0, Unreleased", "0.1.0 (2026-13-01)"):
            with self.subTest(heading):
                self.commit(files(heading=heading))
                self.assertStops("and no day", "## 0.1.0 (YYYY-MM-DD)")

    def test_an_unfinished_entry_stops_it(self):
        for old, new, cause in (("All of it", "TODO: more", "says 'TODO'"), ("All of it", "Unreleased things", "says 'Unreleased'"), ("- All of it.\n", "", "does not say what"),
                                ("*Wire*: 1", "*Wire*: 2", "says 2 of 0.1.0's Wire, which is 1"), ("*ABI*: 1", "", "says nothing of 0.1.0's ABI, which is 1"),
                                ("*SOVERSION*: 0", "*SOVERSION*: 1", "says 1 of 0.1.0's SOVERSION")):  # fmt: skip
            with self.subTest(cause):
                self.commit({**files(), "CHANGELOG.md": files()["CHANGELOG.md"].replace(old, new)})
                self.assertStops(cause)

    def test_debians_unreleased_stops_it(self):
        self.commit({"debian/changelog": files()["debian/changelog"].replace("bookworm", "UNRELEASED")})
        self.assertStops("debian/changelog says UNRELEASED")

    def test_symbols_of_another_number_stop_it(self):
        self.commit({"debian/libskein0.symbols": files(abi=2)["debian/libskein0.symbols"]})
        self.assertStops("SKEIN_ABI is 1, and debian/libskein0.symbols is of 2", "list-symbols")
        self.commit(files("1.0.0"))
        self.assertStops("the libraries' SOVERSION is 1, and debian/libskein0.symbols is of 0", "libskein1")

    def test_a_released_or_older_version_stops_it(self):
        self.release(files(), "0.1.0")
        self.assertStops("0.1.0 was released")
        self.git("tag", "v0.10.0")
        self.commit(files("0.9.0"))
        self.assertStops("0.9.0 is not newer than 0.10.0")
        self.commit(files("0.11.0"))
        self.assertPasses("newer than 0.10.0")

    def test_what_is_no_release_does_not_count(self):
        for tag in ("v0.2.0-rc1", "0.3.0", "last"):
            self.git("tag", tag)
        self.assertPasses("the first release")

    def test_a_release_that_breaks_nothing_may_be_of_the_same_series(self):
        self.release(files(), "0.1.0")
        self.commit(files("0.1.1", symbols=("f()", "g()", "h()"), members=("string service;", "string  entity;", "string more;")))
        self.assertPasses("what 0.1.0 promised is kept")

    def test_a_symbol_that_went_needs_another_abi(self):
        self.release(files(), "0.1.0")
        self.commit(files("0.2.0", symbols=("g()",)))
        self.assertStops('2 symbols of 0.1.0 are gone, and SKEIN_ABI is still 1; the first: (c++)"skein::f()@libskein', "count SKEIN_ABI up")
        self.commit(files("0.2.0", symbols=("g()",), abi=2))
        self.assertPasses("SKEIN_ABI grew since 0.1.0, as 0.2.0 may")

    def test_another_abi_or_wire_needs_another_series(self):
        for number in ("abi", "wire"):
            with self.subTest(number):
                self.commit(files())
                self.git("tag", "--force", "v0.1.0")
                self.commit(files("0.1.1", **{number: 2}))
                self.assertStops("grew since 0.1.0", "give the release the version 0.2.0")
                self.commit(files("0.2.0", **{number: 2}))
                self.assertPasses("grew since 0.1.0, as 0.2.0 may")

    def test_from_1_0_on_only_the_first_number_breaks(self):
        self.release(files("1.2.0", soversion=1), "1.2.0")
        self.commit(files("1.3.0", soversion=1, abi=2))
        self.assertStops("SKEIN_ABI grew since 1.2.0", "give the release the version 2.0.0")
        self.commit(files("2.0.0", soversion=2, abi=2))
        self.assertPasses("SKEIN_ABI grew since 1.2.0, as 2.0.0 may")

    def test_numbers_do_not_fall(self):
        self.release(files(abi=2, wire=2), "0.1.0")
        self.commit(files("0.2.0", abi=1, wire=2))
        self.assertStops("SKEIN_ABI is 1, and was 2 in 0.1.0")
        self.commit(files("0.2.0", abi=2, wire=1))
        self.assertStops("the wire's number is 1, and was 2 in 0.1.0")

    def test_the_description_of_services_only_grows_at_its_end(self):
        self.release(files(), "0.1.0")
        for members in (("string entity;", "string service;"), ("string service;",), ("wstring service;", "string entity;")):
            with self.subTest(members):
                self.commit(files("0.2.0", wire=2, members=members))
                self.assertStops("are not its first ones", "append to it alone")


if __name__ == "__main__":
    unittest.main()
