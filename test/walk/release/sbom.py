#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints the bill of materials as SPDX 2.3 tag-value. It lists exhand and all that it is built, run
and tested with on this machine, with Debian's versions. NOASSERTION: it is not installed here.

    sbom.py            prints it (make sbom)
    sbom.py --check    1 if a field that the standard requires is missing

SOURCE_DATE_EPOCH is its date; else that of the newest commit.
"""
import os
import re
import subprocess
import sys

# Package, SPDX licence, relation to exhand, what for.
PARTS = (
    ("libmodbus-dev", "LGPL-2.1-or-later", "OPTIONAL_DEPENDENCY_OF", "host: Modbus"),
    ("libgpiod-dev", "LGPL-2.1-or-later", "OPTIONAL_DEPENDENCY_OF", "host: lines of a GPIO chip"),
    ("libsdl2-dev", "Zlib", "OPTIONAL_DEPENDENCY_OF", "world: its window"),
    ("libembree-dev", "Apache-2.0", "OPTIONAL_DEPENDENCY_OF", "world: meshes"),
    ("libcmocka-dev", "Apache-2.0", "TEST_DEPENDENCY_OF", "tests on the host"),
    ("gcc", "GPL-3.0-or-later", "BUILD_TOOL_OF", "library and host programs"),
    ("gcc-i686-linux-gnu", "GPL-3.0-or-later", "BUILD_TOOL_OF", "images for pc104"),
    ("gcc-arm-none-eabi", "GPL-3.0-or-later", "BUILD_TOOL_OF", "images for mps2"),
    ("make", "GPL-3.0-or-later", "BUILD_TOOL_OF", "the build"),
)
DOCUMENT = ("SPDXVersion", "DataLicense", "SPDXID", "DocumentName", "DocumentNamespace", "Creator",
            "Created")
PACKAGE = ("PackageName", "SPDXID", "PackageDownloadLocation")
LINE = re.compile(r"^([A-Za-z]+): \S.*$")


def said(*command):
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def own_version():
    with open("lib/include/exhand/exhand.h") as f:
        found = dict(re.findall(r"EXH_VERSION_(MAJOR|MINOR|PATCH) (\d+)", f.read()))
    return ".".join(found[k] for k in ("MAJOR", "MINOR", "PATCH"))


def package(name, ident, version, licence, comment):
    yield ""
    yield "PackageName: " + name
    yield "SPDXID: " + ident
    yield "PackageVersion: " + (version or "NOASSERTION")
    yield "PackageDownloadLocation: NOASSERTION"
    yield "FilesAnalyzed: false"
    yield "PackageLicenseConcluded: NOASSERTION"
    yield "PackageLicenseDeclared: " + licence
    yield "PackageCopyrightText: NOASSERTION"
    yield "PackageComment: <text>%s</text>" % comment


def document():
    version = own_version()
    commit = said("git", "rev-parse", "HEAD") or "unknown"
    epoch = os.environ.get("SOURCE_DATE_EPOCH") or said("git", "log", "-1", "--format=%ct") or "0"
    yield "SPDXVersion: SPDX-2.3"
    yield "DataLicense: CC0-1.0"
    yield "SPDXID: SPDXRef-DOCUMENT"
    yield "DocumentName: exhand-" + version
    yield "DocumentNamespace: https://spdx.org/spdxdocs/exhand-%s-%s" % (version, commit)
    yield "Creator: Tool: exhand-sbom"
    yield "Created: " + said("date", "-u", "-d", "@" + epoch, "+%Y-%m-%dT%H:%M:%SZ")
    yield from package("exhand", "SPDXRef-exhand", version, "MIT",
                       "The library, lib/, depends on nothing. Commit %s" % commit)
    for name, licence, _, what in PARTS:
        yield from package(name, "SPDXRef-" + name,
                           said("dpkg-query", "-W", "-f", "${Version}", name), licence, what)
    yield ""
    yield "Relationship: SPDXRef-DOCUMENT DESCRIBES SPDXRef-exhand"
    for name, _, relation, _ in PARTS:
        yield "Relationship: SPDXRef-%s %s SPDXRef-exhand" % (name, relation)


def faults(lines):
    """What the standard requires and is not there."""
    parts = [part.split("\n") for part in "\n".join(lines).split("\n\n")]
    for part in parts:
        tags = [LINE.match(line).group(1) if LINE.match(line) else "" for line in part]
        if "" in tags:
            yield "no tag and value: " + part[tags.index("")]
        wanted = (DOCUMENT if tags[0] == "SPDXVersion" else
                  PACKAGE if tags[0] == "PackageName" else ())
        yield from ("%s: no %s" % (part[0], tag) for tag in wanted if tag not in tags)
    idents = [line.split(": ")[1] for line in lines if line.startswith("SPDXID: ")]
    if len(set(idents)) != len(idents):
        yield "an SPDXID twice"
    for line in lines:
        if line.startswith("Relationship: "):
            _, one, _, other = line.split(" ")
            yield from ("%s: is nothing" % i for i in (one, other) if i not in idents)


def main():
    lines = list(document())
    wrong = list(faults(lines))
    print("\n".join(wrong or ["%d packages" % (len(PARTS) + 1)] if "--check" in sys.argv
                    else lines))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
