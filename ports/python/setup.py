# SPDX-License-Identifier: MIT
"""Builds the library's C sources into one shared library that ctypes opens: no Python.h is needed.

The sources are beside this file in a source distribution, and two folders up in the repository.
"""
import re
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent
ROOT = HERE if (HERE / "lib").is_dir() else HERE.parent.parent
SCENES = "drop guarded calibrate glove bilateral bringup identify".split()
RUN = ["lib/src/run/%s.c" % name for name in ("log", "calib_set", "crc_table")]


def sources():
    found = [p for p in sorted(ROOT.glob("lib/src/*/*.c"))
             if p.parent.name != "run" and p.name != "crc.c"]  # crc_table.c is the quick one
    found += [ROOT / name for name in RUN]
    found += [p for s in SCENES for p in sorted(ROOT.glob("examples/%s/*.c" % s))]
    return ["src/door.c"] + [str(p.relative_to(HERE) if ROOT == HERE else p) for p in found]


def version():
    text = (ROOT / "lib/include/exhand/exhand.h").read_text(encoding="utf-8")
    return ".".join(re.findall(r"define EXH_VERSION_(?:MAJOR|MINOR|PATCH) +(\d+)", text))


class Build(build_ext):
    """A plain shared library: no suffix of an interpreter, no function of a Python module."""

    def get_ext_filename(self, fullname):
        return fullname.replace(".", "/") + ".so"

    def get_export_symbols(self, ext):
        return []


class Wheel(bdist_wheel):
    """Any Python 3 of this platform."""

    def get_tag(self):
        return ("py3", "none", super().get_tag()[2])


setup(
    version=version(),
    ext_modules=[Extension("exhand._exhand", sources(), extra_compile_args=["-std=c99", "-O2"],
                           include_dirs=[str(ROOT / "lib/include"), str(ROOT / "examples")])],
    cmdclass={"build_ext": Build, "bdist_wheel": Wheel},
)
