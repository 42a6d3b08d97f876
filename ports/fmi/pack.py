#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Packs a source FMU: pack.py FMU DESCRIBE FOLDER=PREFIX... -- SOURCE... : what DESCRIBE prints,
and the sources in their folders. Files of each FOLDER go to sources/PREFIX (headers all, of C files
those named). The same bytes every time."""
import pathlib
import subprocess
import sys
import zipfile


def add(archive, name, data):
    entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
    entry.external_attr = 0o644 << 16
    archive.writestr(entry, data, zipfile.ZIP_DEFLATED)


def main(fmu, describe, *rest):
    split = rest.index("--")
    folders = [f.split("=") for f in rest[:split]]
    sources = []
    with zipfile.ZipFile(fmu, "w") as archive:
        add(archive, "modelDescription.xml",
            subprocess.run([describe], check=True, capture_output=True).stdout)
        for folder, prefix in folders:
            for path in sorted(pathlib.Path(folder).iterdir()):
                name = f"{prefix}/{path.name}" if prefix else path.name
                if path.suffix == ".h" or str(path) in rest[split + 1:]:
                    add(archive, f"sources/{name}", path.read_bytes())
                if path.suffix == ".c" and str(path) in rest[split + 1:]:
                    sources.append(name)
        add(archive, "sources/buildDescription.xml",
            subprocess.run([describe, "build", *sources], check=True, capture_output=True).stdout)
        add(archive, "documentation/licenses/license.txt", pathlib.Path("LICENSE").read_bytes())
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
