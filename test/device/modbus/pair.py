# SPDX-License-Identifier: MIT
"""A serial line between two programs: pair.py says the two ends, and passes bytes between them
until it is ended.

Two pseudo-terminals, crossed. It holds the ends open itself, so a program may come and go.
"""
import os
import select
import tty

masters, ends = zip(*(os.openpty() for _ in range(2)))
for end in ends:
    tty.setraw(end)
print(*(os.ttyname(end) for end in ends), flush=True)
other = dict(zip(masters, reversed(masters)))
while True:
    for fd in select.select(masters, (), ())[0]:
        os.write(other[fd], os.read(fd, 4096))
