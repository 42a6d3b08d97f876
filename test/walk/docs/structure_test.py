#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""structure_test.py: structure.py detects planted errors, and nothing in a tree without them."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import structure  # noqa: E402

FINE = {
    structure.BUDGET: "# room\t...\nlib/src/\t40\t20\t9\t2000\n.\t200\t-\t-\t-\n",
    "lib/include/exhand/a.h": "int exh_a(int x);\n",
    "lib/include/exhand/b.h": "int exh_b(int x);\n",
    "lib/src/num/a.c": '#include "exhand/a.h"\n\nint exh_a(int x)\n{\n    return x;\n}\n',
    "lib/src/law/b.c": '#include "exhand/a.h"\n#include "exhand/b.h"\n\n'
                       "int exh_b(int x)\n{\n    return exh_a(x);\n}\n",
    "lib/include/exhand/run/scene.h": "struct exh_scene;\n",
    "examples/drop/drop.h": "struct drop;\n",
    "ports/posix/board.h": "int board(void);\n",
    "ports/posix/base/option.h": "int option(void);\n",
    "ports/posix/exhand/live/live.h":
        '#include "base/option.h"\n#include "board.h"\n',
    "ports/posix/box/idle.h": "#include \"drop/drop.h\"\n",
    "ports/posix/exhand/drop/fall.h": '#include "base/option.h"\n',
    "ports/mine/board.c": '#include "exhand/run/scene.h"\n',
}


class Structure(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)
        for path, text in FINE.items():
            self.put(path, text)

    def put(self, path, text):
        full = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, "w", encoding="utf-8") as f:
            f.write(text)

    def faults(self, build=False):
        if build:
            for path in structure.tree(self.root):
                if path.endswith(".c"):
                    out = os.path.join(self.root, "build/posix", path[:-2] + ".o")
                    os.makedirs(os.path.dirname(out), exist_ok=True)
                    subprocess.run(["cc", "-I", self.root + "/lib/include", "-c",
                                    os.path.join(self.root, path), "-o", out], check=True)
        return structure.check(self.root, os.path.join(self.root, "build") if build else None)[0]

    def told(self, *words, build=False):
        faults = self.faults(build)
        self.assertEqual(len(faults), 1, faults)
        for word in words:
            self.assertIn(word, faults[0])

    def test_a_tree_without_errors(self):
        self.assertEqual(self.faults(), [])

    def test_circle_of_headers(self):
        self.put("lib/include/exhand/a.h", '#include "exhand/b.h"\n')
        self.put("lib/include/exhand/b.h", '#include "exhand/a.h"\n')
        self.told("circle: lib/a -> lib/b -> lib/a")

    def put_call(self, name, to):
        """Source `name` of the library with one function, which calls that of source `to`."""
        self.put("lib/src/law/%s.c" % name,
                 "int exh_%s(int x);\nint exh_%s(int x);\n\nint exh_%s(int x)\n{\n"
                 "    return exh_%s(x);\n}\n" % (name, to, name, to))

    def test_circle_of_calls(self):
        shutil.rmtree(os.path.join(self.root, "ports/mine"))
        self.put_call("c", "b")
        self.assertEqual(self.faults(build=True), [])
        self.put_call("b", "c")
        self.told("circle: lib/b -> lib/c -> lib/b", build=True)

    def test_an_object_older_than_its_source_is_not_read(self):
        shutil.rmtree(os.path.join(self.root, "ports/mine"))
        self.put_call("b", "c")
        self.put_call("c", "b")
        self.told("circle", build=True)
        os.utime(os.path.join(self.root, "build/posix/lib/src/law/c.o"), (1, 1))
        self.assertEqual(structure.check(self.root, os.path.join(self.root, "build"))[0], [])

    def test_circle_of_folders(self):
        self.put("lib/src/num/a.c", '#include "../law/b_part.h"\n')
        self.put("lib/src/law/b_part.h", "int b_part(void);\n")
        self.put("lib/src/num/a_part.h", "int a_part(void);\n")
        self.put("lib/src/law/b.c", '#include "../num/a_part.h"\n')
        self.told("circle of folders: lib/src/law -> lib/src/num -> lib/src/law")

    def test_a_circle_that_is_allowed(self):
        self.put("lib/include/exhand/a.h", '#include "exhand/b.h"\n')
        self.put("lib/include/exhand/b.h", '#include "exhand/a.h"\n')
        structure.CIRCLES[("lib/a", "lib/b")] = "planted"
        self.addCleanup(structure.CIRCLES.clear)
        self.assertEqual(self.faults(), [])

    def test_examples_include_ports_never(self):
        self.put("examples/drop/drop.h", '#include "posix/board.h"\n')
        self.told("arrow: examples/drop/drop.h includes ports/posix/board.h")

    def test_ports_include_the_descriptor_alone(self):
        self.put("ports/mine/board.c", '#include "exhand/run/scene.h"\n#include "drop/drop.h"\n')
        self.told("arrow: ports/mine/board.c includes examples/drop/drop.h")

    def test_the_library_includes_itself_only(self):
        self.put("lib/src/num/a.c", '#include "drop/drop.h"\n')
        self.told("arrow: lib/src/num/a.c includes examples/drop/drop.h")

    def test_a_room_includes_base_and_simulator(self):
        self.put("ports/posix/exhand/drop/fall.h", '#include "live/live.h"\n')
        self.told("arrow: ports/posix/exhand/drop/fall.h includes ports/posix/exhand/live/live.h")

    def test_a_room_grows(self):
        for name in "cdefgh":
            self.put("lib/src/law/%s.c" % name, "/* */\n" * 6)
        self.told("budget: lib/src/: 49 lines, limit 40")

    def test_a_file_grows(self):
        self.put("lib/src/law/b.c", "/* */\n" * 21)
        self.told("budget: lib/src/: 21 lines in one file, limit 20: lib/src/law/b.c")

    def test_a_function_grows(self):
        self.put("lib/src/law/b.c", "int exh_b(int x)\n{\n" + "    x++;\n" * 8 + "}\n")
        self.told("budget: lib/src/: 11 lines in one function, limit 9: exh_b() of lib/src/law")

    def test_bytes_grow(self):
        self.put("lib/src/law/b.c", "/* %s */\n" % ("x" * 2000))
        self.told("budget: lib/src/:", "bytes, limit 2000")

    def test_a_room_that_is_gone(self):
        shutil.rmtree(os.path.join(self.root, "lib/src"))
        self.told("budget: lib/src/: no such room")


