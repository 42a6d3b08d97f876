#!/bin/sh
# SPDX-License-Identifier: MIT
# banned.sh ARCHIVE OBJDUMP: no floating point and no division in the library. It refutes "integer
# only" and "divides nowhere" on the object code. It names each function with a divide instruction,
# an x87 or VFP one, or an SSE/AVX one that computes, compares or converts floats. Registers of
# these units may move and combine integers (struct copies, memset). Software floating point and
# division show as undefined helpers, which undef.sh refuses.
# Exit status: 0 none, 1 some, 2 bad usage or an unknown machine, 3 no such tool.
# shellcheck source=test/figures/size/archive.sh
. "${0%/*}/archive.sh"

"$objdump" -d --no-show-raw-insn "$archive" >"$listing"

awk -v archive="$archive" '
    # x87 begins with f; packed and scalar floats end in ps pd ss sd; moves, bit operations and
    # shuffles of whole registers are tolerated, and the integer instructions (p...) with them.
    # movss and movsd are not: for integers compilers take movd and movq.
    function x86(op) {
        sub(/^v/, "", op)
        if (op ~ /^i?div[bwlq]?$/) { return 1 }
        if (op ~ /^f/ || op == "wait" || op ~ /^(pf|pi2f)/) { return op != "fs" }
        if (op ~ /^p/) { return 0 }
        if (op ~ /^cvt/) { return 1 }
        if (op ~ /^mov(a|u|h|l|hl|lh|nt)p[sd]$/) { return 0 }
        if (op ~ /^(and|andn|or|xor|shuf|unpck[lh]|blend)p[sd]$/) { return 0 }
        return op ~ /[ps][sd]$/ && op !~ /^(lss|lods|pabsd)/
    }
    # Cortex-M: loads, stores and moves of the registers are tolerated, vmrs (flags of a
    # comparison) is not. Integer SIMD carries its type (.i32 .s16 .u8).
    function arm(op) {
        if (op ~ /^[su]div/) { return 1 }
        if (op !~ /^v/) { return op ~ /^f(add|sub|mul|div|cmp|ld|st|si|ui|to|cp|neg|abs|sqrt|m)/ }
        if (op ~ /^v(mov|ldr|str|ldm|stm|ldmia|stmia|push|pop)(\.32|\.64|\.8|\.16)?$/) { return 0 }
        return op ~ /\.f(16|32|64)/ || op ~ /^(vmrs|vmsr|vcvt)/
    }
    /file format/ {
        machine = $NF ~ /(i386|x86-64)$/ ? "x86" : $NF ~ /arm$/ ? "arm" : $NF ~ /avr$/ ? "none" : ""
        if (machine == "") { unknown = $NF }
        next
    }
    /^[0-9a-f]+ <.*>:$/ { name = substr($2, 2, length($2) - 3); functions++; next }
    /^ *[0-9a-f]+:\t/ {
        instructions++
        op = $2
        # objdump writes prefixes as words before the instruction
        for (i = 2; op ~ /^(rep|repz|repnz|lock|cs|ds|es|ss|fs|gs|data16|addr32|bnd|notrack)$/;) {
            op = $(++i)
        }
        if ((machine == "x86" && x86(op)) || (machine == "arm" && arm(op))) {
            if (!(name in seen)) {
                seen[name] = 1
                print archive ": " name " (no floating point, no division): " op > "/dev/stderr"
                bad = 1
            }
        }
    }
    END {
        if (unknown) {
            print archive ": " unknown " (x86, arm, avr): teach this script" > "/dev/stderr"
            exit 2
        }
        if (!instructions) { print archive ": no instructions" > "/dev/stderr"; exit 1 }
        if (!bad) {
            print archive ": no floating point and no division in " instructions \
                " instructions of " functions \
                  " functions"
        }
        exit bad
    }' "$listing"
