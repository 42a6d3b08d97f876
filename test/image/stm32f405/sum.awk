# SPDX-License-Identifier: MIT
# One table of several: the emulator's --faults of more scenes, with what is worst.
function number(text) { return text ~ /[0-9]/ ? text + 0 : -1 }
function most(a, b) { return a > b ? a : b }

BEGIN { FS = " *\\| *" }
/^\| fault / && !head { head = $0 }
/^\|--/ { rule = $0 }
NF == 11 && $3 ~ /^[0-9]+$/ {
    if (!($2 in n)) { name[++rows] = $2 }
    split($6, zero, ", ")
    split($9, told, /, else | [0-9]+/)
    n[$2] += $3
    pulled[$2] += $4
    mean[$2] += number(zero[1]) * $3
    zero_most[$2] = most(zero_most[$2], number(zero[2]))
    off[$2] = most(off[$2], number($7))
    ends[$2] = $6 ~ /[0-9]/
    A[$2] = most(A[$2], $8)
    word[$2] = told[1]
    match($9, /[0-9]+/)
    said[$2] += substr($9, RSTART, RLENGTH)
    if ($9 ~ /else/) { other[$2] = $9; sub(/.*else/, ", else", other[$2]) }
    wrong[$2] += $10
    acted[$2] = $5 ~ /[0-9]/ ? acted[$2] + $5 : $5
}
END {
    print head "\n" rule
    for (i = 1; i <= rows; i++) {
        k = name[i]
        printf "| %s | %d | %d | %s | ", k, n[k], pulled[k], acted[k]
        if (acted[k] == 0 && acted[k] != "told") { without++ }
        if (ends[k]) { printf "%.2f, %.2f | %.2f", mean[k] / n[k], zero_most[k], off[k] }
        else { printf "– | –" }
        printf " | %.2f | %s %d%s | %d |\n", A[k], word[k], said[k], other[k], wrong[k]
        all += n[k]
        bad += wrong[k]
    }
    printf "\n%d faults: %d wrong", all, bad
    if (without) { printf ", %d kinds without effect", without }
    print "."
    exit without > 0
}
