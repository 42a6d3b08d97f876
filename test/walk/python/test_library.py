# SPDX-License-Identifier: MIT
"""The library in the wheel: its codes are those of every way to link, its layouts C's."""
import ctypes
import os
import shlex
import subprocess
import sys
from pathlib import Path

import exhand
from exhand import limiter, modbus, signals

ROOT = Path(__file__).parents[3]
CC = shlex.split(os.environ.get("CC", "cc"))
LAYOUTS = [("exh_signal", signals.Row), ("exh_signal_group", signals.Group),
           ("exh_signal_table", signals.Table), ("exh_regs_row", modbus._Row),
           ("exh_limiter_in", limiter.In), ("exh_limiter_out", limiter.Out)]


def test_codes_are_those_of_examples_link(tmp_path):
    program = tmp_path / "finger.so"
    wheel = Path(exhand.__file__).with_name("_exhand.so")
    subprocess.run([*CC, "-std=c99", "-O2", "-shared", "-fPIC", "-I", ROOT / "lib/include",
                    ROOT / "examples/link/finger.c", wheel, "-o", program], check=True)
    said = subprocess.run([sys.executable, "-c", "import ctypes, sys, exhand\n"
                           "sys.exit(ctypes.CDLL(sys.argv[1]).main())", program],
                          capture_output=True, text=True, check=True, cwd=tmp_path).stdout
    assert said.strip() == "exhand %s: state 2, 4100 mN at most, codes 35cdb3e6" % \
        exhand.__version__


def test_layouts_are_those_of_the_c_compiler(tmp_path):
    wanted, text = [], ["#include <stddef.h>", "#include <stdio.h>", '#include "exhand/exhand.h"',
                        '#include "exhand/limiter.h"', '#include "exhand/regs.h"',
                        "#define SAY(x) printf(\"%zu\\n\", x)", "int main(void)", "{"]
    for name, layout in LAYOUTS:
        text.append("SAY(sizeof(struct %s));" % name)
        wanted.append(ctypes.sizeof(layout))
        for field, *_ in layout._fields_:
            text.append("SAY(offsetof(struct %s, %s));" % (name, field))
            wanted.append(getattr(layout, field).offset)
    for k, field in enumerate(limiter.FIELDS):
        text.append("SAY(offsetof(struct exh_limiter_par, %s) / sizeof(int32_t));" % field)
        wanted.append(k)
    text.append("SAY(sizeof(struct exh_limiter_par) / sizeof(int32_t));")
    wanted.append(len(limiter.FIELDS))
    source, program = tmp_path / "layout.c", tmp_path / "layout"
    source.write_text("\n".join([*text, "SAY((size_t)EXH_HEADS);", "SAY((size_t)EXH_COILS);",
                                 "return 0;", "}", ""]))
    subprocess.run([*CC, "-std=c99", "-I", ROOT / "lib/include", source, "-o", program], check=True)
    said = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    assert [int(w) for w in said] == [*wanted, len(modbus.HEAD), len(modbus.COILS)]
