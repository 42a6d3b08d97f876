# SPDX-License-Identifier: MIT
"""registry.py: what PlatformIO's registry would have brought: its SCons, which PyPI has as well,
and platform `native`, which is ours here. Run by the Python of the environment that holds
PlatformIO; put where that one looks for it.
"""

import os
import shutil
import subprocess
import sys

from platformio.dependencies import get_core_dependencies
from platformio.project.config import ProjectConfig

core = ProjectConfig().get("platformio", "core_dir")
tool = os.path.join(core, "packages", "tool-scons")
version = get_core_dependencies()["tool-scons"].strip("~^")
spec = ('"spec": {"owner": "platformio", "id": null, "name": "tool-scons", "requirements": null, '
        '"uri": null}')

subprocess.run([sys.executable, "-m", "pip", "install", "-q", "--target", tool, "scons"],
               check=True)
for name, text in (("scons.py", "from SCons.Script import main\nmain()\n"),
                   ("package.json", '{"name": "tool-scons", "version": "%s"}' % version),
                   (".piopm", '{"type": "tool", "name": "tool-scons", "version": "%s", %s}' %
                    (version, spec))):
    with open(os.path.join(tool, name), "w") as f:
        f.write(text)
shutil.copytree(os.path.join(os.path.dirname(os.path.abspath(__file__)), "platformio"),
                os.path.join(core, "platforms", "native"), dirs_exist_ok=True)
