#!/bin/sh
# SPDX-License-Identifier: MIT
# What the library never does, on its object code: habits.sh ARCHIVE OBJDUMP
# Refutes "no recursion", "no calls through pointers" and "no memory of its own that changes": looks
# for cycles in the graph of calls and tail calls (a function that jumps to itself is a loop), for
# calls of a register or a word in memory (a tail call through one cannot be told from a switch's
# table), and for .data, .bss and common symbols, but for the self-test's: its operands are in
# memory, so that no compiler works out the answers. Objects must be compiled with
# -ffunction-sections.
# Exit status: 0 none, 1 some, 2 bad usage or an unknown machine, 3 no such tool.
# shellcheck source=test/figures/size/archive.sh
. "${0%/*}/archive.sh"

"$objdump" -t "$archive" >"$listing"
"$objdump" -dr --no-show-raw-insn "$archive" >>"$listing"

awk -v archive="$archive" '
    function complain(what) { print archive ": " what > "/dev/stderr"; bad = 1 }
    function edge(to) {
        sub(/[-+]0x[0-9a-f]+$/, "", to)
        sub(/^\.text\.(unlikely\.)?/, "", to)
        sub(/\.cold.*/, "", to)
        if (to == name && !calls) { return }
        if (to != "" && to !~ /^\./ && !((name, to) in call)) {
            call[name, to] = 1
            out[name] = out[name] " " to
            edges++
        }
    }
    # 0 not seen, 1 on the way, 2 done
    function walk(f, way,    to, n, i) {
        if (mark[f] == 2) { return }
        if (mark[f] == 1) { complain("recursion:" way " " f); return }
        mark[f] = 1
        n = split(out[f], to, " ")
        for (i = 1; i <= n; i++) { if (to[i] in is) { walk(to[i], way " " f) } }
        mark[f] = 2
    }
    # Symbols: value, flags, section, size, name.
    /^[0-9a-f]+ .......[ \t]*(\.data|\.bss|\*COM\*)/ {
        if ($0 !~ /\.data\.rel\.ro/ && $(NF - 1) !~ /^0+$/ && member !~ /^selftest/) {
            complain($NF ": memory that changes")
        }
        next
    }
    /file format/ { member = $1; if ($NF !~ /(i386|x86-64|arm)$/) { unknown = $NF } next }
    /^[0-9a-f]+ <.*>:$/ {
        name = substr($2, 2, length($2) - 3); sub(/\.cold.*/, "", name)
        is[name] = 1; functions++; next
    }
    /\tR_[A-Z0-9_]*(PLT32|PC32|CALL|JUMP24|JUMP19|PC24)\t/ ||
    /: R_[A-Z0-9_]*(PLT32|PC32|CALL|JUMP24|JUMP19|PC24)/ {
        itself = ""
        edge($NF)
        next
    }
    /^ *[0-9a-f]+:\t/ {
        calls = $0 ~ /\t(call[lq]?|bl)[ \t]/
        if ($0 ~ /\tcall[lq]? +\*/ || $0 ~ /\tblx[a-z]*\t? *r[0-9]/) {
            complain(name ": calls through a pointer")
        }
        if (itself) { complain("recursion: " itself) }
        itself = calls && index($0, "<" name ">") ? name : "" # unless a relocation says where to
    }
    END {
        if (unknown) { print archive ": " unknown ": teach this script" > "/dev/stderr"; exit 2 }
        if (!functions || !edges) {
            print archive ": no functions or no calls" > "/dev/stderr"; exit 1
        }
        for (f in is) { walk(f, "") }
        if (!bad) {
            print archive ": no recursion among " edges \
                " calls, none through a pointer, no memory that changes"
        }
        exit bad
    }' "$listing"
