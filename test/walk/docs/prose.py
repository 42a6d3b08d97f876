#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""prose.py [--stats | --update | --comments FILE...] EXHAND WORLD: the documents keep the rules of
docs/STYLE.md.

Prints each fault as PAGE:LINE. A fault is a sentence or paragraph that is too long, an idiom of
prose.tsv, a link that leads nowhere, or too many words. It is also a command or name that the tree
does not have (by docs.py). A page may have as many faults as prose.tsv allows it, and none where it
allows none. Code and what a command generates (between <!-- COMMAND --> and <!-- end -->) is not
judged. A cell of a table is a paragraph of up to 40 words a sentence.

The comments of sources (C, Python, shell, make and their like) are judged by their sentences and
idioms. prose.tsv has a ceiling for the faults of a folder. A folder without a row may have none.

--stats prints words and sentences of each page, and of the comments of each folder of sources;
--update lowers ceilings to today's number and gives new pages a row. --comments FILE... prints the
faults in the comments of these sources, and passes.
Exit status: 0 all pages and comments keep the rules, 1 not. Standard library only.
"""

import ast
import functools
import glob
import inspect
import io
import os
import re
import sys
import tokenize

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import docs  # noqa: E402

DATA = "test/walk/docs/prose.tsv"
SENTENCE, CELL, PARAGRAPH = 30, 40, 90 # words; 90 are five lines of 100 columns
END = re.compile(r"[.!?][)\"”]?\s+(?=[A-Z\"“(])|$")
# In a comment, a sentence may begin with a name in small letters.
COMMENT_END = re.compile(r"(?<!\be\.g)(?<!\bi\.e)(?<!\beq)(?<!\bfig)[.!?][)\"”]?\s+|$")
WORD = re.compile(r"[^\W_][\w'’.,·/-]*")
COMMENT = re.compile(r'/\*(.*?)\*/|//([^\n]*)|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\'', re.S)


class Data:
    """prose.tsv: idioms, what is allowed by name, and what each page may have."""

    def __init__(self, text):
        self.idioms, self.allowed, self.pages, self.rooms = [], set(), {}, {}
        for line in text.splitlines():
            row = line.split("\t")
            if row[0] == "idiom":
                self.idioms.append((re.compile(r"\b(?:%s)\b" % row[1], re.I), row[2]))
            elif row[0] == "allow":
                self.allowed.add((row[1], row[2]))
            elif row[0] == "page":
                self.pages[row[1]] = (int(row[2]), int(row[3]))
            elif row[0] == "comments":
                self.rooms[row[1]] = int(row[2])
        self.idiom = re.compile("|".join(i.pattern for i, _ in self.idioms) or "(?!)", re.I)

    def room(self, path):
        """The longest folder of the table that the source is in, or else the tree's."""
        return max((r for r in self.rooms if path.startswith(r + "/")), key=len,
                   default=path.split("/")[0])


def blocks(text):
    """(kind, [(line number, text)]) of a page: prose, row. Not code, not generated parts."""
    block, fenced, made, listed = [], False, False, False
    for n, line in enumerate(text.split("\n"), 1):
        if line.startswith("```"):
            fenced = not fenced
        made = (made or re.match(r"<!-- (?!end)", line) is not None) and line != "<!-- end -->"
        item = re.match(r" {0,3}(?:[*+-]|\d+\.)\s", line) is not None
        listed = item or (listed and (line == "" or line.startswith(" ")))
        code = fenced or line.startswith(("```", "<")) or (
            re.match(r" {4}", line) is not None and not (listed and block))
        if made or code or not line.strip() or line.startswith(("#", "|", "!")) or item:
            if block:
                yield "prose", block
            block = []
            if made or code or not line.strip():
                continue
            if line.startswith("|"):
                yield "row", [(n, line)]
                continue
        block.append((n, line))
        if line.startswith("#"):
            yield "head", block
            block = []
    if block:
        yield "prose", block


def of_c(text):
    """(line number, text) of each comment with the marks of C. No specification of ACSL."""
    for m in COMMENT.finditer(text):
        body = m[1] or m[2] or ""
        if not body.startswith("@"):
            yield text.count("\n", 0, m.start()) + 1, re.sub(r"(?m)^\s*\*", "", body)


