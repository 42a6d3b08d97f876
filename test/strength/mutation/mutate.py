# SPDX-License-Identifier: MIT
"""Mutants of a C source: small changes, each at one place, of operators, numbers, conditions,
returns and statements.

This file knows C's tokens and how brackets nest. The compiler rejects changes that are not C. Not
changed: arguments of EXH_ASSERT (a caller's mistake, which no test makes), names, texts, and all at
file level but numbers.
"""

import bisect
import collections
import re

TOKEN = re.compile(r"""(?P<blank>\s+|/\*.*?\*/|//[^\n]*|\\\n)
    | (?P<text>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
    | (?P<number>(?:0[xX][0-9a-fA-F]+|\d+)[uUlL]*\b)
    | (?P<name>[A-Za-z_]\w*)
    | (?P<op><<=|>>=|\.\.\.|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|.)""", re.S | re.X)

SWAP = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",),
    "!=": ("==",), "&&": ("||",), "||": ("&&",), "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",),
    "%": ("/",), "<<": (">>",), ">>": ("<<",), "&": ("|",), "|": ("&",), "^": ("&",), "++": ("--",),
    "--": ("++",), "+=": ("-=", "="), "-=": ("+=", "="), "*=": ("/=",), "/=": ("*=",),
    "&=": ("|=", "="), "|=": ("&=", "="), "^=": ("&=",), "<<=": (">>=",), ">>=": ("<<=",),
}
UNARY_GONE = {"!", "~", "-"}
TYPES = {"const", "static", "struct", "enum", "union", "int", "unsigned", "char", "void", "typedef",
         "extern", "volatile"}
ENDS_OPERAND = re.compile(r"[\w)\]]$")
BEFORE_CONDITION = ({"(", "[", "{", ",", ";", "?", ":", "=", "return"} |
                    {o for o in SWAP if o[-1] == "=" and o not in
                     ("<=", ">=", "==", "!=")})

Token = collections.namedtuple("Token", "kind text at end")
Mutant = collections.namedtuple("Mutant", "at end new")


def tokens(text):
    """Without blanks, comments, and directives, of which the right sides of #define stay."""
    out, i = [], 0
    while i < len(text):
        m = TOKEN.match(text, i)
        kind, i = m.lastgroup, m.end()
        if kind == "op" and m.group() == "#":
            line = re.compile(r"#[ \t]*define[ \t]+\w+(\([^)]*\))?|(?:\\\n|/\*.*?\*/|[^\n])*",
                              re.S).match(text, m.start())
            out.append(Token("op", "#", m.start(), line.end()))  # ends the code before it
            i = line.end()
        elif kind != "blank":
            out.append(Token(kind, m.group(), m.start(), m.end()))
    return out


def partners(ts):
    """Of each bracket its other one."""
    of, open_ = {}, []
    for i, t in enumerate(ts):
        if t.text in ("(", "[", "{"):
            open_.append(i)
        elif t.text in (")", "]", "}") and open_:
            of[i] = open_.pop()
            of[of[i]] = i
    return of


def numbers(t):
    digits = t.text.rstrip("uUlL")
    n, tail = (int(digits, 0) if digits[:2] in ("0x", "0X") or digits == "0" else int(digits),
               t.text[len(digits):])
    for v in (n + 1, n - 1):
        if v >= 0:
            yield Mutant(t.at, t.end, ("0x%0*X" % (len(digits) - 2, v) if digits[:2] in ("0x", "0X")
                                       else str(v)) + tail)


def operators(ts, i):
    t, before = ts[i], ts[i - 1].text if i else ""
    binary = bool(ENDS_OPERAND.search(before)) and before not in ("return", "case")
    if t.text in UNARY_GONE and not binary:
        yield Mutant(t.at, t.end, "")
    elif t.text in ("*", "&", "-", "+") and not binary:
        return
    elif (t.text == "*" and
          (before.endswith("_t") or before in TYPES or ts[i - 2].text in ("struct", "enum") or
           ts[i + 1].text in (")", ",", "const"))):
        return  # a pointer
    else:
        for new in SWAP.get(t.text, ()):
            yield Mutant(t.at, t.end, new)


