# SPDX-License-Identifier: MIT
"""What ports/python/README.md and README.md print in Python runs as it is printed."""
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
PATH = os.pathsep.join([str(Path(os.environ["EXHAND"]).parent), str(Path(sys.executable).parent),
                        os.environ["PATH"]])


def sections(page):
    """(title, blocks) of those with code; a block is indented lines or ```python."""
    for part in re.split(r"^## ", (ROOT / page).read_text(), flags=re.M)[1:]:
        fenced = re.findall(r"^```python\n(.*?)^```$", part, re.M | re.S)
        blocks = re.findall(r"(?:^    .*\n(?:\n(?=    [ )]))*)+", part, re.M)
        yield (part.splitlines()[0],
               fenced or [re.sub(r"^    ", "", b, flags=re.M) for b in blocks])


CODE = {title: blocks for page in ("ports/python/README.md", "README.md")
        for title, blocks in sections(page) if any(b.startswith("import") for b in blocks) or
        "exhand-mcap" in str(blocks)}


def test_the_page_has_what_is_run():
    assert len(CODE) >= 7
    for title in ("A limiter from Python", "A limiter in ten lines", "A world in ten lines"):
        assert len(CODE[title][-1].strip().splitlines()) <= 10


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("page")


@pytest.mark.parametrize("title", CODE)
def test_section(title, folder):
    env, background = {**os.environ, "PATH": PATH}, []
    try:
        for block in CODE[title]:
            if block.startswith("import"):
                run = [sys.executable, "-c", block]
            elif block.rstrip().endswith("&"):
                words = block.split()[:-1]
                background.append(subprocess.Popen(words, cwd=folder, env=env, text=True,
                                                   stdout=subprocess.DEVNULL,
                                                   stderr=subprocess.PIPE))
                time.sleep(0.5)
                if background[-1].poll() and "without libmodbus" in background[-1].stderr.read():
                    pytest.skip("this program has no Modbus server")
                continue
            else:
                run = block.split()
            done = subprocess.run(run, cwd=folder, env=env, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            for words in re.findall(r"^print\(.*\) +# prints (.*)$", block, re.M):
                assert done.stdout.strip() == words
    finally:
        for p in background:
            p.terminate()
            p.wait()
    found = re.search(r"largest force: (\S+) N", done.stdout)
    assert not found or float(found.group(1)) > 0.5
