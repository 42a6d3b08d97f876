#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""amalgamate.py OUT HEADER...: one header and one source, OUT.h and OUT.c, of these public headers
(contact.h; exhand.h is the whole library). OUT.h has them and all that they and the sources
include. OUT.c has each source that defines what a given header declares or names in a comment,
name(), and each that those need.
A name of one source's own that is used elsewhere, too, gets the source's name before it. Comments
stay. Exit status: 0 written, 2 what is wrong. Standard library only.
"""

import os
import re
import sys

LIB = os.path.dirname(os.path.abspath(__file__))
PUBLIC = os.path.join(LIB, "include", "exhand")
TOKEN = re.compile(r"/\*.*?\*/|^[ \t]*#(?:[^\n\\]|\\.)*|\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'|"
                   r"\d[\w.]*|[A-Za-z_]\w*|->|\s+|.", re.S | re.M)
WORD = re.compile(r"[A-Za-z_]\w*")
QUIET_CXX = """
/* This is C99. As C++ the compilers here take it, too, and need not say what of it is C alone. */
#if defined(__cplusplus) && defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#if defined(__clang__)
#pragma GCC diagnostic ignored "-Wc99-designator"
#pragma GCC diagnostic ignored "-Wmissing-braces"
#elif __GNUC__ >= 12
#pragma GCC diagnostic ignored "-Wc++20-extensions"
#endif
#endif
"""
SHADOW = """
/* A structure and its function may have one name: in C++ it hides a constructor. */
#if defined(__cplusplus) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#endif
"""
SHADOW_END = """
#if defined(__cplusplus) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
"""


def read(path):
    with open(path) as f:
        return f.read()


def words(text):
    """Every identifier of the code: not of comments, text, or lines that include."""
    return {w for t in TOKEN.findall(text) if not t.startswith(("/*", '"', "'"))
            and not re.match(r"\s*#\s*include", t) for w in WORD.findall(t)}


def included(path):
    """The library's files that a file includes, in order."""
    for name in re.findall(r'^#include "([^"]+)"', read(path), re.M):
        at = (os.path.join(LIB, "include", name) if name.startswith("exhand/")
              else os.path.join(os.path.dirname(path), name))
        yield os.path.normpath(at)


def below(paths, seen=None):
    """These files and what they include, each after what it includes."""
    seen = {} if seen is None else seen
    for path in paths:
        if path not in seen:
            seen[path] = False
            below(included(path), seen)
            seen[path] = seen.pop(path) or True
    return list(seen)


def items(text):
    """The declarations at file scope, each a list of tokens; the body of a function is one."""
    item, depth = [], 0
    static = set(re.findall(r"^#define (\w+) static\b", text, re.M))
    text = re.sub(r"^#ifdef __cplusplus\n.*?^#endif\n", "", text, flags=re.S | re.M)
    for t in TOKEN.findall(text):
        if t.isspace() or t.startswith("/*") or t.lstrip().startswith("#"):
            continue
        if t == "{" and depth == 0 and item[-1:] == [")"]:
            item.append("body")
        depth += (t in ("{", "(", "[")) - (t in ("}", ")", "]"))
        item.append("static" if t in static else t)
        if depth == 0 and (t == ";" or t == "}" and "body" in item):
            yield item
            item = []


def declared(item):
    """What the declarators of an item at file scope name, and whether it is a definition."""
    if item[1] == "(": # a macro that makes a function
        return [item[2]], "body" in item
    names, depth, last, skip = [], 0, "", False
    for t in item:
        if depth == 0 and not skip and t in ("(", "[", "=", ",", ";") and WORD.fullmatch(last):
            names.append(last)
            skip = True
        if depth == 0 and t == ",":
            skip = False
        depth += (t in ("{", "(", "[")) - (t in ("}", ")", "]"))
        last = t
    pointers = re.findall(r"\( \* (?:const )?(\w+)", " ".join(item))
    known = [n for n in names if n not in ("int", "void", "char", "struct")] or pointers[:1]
    return known, "body" in item or ("extern" not in item and "(" not in item[:item.index(
        "=") if "=" in item else len(item)])


def is_own(item):
    """Static, not by what the body of a function has."""
    return "static" in item[:item.index("body") if "body" in item else None]


def own(text):
    """Names that are of one source alone: static ones, macros, constants, tags."""
    names = set(re.findall(r"^#define (\w+)", text, re.M))
    for item in items(text):
        line = " ".join(item)
        if is_own(item):
            names.update(declared(item)[0])
        names.update(re.findall(r"\b(?:struct|union|enum) (\w+) \{", line))
        for body in re.findall(r"\benum (?:\w+ )?\{([^}]*)\}", line):
            names.update(re.findall(r"(?:^|,)\s*(\w+)", body))
    return names


def offers(text):
    """External functions and objects that a source defines."""
    return {n for item in items(text) if not is_own(item)
            for names, here in [declared(item)] if here for n in names if n.startswith("exh_")}


def inline(text):
    """{function in a header: the words of it}"""
    return {n: {w for w in item if WORD.fullmatch(w)} for item in items(text) if "body" in item
            for n in declared(item)[0]}


