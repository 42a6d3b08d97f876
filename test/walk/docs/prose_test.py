#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""prose_test.py EXHAND WORLD: prose.py reports each planted fault at its line, and nothing of a
page without faults."""

import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import docs  # noqa: E402
import prose  # noqa: E402

PROGRAM, WORLD = [os.path.abspath(p) for p in sys.argv[1:3]]
DATA = "idiom\thangs? on\tdepends on\npage\tdocs/HERE.md\t1000\t0\n"
LONG = "It has " + "many " * 28 + "words."
FINE = """# A page

A short sentence. Another one, with [a link](DESIGN.md), `make test` and `exhand drop --rate 90`.
It is 0.5 mm long, e.g. for the paper. """ + LONG.replace("many ", "", 1) + """

| a table | """ + "word " * 40 + "| " + "word " * 40 + """|

* An item of a list.
  It goes on here, and hangs
  over a line.

    """ + "code " * 60 + """

<!-- exhand faults -->
""" + LONG + """ It hangs on a command.
<!-- end -->
"""


class Prose(unittest.TestCase):
    def faults(self, text, data=DATA):
        return prose.Page("docs/HERE.md", text, prose.Data(data)).faults(PROGRAM, WORLD)

    def one(self, text, line, *words):
        """The only fault of FINE and this text behind it, line of the text."""
        found = self.faults(FINE + "\n" + text)
        self.assertEqual([n for n, _ in found], [FINE.count("\n") + 1 + line], found)
        for word in words:
            self.assertIn(word, found[0][1])

    def test_a_page_without_faults(self):
        self.assertEqual(self.faults(FINE), [])

    def test_a_long_sentence(self):
        self.one("Short one.\n" + LONG + "\n", 2, "31 words")

    def test_a_long_sentence_over_lines(self):
        self.one("Short one. " + LONG.replace("many ", "many\n", 9) + " Short.\n", 1, "31 words")

    def test_a_long_sentence_in_an_item(self):
        self.one("* " + LONG + "\n* Short.\n", 1, "31 words")

    def test_a_long_paragraph(self):
        self.one("It has five words here.\n" * 18 + "One more.\n", 1, "paragraph of 92")

    def test_a_long_sentence_in_a_table(self):
        self.one("| short | " + "many " * 41 + "|\n", 1, "41 words in a table")

    def test_an_idiom(self):
        self.one("First.\nIt hangs on a word.\n", 2, "hangs on", "depends on")

    def test_an_idiom_in_a_table_and_a_heading(self):
        self.one("| it | hangs on |\n", 1, "hangs on")
        self.one("## It hangs on\n", 1, "hangs on")

    def test_an_idiom_that_is_allowed(self):
        pages = "docs/HERE.md", "README.md"
        here, there = (DATA + f"allow\t{page}\thangs on\n" for page in pages)
        self.assertEqual(self.faults("It hangs on.\n", here), [])
        self.assertEqual(len(self.faults("It hangs on.\n", there)), 1)

    def test_a_link(self):
        self.one("Short.\n\n[page](no-page.md)\n", 3, "no link to no-page.md")
        self.one("[heading](STYLE.md#no-such-heading)\n", 1, "no such heading")
        self.assertEqual(
            self.faults("[here](#a-head)\n[there](STYLE.md#words-to-avoid)\n\n# A head\n"), [])

    def test_a_quotation(self):
        self.one('| what | [page](STYLE.md#style) | "Put two facts in a sentence." |\n', 1,
                 "does not say")
        self.assertEqual(
            self.faults('| what | [page](STYLE.md#style) | "Put one fact in a sentence." |\n'), [])

    def test_a_target(self):
        self.one("Short.\nType `make no-target` now.\n", 2, "no target")

    def test_an_option_and_a_command(self):
        self.one("Short.\n`exhand drop --no-option`\n", 2, "--no-option")
        self.one("    $ exhand no-command\n", 1, "no-command")

    def test_a_budget(self):
        found = self.faults(FINE, DATA.replace("1000", "20"))
        self.assertEqual([n for n, _ in found], [1])
        self.assertIn("20 at most", found[0][1])
        self.assertEqual(len(self.faults(FINE, "")), 1) # a page that prose.tsv does not list

    def test_comments_of_a_source(self):
        long = LONG.replace("many ", "many\n * ", 9)
        found = prose.Page("a.c", """/* SPDX-License-Identifier: MIT */
