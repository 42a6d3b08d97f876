# SPDX-License-Identifier: MIT
# One table of several: the emulator's --faults of more scenes, with what is worst.
function number(text) { return text ~ /[0-9]/ ? text + 0 : -1 }
function most(a, b) { return a > b ? a : b }

BEGIN { FS = " *\\| *" }
/^\| fault / && !head { head = $0 }
/^\|--/ { rule = $0 }
NF == 10 && $3 ~ /^[0-9]+$/ {
    if (!($2 in n)) { name[++rows] = $2 }
    split($5, zero, ", ")
    split($8, told, /, else | [0-9]+/)
    n[$2] += $3
    pulled[$2] += $4
    mean[$2] += number(zero[1]) * $3
    zero_most[$2] = most(zero_most[$2], number(zero[2]))
    off[$2] = most(off[$2], number($6))
    ends[$2] = $5 ~ /[0-9]/
    A[$2] = most(A[$2], $7)
    word[$2] = told[1]
    match($8, /[0-9]+/)
    said[$2] += substr($8, RSTART, RLENGTH)
    if ($8 ~ /else/) { other[$2] = $8; sub(/.*else/, ", else", other[$2]) }
    wrong[$2] += $9
}
END {
    print head "\n" rule
    for (i = 1; i <= rows; i++) {
        k = name[i]
        printf "| %s | %d | %d | ", k, n[k], pulled[k]
        if (ends[k]) { printf "%.2f, %.2f | %.2f", mean[k] / n[k], zero_most[k], off[k] }
        else { printf "– | –" }
        printf " | %.2f | %s %d%s | %d |\n", A[k], word[k], said[k], other[k], wrong[k]
        all += n[k]
        bad += wrong[k]
    }
    printf "\n%d faults: %d wrong.\n", all, bad
}
