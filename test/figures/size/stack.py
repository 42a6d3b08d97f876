#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Worst-case stack of an image, in bytes: stack.py [--root main] [--objdump objdump] OBJECT...

Each OBJECT was compiled by gcc with -fcallgraph-info=su: its call graph is beside it, with the
ending .ci. The deepest path from the root is printed, the bytes first.

The few function pointers of this project are in constant tables (struct exh_scene, struct
exh_loop_hooks). So an indirect call reaches any function whose address is in the data of any
object. In these callers it reaches only what some tables point to:

    log.c         (exh_log_*, lib/src/run) a scene's table, a tap's (struct exh_log_tap tap), and
                  log_later's (struct exh_log_way here). The loop's hooks call the log.
    log_later.c   a scene's table
    the black box a scene's table: it asks the scene to show its signals
    modbus        (pc104, stm32f405) a scene's table: it asks the scene what is allowed
    scene custom  its slot
    calibrate_tick()  its own table of steps

A function whose address is taken only by code is not seen: give it a table. Functions without a
graph (assembler, the C library) count as nothing and are named.

Exit status: 0 bounded, 1 not (recursion, a frame of unknown size), 2 bad usage, 3 no objdump.
"""
import argparse
import re
import subprocess
import sys

NODE = re.compile(r'node: \{ title: "([^"]*)" label: "([^"]*)"( shape : ellipse)?')
EDGE = re.compile(r'edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)"')
BYTES = re.compile(r'(\d+) bytes \(([^)]*)\)')
SECTION = re.compile(r'RELOCATION RECORDS FOR \[([^]]*)\]')
RELOCATION = re.compile(r'^[0-9a-f]+ +R_\S+ +(\S+)')
INDIRECT = '__indirect_call'
LOG = re.compile(r'(^|:)(exh_log_|exh_blackbox_|pc104_modbus_|stm_modbus_)|'
                 r'(^|/)(log|blackbox|pc104/modbus|stm32f405/modbus)\.c:')
# Callers that call by some tables only: (caller, the tables' sections). The first that fits is
# taken.
ONLY = ((re.compile(r'(^|/)custom\.c:'), re.compile(r'\.slot$')),
        (re.compile(r'(^|/)log_later\.c:'), re.compile(r'exh_scene_')),
        (LOG, re.compile(r'exh_scene_|\.(tap|here)(\.\d+)?$')),
        (re.compile(r'(^|:)calibrate_tick$'), re.compile(r'\.steps$')))


class Unbounded(Exception):
    pass


def read_graph(obj, frames, calls):
    """Adds the functions of one object; returns {bare name: title} of them."""
    titles = {}
    with open(re.sub(r'\.o$', '.ci', obj), encoding='utf-8') as graph:
        for line in graph:
            node = NODE.match(line)
            edge = EDGE.match(line)
            size = node and BYTES.search(node.group(2))
            if size:
                frames[node.group(1)] = (int(size.group(1)), size.group(2))
                titles[node.group(1).rsplit(':', 1)[-1]] = node.group(1)
            elif edge:
                calls.setdefault(edge.group(1), set()).add(edge.group(2))
    return titles


def addresses_in_data(obj, objdump):
    """(Name, section that has its address) of what the data of an object points to."""
    text = subprocess.run([objdump, '-r', obj], check=True, capture_output=True, text=True).stdout
    names, is_data, where = set(), False, ''
    for line in text.splitlines():
        section = SECTION.match(line)
        relocation = RELOCATION.match(line)
        if section:
            is_data = re.match(r'\.(data|rodata)', section.group(1)) is not None
            where = section.group(1)
        elif relocation and is_data:
            names.add((re.sub(r'^\.text\.|[+-]0x[0-9a-f]+$', '', relocation.group(1)), where))
    return names


def reached(caller, tables):
    """Titles that an indirect call of this caller may reach."""
    only = next((where for who, where in ONLY if who.search(caller)), re.compile(''))
    return sorted(title for title, sections in tables.items()
                  if any(only.search(at) for at in sections))


def deepest(title, graph, done, path):
    """(bytes, path of titles) of the worst call chain that starts at title."""
    frames, calls, tables, unknown = graph
    if title in path:
        raise Unbounded('recursion: ' + ' -> '.join(path[path.index(title):] + [title]))
    if title not in done:
        if title not in frames:
            unknown.add(title)
            return 0, [title]
        size, kind = frames[title]
        if kind not in ('static', 'dynamic,bounded'):
            raise Unbounded(f'{title}: frame is {kind} (static)')
        below = [deepest(callee, graph, done, path + [title])
                 for target in sorted(calls.get(title, ()))
                 for callee in (reached(title, tables) if target == INDIRECT else [target])]
        worst = max(below, default=(0, []), key=lambda chain: chain[0])
        done[title] = (size + worst[0], [title] + worst[1])
    return done[title]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--root', default='main')
    parser.add_argument('--objdump', default='objdump')
    parser.add_argument('objects', nargs='+', metavar='OBJECT')
    args = parser.parse_args()
    frames, calls, tables, names = {}, {}, {}, {}
    try:
        per_object = [(obj, read_graph(obj, frames, calls)) for obj in args.objects]
        for _, titles in per_object:
            names.update((t, t) for t in titles.values())
        for obj, titles in per_object:
            for name, where in addresses_in_data(obj, args.objdump):
                title = titles.get(name, names.get(name))
                if title:
                    tables.setdefault(title, set()).add(where)
    except FileNotFoundError as missing:
        print(f'{missing.filename}: not found: compile with -fcallgraph-info=su, '
              'or install the binutils', file=sys.stderr)
        return 3
    if args.root not in frames:
        print(f'{args.root}: no such function in these objects', file=sys.stderr)
        return 2
    unknown = set()
    try:
        size, path = deepest(args.root, (frames, calls, tables, unknown), {}, [])
    except Unbounded as why:
        print(why, file=sys.stderr)
        return 1
    print(size, ' > '.join(f'{t.rsplit(":", 1)[-1]}({frames[t][0] if t in frames else "?"})'
                           for t in path))
    if unknown:
        print('counted as nothing:', ' '.join(sorted(unknown)))
    return 0


if __name__ == '__main__':
    sys.exit(main())