def promised(text):
    """External names that a header declares, and functions that its comments name."""
    return set(re.findall(r"\b(exh_\w+)\(\)", text)) | {
        n for item in items(text) if not is_own(item)
        for n in declared(item)[0] if n.startswith("exh_")}


def needed(headers, of):
    """The sources behind these headers, and the headers of all of them. of: {source: offers}"""
    given = headers + [i for h in headers if h.endswith(os.sep + "exhand.h") for i in included(h)]
    chosen, before, want = [], 0, set().union(*(promised(read(h)) for h in given))
    while True:
        reach = below(headers + chosen)
        for path in reach:
            called = {} if path.endswith(".c") else inline(read(path))
            want |= words(read(path)) if path.endswith(".c") else set()
            want |= set().union(*(called[n] for n in called if n in want or path in given))
        more = [s for s in sorted(of) if s not in chosen and of[s] & want]
        grown, before = len(want) > before, len(want)
        if not more and not grown:
            return sorted(chosen), [p for p in reach if p.endswith(".h")]
        chosen += more


def renamed(text, names):
    """The text with these names new; members of structures keep theirs."""
    out, last, braces = [], "", []
    tokens = TOKEN.findall(text)
    for k, t in enumerate(tokens):
        if t.lstrip().startswith("#"):
            t = WORD.sub(lambda m: names.get(m[0], m[0]), t)
        elif t in names and last not in (".", "->"):
            behind = next((n for n in tokens[k + 1:] if not n.isspace()), "")
            if not (braces and braces[-1] and behind in (";", ",", "[", ":")):
                t = names[t]
        if t == "{":
            code = "".join(x for x in out[-12:] if not x.startswith("/*"))
            braces.append(bool(re.search(r"\b(struct|union)(\s+\w+)?\s*$", code)))
        elif t == "}" and braces:
            braces.pop()
        out.append(t)
        last = t if not t.isspace() else last
    return "".join(out)


def bare(text):
    """Without its includes, its licence line and blank lines that are left."""
    text = re.sub(r'^#include .*\n', "", text, flags=re.M)
    text = text.replace("/* SPDX-License-Identifier: MIT */\n", "", 1)
    return re.sub(r"\n{3,}", "\n\n", text).strip("\n") + "\n"


def head(name, about):
    """Version and licence."""
    version = ".".join(re.findall(r"define EXH_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)",
                                  read(os.path.join(PUBLIC, "exhand.h"))))
    licence = read(os.path.join(LIB, "LICENSE")).strip().splitlines()
    return ("/* SPDX-License-Identifier: MIT */\n/* %s of exhand %s: %s\n * Made by "
            "lib/amalgamate.py: change the library, not this file.\n *\n%s\n */\n" %
            (name, version, about, "\n".join((" * " + line).rstrip() for line in licence)))


def part(path, text):
    return "\n/* ---- %s ---- */\n\n%s" % (os.path.relpath(path, LIB), text)


def system(paths):
    """The standard's headers that these include."""
    return "".join(sorted({line for p in paths for line in
                           re.findall(r"^#include <.*>\n", read(p), re.M)}))


def amalgamate(headers):
    """The text of the header and of the source, without their heads."""
    sources = [os.path.join(d, f) for d, _, files in os.walk(os.path.join(LIB, "src"))
               for f in files if f.endswith(".c") and os.path.basename(d) != "run"]
    chosen, reach = needed(headers, {s: offers(read(s)) for s in sources})
    public = [h for h in reach if h.startswith(PUBLIC + os.sep)]
    private = [h for h in reach if h not in public]
    said = {p: words(read(p)) for p in reach + chosen}
    body = "".join(part(p, bare(read(p))) for p in private)
    for path in chosen:
        text, stem = read(path), os.path.splitext(os.path.basename(path))[0]
        others = set().union(*(said[p] for p in said if p != path))
        new = {n: "%s_%s" % (stem.upper() if n.isupper() else stem, n)
               for n in own(text) & others}
        taken = set(new.values()) & (others | said[path])
        if taken:
            sys.exit("amalgamate.py: %s: %s is taken: rename one" % (path, sorted(taken)[0]))
        body += part(path, renamed(bare(text), new))
    c = '#ifdef __cplusplus\n%s\n#endif\n'
    return (system(public) + "".join(part(p, bare(read(p))) for p in public),
            system(private + chosen) + "\n" + c % 'extern "C" {' + body + "\n" + c % "}", chosen)


def main():
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    out, headers = sys.argv[1], [os.path.join(PUBLIC, h) for h in sys.argv[2:]]
    for path in headers:
        if not os.path.exists(path):
            print("amalgamate.py: %s: no such public header: give one of lib/include/exhand" %
                  os.path.basename(path), file=sys.stderr)
            return 2
    name = os.path.basename(out)
    header, source, chosen = amalgamate(headers)
    about = "%s in one header and one source" % (" ".join(sys.argv[2:]))
    os.makedirs(os.path.dirname(os.path.abspath(out)), exist_ok=True)
    with open(out + ".h", "w") as f:
        f.write(head(name + ".h", about) + SHADOW + header + SHADOW_END)
    with open(out + ".c", "w") as f:
        f.write(head(name + ".c", about) + QUIET_CXX + '#include "%s.h"\n' % name + source)
    print("%s.h, %s.c: %d sources" % (out, name, len(chosen)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