/* Short. a name in small letters begins this one, eq. 2 is in it, i.e. it is one sentence.
 *
 * """ + long + """ */
int hangs_on; /* it hangs on a word */
const char *s = "hangs on /* hangs on"; // hangs on
/*@ requires a specification that hangs on nothing */
""", prose.Data(DATA))
        self.assertEqual(found.lengths, [1, 18, 31, 5, 2])
        self.assertEqual([n for n, _ in found.style()], [4, 14, 15])

    def test_comments_of_python(self):
        found = prose.Page("a.py", """#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
\"\"\"Doc.

It hangs on.
""" + LONG + """
\"\"\"
import a  # noqa: E402
s = "# hangs on"  # hangs on a word
# It hangs
# on a line. """ + LONG.replace("many ", "many\n# ", 9) + "\n\n# Short.\n", prose.Data(DATA))
        self.assertEqual(found.lengths, [1, 3, 31, 4, 5, 31, 1])
        self.assertEqual(sorted(n for n, _ in found.style()), [5, 6, 9, 11])

    def test_comments_of_a_shell_script_and_a_makefile(self):
        text = """#!/bin/sh
# SPDX-License-Identifier: MIT
a=${a#b} # hangs on
echo "# hangs on" '# hangs on'
# """ + LONG + """
#
# hangs on
"""
        for name in "a.sh", "a.mk", "Makefile":
            found = prose.Page(name, text, prose.Data(DATA))
            self.assertEqual([n for n, _ in found.style()], [3, 5, 7])

    def test_lines_for_a_tool(self):
        text = "/* Short.\n *\n * PLANT: a.c: hangs on -> " + LONG + "\n */\n"
        self.assertEqual(list(prose.Page("a.c", text, prose.Data(DATA)).style()), [])

    def test_a_ceiling_only_falls(self):
        rows = "page\ta.md\t9\t5\npage\tb.md\t9\t5\npage\tc.md\t9\t5\n"
        self.assertEqual(prose.update("# x\n" + rows, {"a.md": (1, 3), "b.md": (12, 8)}, {}),
                         "# x\npage\ta.md\t9\t3\npage\tb.md\t9\t5\n")

    def test_a_ceiling_of_comments_only_falls(self):
        rows = "comments\ta\t5\ncomments\ta/b\t5\ncomments\tgone\t5\n"
        self.assertEqual(prose.update(rows, {}, {"a": 3, "a/b": 8}),
                         "comments\ta\t3\ncomments\ta/b\t5\ncomments\tgone\t0\n")

    def test_comments_by_folder(self):
        with tempfile.TemporaryDirectory() as top:
            paths = [os.path.join(top, *p) for p in (("a.c",), ("b", "a.c"), ("bc", "a.c"))]
            for p in paths:
                os.makedirs(os.path.dirname(p), exist_ok=True)
                with open(p, "w", encoding="utf-8") as f:
                    f.write("/* It hangs on a word. */\n")
            data = prose.Data(DATA + "comments\t%s\t1\ncomments\t%s/b\t0\n" % (top, top))
            found = prose.judged(data, paths)
        self.assertEqual({room: len(faults) for room, faults in found.items()},
                         {top: 2, top + "/b": 1})
        self.assertTrue(found[top + "/b"][0].startswith(paths[1] + ":1: "))

    def test_the_tree_has_comments_of_each_language(self):
        found = prose.sources()
        self.assertEqual({name for p in found for name in (os.path.basename(p),
                          os.path.splitext(p)[1]) if name in prose.SOURCES}, set(prose.SOURCES))
        self.assertIn("test/walk/docs/prose.py", found)

    def test_a_new_page_gets_a_row(self):
        self.assertEqual(prose.update("# x\n", {"d.md": (51, 3)}, {}), "# x\npage\td.md\t100\t2\n")


if __name__ == "__main__":
    os.chdir(docs.ROOT)
    unittest.main(argv=sys.argv[:1])