class Tree(unittest.TestCase):
    """The same in a copy of this tree: whatever it has, a planted error is one more."""

    def test_planted(self):
        root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, root)
        for path in structure.tree(structure.ROOT):
            if path.startswith(("lib/", "ports/", "examples/")) or path == structure.BUDGET:
                os.makedirs(os.path.join(root, os.path.dirname(path)), exist_ok=True)
                shutil.copy(os.path.join(structure.ROOT, path), os.path.join(root, path))
        before = set(structure.check(root, None)[0])
        with open(os.path.join(root, "lib/include/exhand/units.h"), "a", encoding="utf-8") as f:
            f.write('#include "exhand/drive.h"\n')
        with open(os.path.join(root, "ports/pc104/long.c"), "w", encoding="utf-8") as f:
            f.write("void f(void)\n{\n" + "    ;\n" * 9000 + "}\n")
        with open(os.path.join(root, "examples/minimal/minimal.c"), "a", encoding="utf-8") as f:
            f.write('#include "pc104/pc104.h"\n')
        new = "\n".join(set(structure.check(root, None)[0]) - before)
        for told in ("lib/drive", "ports/pc104/: 9003 lines in one file",
                     "f() of ports/pc104/long.c", "arrow: examples/minimal/minimal.c"):
            self.assertIn(told, new)


class Functions(unittest.TestCase):
    def found(self, text, *names):
        self.assertEqual(structure.functions(text), list(names))

    def test_lengths(self):
        self.found("static int f(int (*g)(void),\n             int x)\n{\n"
                   "    if (x) { return g(); }\n    return 0;\n}\n", ("f", 6))

    def test_what_is_no_function(self):
        self.found("struct s {\n int a;\n};\nstatic const struct s t[] = {\n  {F(1)},\n};\n"
                   "enum { A = B(1) };\n")

    def test_braces_in_comments_texts_and_macros(self):
        self.found("#define X(a) \\\n    do { \\\n    } while (0)\n/* } */\nint f(void)\n{ // {\n"
                   "    return '{' + \"}\"[0];\n}\n", ("f", 4))

    def test_attributes(self):
        self.found("__attribute__((noinline)) int f(void);\nint f(void)\n{\n}\n\n"
                   "int g(void)\n{\n}\n", ("f", 3), ("g", 3))


class Wide(unittest.TestCase):
    def test_a_line_of_101_columns_is_named(self):
        with tempfile.TemporaryDirectory() as d:
            path = os.path.join(d, "planted.py")
            with open(path, "w", encoding="utf-8") as f:
                f.write("#%s\n#%s\n#%s\n" % (99 * "\u2026", 100 * "x", 99 * "x"))
            p = subprocess.run([os.path.join(os.path.dirname(os.path.abspath(__file__)), "wide.sh"),
                                path], stdout=subprocess.PIPE, universal_newlines=True)
        self.assertEqual((p.returncode, p.stdout), (1, "%s:2:#%s\n" % (path, 100 * "x")))


if __name__ == "__main__":
    unittest.main()
