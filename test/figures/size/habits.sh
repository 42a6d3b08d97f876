#!/bin/sh
# SPDX-License-Identifier: MIT
# habits.sh ARCHIVE OBJDUMP: what the library never does, on its object code. It refutes "no
# recursion", "no calls through pointers" and "no memory that changes":
#   - no cycles in the graph of calls and tail calls. A function that jumps to itself is a loop.
#   - no calls of a register or of a word in memory. A tail call through one looks like a switch's
#     jump table, so it is not found.
#   - no .data, .bss and common symbols, except the self-test's. Its operands are in memory, so that
#     no compiler computes the answers.
# Objects must be compiled with -ffunction-sections.
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