def conditions(ts, of, i):
    """if (1), if (0), while (0), and the same of a ? b : c."""
    t = ts[i]
    if t.text in ("if", "while") and ts[i + 1].text == "(":
        for new in ("0", "1") if t.text == "if" else ("0",):
            yield Mutant(ts[i + 1].end, ts[of[i + 1]].at, new)
    if t.text == "?":
        k = i - 1
        while ts[k].text not in BEFORE_CONDITION:
            k = of[k] - 1 if ts[k].text in (")", "]", "}") else k - 1
        for new in ("0", "1"):
            yield Mutant(ts[k + 1].at, t.at, new + " ")


def statement(ts, of, i):
    """The statement that begins with token i, or after its conditions, is removed or returns 0."""
    while ts[i].text in ("if", "while", "for", "switch", "else", "do"):
        i = (of[i + 1] + 1 if ts[i].text in ("if", "while", "for", "switch") and i + 1 in of
             else i + 1)
    t = ts[i]
    if (t.text in TYPES or t.text.endswith("_t") or
        t.text in ("{", "}", ";", "case", "default", "EXH_ASSERT", "#", ".", "[")):
        return
    end = i
    while ts[end].text != ";":
        if ts[end].text in ("}", "#"):
            return  # no statement: values of a table
        end = of[end] + 1 if ts[end].text in ("(", "[", "{") and end in of else end + 1
    if t.text == "return":
        if ts[i + 1].text not in (";", "0") or ts[i + 2].text != ";" and ts[i + 1].text == "0":
            yield Mutant(ts[i + 1].at, ts[end].at, "0")
    else:
        yield Mutant(t.at, ts[end].at, "")


def is_label(ts, i):
    """Whether this colon ends a case."""
    while ts[i].text not in ("?", ";", "{", "}", "case", "default"):
        i -= 1
    return ts[i].text in ("case", "default")


def mutants(text):
    """All of a source, in its order."""
    ts = tokens(text)
    of = partners(ts)
    found, depth, round_, i = set(), 0, 0, 0
    while i < len(ts):
        t = ts[i]
        if t.text == "EXH_ASSERT":
            i = of[i + 1] + 1
            continue
        depth += {"{": 1, "}": -1}.get(t.text, 0)
        round_ += {"(": 1, ")": -1}.get(t.text, 0)
        if t.kind == "number":
            found.update(numbers(t))
        if depth > 0:
            if t.kind == "op":
                found.update(operators(ts, i))
            found.update(conditions(ts, of, i))
            if (round_ == 0 and (t.text in ("{", "}", ";") or t.text == ":" and is_label(ts, i)) and
                i + 1 < len(ts)):
                found.update(statement(ts, of, i + 1))
        i += 1
    return sorted(m for m in found if text[m.at:m.end].strip() != m.new.strip())


class Source:
    def __init__(self, path, text):
        self.path, self.text = path, text
        self.starts = [0] + [m.end() for m in re.finditer("\n", text)]
        self.functions = [(m.start(), m.group(1))
                          for m in re.finditer(r"^[A-Za-z_][^\n;={]*?\b(\w+)\((?:[^;{}]*)\)\s*\{",
                                               text, re.M)]

    def changed(self, m):
        return self.text[:m.at] + m.new + self.text[m.end:]

    def shown(self, m):
        """(function, lines as they are, lines as they become), with single blanks. This name is
        valid until these lines change."""
        lo = self.starts[bisect.bisect_right(self.starts, m.at) - 1]
        hi = self.text.find("\n", m.end)
        now, new = self.text[lo:hi], self.text[lo:m.at] + m.new + self.text[m.end:hi]
        k = bisect.bisect_right([at for at, _ in self.functions], m.at)
        return (self.functions[k - 1][1] if k else "-",
                *(re.sub(r"\s+", " ", s).strip() for s in (now, new)))