def of_python(text):
    """(line number, text) of each docstring of a Python source, and of each comment."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)):
            doc = ast.get_docstring(node, clean=False)
            if doc:
                yield node.body[0].lineno, inspect.cleandoc(doc)
    yield from joined((t.start[0], t.start[1], t.line[:t.start[1]].strip() != "", t.string[1:])
                      for t in tokenize.generate_tokens(io.StringIO(text).readline)
                      if t.type == tokenize.COMMENT)


def of_shell(text):
    """(line number, text) of each comment with the mark of a shell script or makefile."""
    found = []
    for n, line in enumerate(text.split("\n"), 1):
        for m in re.finditer(r"(?:^|\s)#(?=\s|!|$)", line):
            before = line[:m.start()]
            if before.count('"') % 2 == before.count("'") % 2 == 0:
                found.append((n, m.end(), before.strip() != "", line[m.end():]))
                break
    yield from joined(found)


def joined(lines):
    """(line number, text) of comments whose lines follow each other in one column.
    lines: (line number, column, whether code is before it, text)"""
    start, last, body = 0, (0, 0), []
    for n, column, code, text in lines:
        if body and (code or last != (n - 1, column)):
            yield start, "\n".join(body)
            body = []
        start, last = (start if body else n), (n, column)
        body.append(text)
    if body:
        yield start, "\n".join(body)


SOURCES = {**dict.fromkeys((".c", ".h", ".inc", ".S", ".ld", ".mjs", ".acsl"), of_c),
           **dict.fromkeys((".sh", ".mk", "Makefile", ".awk", ".gp", ".plt", ".cmake",
                            "CMakeLists.txt"), of_shell), ".py": of_python}


def language(path):
    """The function of SOURCES for this path. None: it is a page."""
    return SOURCES.get(os.path.basename(path)) or SOURCES.get(os.path.splitext(path)[1])


def comments(path, text):
    """The paragraphs of the comments of a source, as blocks() has those of a page. A line for a
    tool is none: the keys of a proof, noqa, the licence."""
    for n, body in language(path)(text):
        block = []
        for k, line in enumerate(body.split("\n")):
            tool = re.match(r"!/| ?SPDX| (?:noqa|shellcheck|pylint|fmt|NOLINT)\b|"
                            r" (?:PROVES|EVA|WITH|PLANT):", line)
            if block and (tool or re.match(r"\s*$|\s*[*+-]\s|   ", line)):
                yield "prose", block
                block = []
            if line.strip() and not tool:
                block.append((n + k, line.strip()))
        if block:
            yield "prose", block


def plain(line):
    """A line without code, targets of links and marks."""
    line = re.sub(r"`[^`]*`", "Code", line.lstrip("> "))
    line = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", line)
    return re.sub(r"https?://\S+|[*_|]+", " ", line)


def sentences(block, end=END):
    """(line number, words) of each sentence of a paragraph."""
    text, starts = "", []
    whole = "\n".join(line for _, line in block)
    whole = re.sub(r"`[^`]*`", lambda m: "Code" + "\n" * m.group().count("\n"), whole)
    for k, line in enumerate(whole.split("\n")):
        starts.append((len(text), block[k][0]))
        text += plain(line) + " "
    at = 0
    for m in list(end.finditer(text)):
        words = WORD.findall(text[at:m.end()])
        if words:
            lead = at + len(text[at:]) - len(text[at:].lstrip())
            yield [n for start, n in starts if start <= lead][-1], words
        at = m.end()


def anchors(text):
    """The anchors of a page for links, as GitHub makes them of headings."""
    heads = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^\w -]", "", h.lower()).replace(" ", "-") for h in heads}


def headings(path, text):
    """Links to headings that are not there, and words that a table quotes from a page behind its
    link and that the page does not have; docs.py has the pages."""
    for n, line in enumerate(text.split("\n"), 1):
        for to, anchor in re.findall(r"\]\(([\w./-]*)#([^)\s]+)\)", line):
            file = os.path.join(os.path.dirname(path), to)
            there = docs.read(file) if to and os.path.exists(file) else text
            if anchor not in anchors(there):
                yield n, "no such heading: %s#%s" % (to, anchor)
        for to, words in re.findall(r'\]\(([\w./-]+)[^)]*\) \| "(.+)" \|$', line):
            file = os.path.join(os.path.dirname(path), to)
            if os.path.exists(file) and words not in " ".join(docs.read(file).split()):
                yield n, "%s does not say: %s" % (to, words)


def names(path, text, program, world):
    """What docs.py does not find in the tree, at the first line that has its last word."""
    for wrong in docs.Page(path, text, program, world).all().wrong:
        what = wrong[len(path) + 2:]
        last = what.split()[-1]
        yield next((n for n, line in enumerate(text.split("\n"), 1) if last in line), 1), what


class Page:
    def __init__(self, path, text, data):
        self.path, self.text, self.data = path, text, data
        self.end = COMMENT_END if language(path) else END
        self.blocks = list(comments(path, text) if language(path) else blocks(text))

    @functools.cached_property
    def lengths(self):
        return [len(w) for kind, b in self.blocks if kind == "prose"
                for _, w in sentences(b, self.end)]

    @functools.cached_property
    def words(self):
        return sum(len(WORD.findall(plain(line))) for _, b in self.blocks for _, line in b)

    def style(self):
        for kind, block in self.blocks:
            # Most comments are too short for a long sentence: words have two characters at least
            # with the one between.
            if kind == "prose" and sum(len(line) + 1 for _, line in block) >= 2 * SENTENCE:
                found = list(sentences(block, self.end))
                for n, words in found:
                    if len(words) > SENTENCE:
                        yield n, "a sentence of %d words: %s ..." % (len(words),
                                                                     " ".join(words[:6]))
                total = sum(len(w) for _, w in found)
                if total > PARAGRAPH:
                    yield block[0][0], "a paragraph of %d words" % total
            for cell in block[0][1].replace("\\|", "").split("|") if kind == "row" else ():
                for n, words in sentences([(block[0][0], cell)]):
                    if len(words) > CELL:
                        yield n, "a sentence of %d words in a table" % len(words)
            for n, line in block:
                line = plain(line)
                for idiom, instead in self.data.idioms if self.data.idiom.search(line) else ():
                    for m in idiom.finditer(line):
                        if (self.path, m.group().lower()) not in self.data.allowed:
                            yield n, '"%s": %s' % (m.group(), instead)

    def budget(self):
        most = self.data.pages.get(self.path, (0, 0))[0]
        if self.words > most:
            yield 1, "%d words, %d at most" % (self.words, most)

    def faults(self, program, world):
        return sorted([*self.style(), *headings(self.path, self.text), *self.budget(),
                       *names(self.path, self.text, program, world)])


def sources():
    """The sources of the tree whose comments are judged."""
    return ["Makefile"] + sorted(p for top in docs.TOP for p in
                                 glob.glob(top + "/**/*.*", recursive=True) if language(p))


def judged(data, paths):
    """Folder of the table -> faults of its comments, as lines to print."""
    found = {room: [] for room in data.rooms}
    for p in paths:
        found.setdefault(data.room(p), []).extend(
            "%s:%d: %s" % (p, n, what) for n, what in Page(p, docs.read(p), data).style())
    return found


def stats(pages):
    print("%-44s %6s %9s %5s %7s %4s %6s" %
          ("page", "words", "sentences", "mean", "longest", ">30", "faults"))
    rooms = {}
    for p in pages:
        if language(p.path):
            rooms.setdefault("comments of %s/" % os.path.dirname(p.path), []).append(p)
            rooms.setdefault("comments of all %s/" % p.path.split("/")[0], []).append(p)
        else:
            rooms[p.path] = [p]
    for name, parts in rooms.items():
        lengths = [n for p in parts for n in p.lengths]
        print("%-44s %6d %9d %5.1f %7d %4d %6d" %
              (name, sum(p.words for p in parts), len(lengths),
               sum(lengths) / max(len(lengths), 1), max(lengths, default=0),
               sum(n > SENTENCE for n in lengths), sum(len(list(p.style())) for p in parts)))


def update(text, found, rooms):
    """prose.tsv with the ceiling of each page lowered to the number of its faults. A new page gets
    a row; one that is gone loses its. The ceiling of the comments of a folder is lowered, too.
    found: path to (words, faults); rooms: folder to faults."""
    rows = [line.split("\t") for line in text.splitlines()]
    old = {row[1]: (int(row[2]), int(row[3])) for row in rows if row[0] == "page"}
    rows = [row for row in rows if row[0] != "page"]
    for row in rows:
        if row[0] == "comments":
            row[2] = str(min(int(row[2]), rooms.get(row[1], 0)))
    for path, (words, faults) in sorted(found.items()):
        most, ceiling = old.get(path, (-(-words // 50) * 50, faults - 1)) # less that of no row
        rows.append(["page", path, str(most), str(min(ceiling, faults))])
    return "\n".join("\t".join(row) for row in rows) + "\n"


def main(args):
    options = [a for a in args if a.startswith("-")]
    *files, program, world = ["", ""] + [a for a in args if not a.startswith("-")]
    program, world = os.path.abspath(program), os.path.abspath(world)
    os.chdir(docs.ROOT)
    rows = docs.read(DATA)
    data = Data(rows)
    pages = [Page(p, docs.read(p), data) for p in docs.documents()]
    if "--comments" in options:
        print("\n".join("%s:%d: %s" % (p, n, what) for p in files if p
                        for n, what in Page(p, docs.read(p), data).style()))
        return 0
    if "--stats" in options:
        stats(pages + [Page(p, docs.read(p), data) for p in sources()])
        return 0
    found, bad = {}, 0
    for p in pages:
        faults = p.faults(program, world)
        found[p.path], most = (p.words, len(faults)), data.pages.get(p.path, (0, 0))[1]
        if len(faults) > most:
            bad += 1
            print("\n".join("%s:%d: %s" % (p.path, n, what) for n, what in faults))
            print("%s: %d faults, %d allowed" % (p.path, len(faults), most))
    rooms, more = judged(data, sources()), 0
    for room, faults in rooms.items():
        if len(faults) > data.rooms.get(room, 0):
            more += 1
            print("\n".join(faults))
            print("comments of %s: %d faults, %d allowed" %
                  (room, len(faults), data.rooms.get(room, 0)))
    if "--update" in options:
        with open(DATA, "w", encoding="utf-8") as f:
            f.write(update(rows, found, {room: len(faults) for room, faults in rooms.items()}))
    print("prose: %d pages, %d words, %d faults, %d allowed by ceilings: %d pages with more" %
          (len(pages), sum(p.words for p in pages), sum(n for _, n in found.values()),
           sum(most for _, most in data.pages.values()), bad))
    print("prose: comments: %d faults, %d allowed by ceilings: %d folders with more" %
          (sum(len(faults) for faults in rooms.values()), sum(data.rooms.values()), more))
    return 1 if bad or more else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
