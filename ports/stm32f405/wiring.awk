# SPDX-License-Identifier: MIT
# wiring.tsv as: want=h a C table (X-macro), want=md the table of docs/STM32F405.md, want=dot its
# picture. A pin, net or connector that is there twice, or a word that is none, ends it with 1.
BEGIN {
    FS = "\t"
    split("up none down", pulls, " ")
    for (i in pulls) { pull[pulls[i]] = toupper(pulls[i]) }
    if (want == "h") {
        print "/* Made of wiring.tsv: X(net, port, pin, mode, function, pull, high) */"
        printf "#define WIRING(X)"
    } else if (want == "md") {
        print "| connector | net | pin | function | mode | pull | what |\n|--|--|--|--|--|--|--|"
    } else {
        print "digraph wiring {\n rankdir=LR; ranksep=2.5; edge [arrowhead=none, color=gray50];"
        print " node [shape=record, fontname=\"DejaVu Sans\", fontsize=10];"
    }
}
/^#/ || $1 == "pin" { next }
NF != 7 || $1 !~ /^P[A-D][0-9]+$/ || $3 !~ /^(AF[0-9]+|analog|in|out1?)$/ || !($6 in pull) ||
    seen[$1]++ || seen[$4]++ || seen[$5]++ {
    print "wiring.tsv:" FNR ": not a row, or a pin, net or connector twice: " $0 > "/dev/stderr"
    bad = 1
    exit 1
}
{
    part = $5
    sub(/\..*/, "", part)
    if (!(part in at)) { order[++parts] = part }
    at[part] = at[part] (at[part] == "" ? "" : "|") "<" $4 "> " $5 " " $4
    fn = $2 == "GPIO" ? ($3 == "in" ? "input" : "output") : $2
    chip = chip (chip == "" ? "" : "|") "<" $4 "> " $1 " " fn
    edges = edges (parts < 4 ? part ":" $4 ":e -> chip:" $4 ":w;\n" : \
        "chip:" $4 ":e -> " part ":" $4 ":w;\n")
}
want == "h" {
    port = index("ABCD", substr($1, 2, 1)) - 1
    mode = $3 ~ /^AF/ ? "AF" : $3 == "analog" ? "ANALOG" : $3 == "in" ? "IN" : "OUT"
    printf " \\\n    X(%s, %d, %s, %s, %d, %s, %d)", $4, port, substr($1, 3), mode,
        $3 ~ /^AF/ ? substr($3, 3) : 0, pull[$6], $3 == "out1"
}
want == "md" { print "| " $5 " | " $4 " | " $1 " | " $2 " | " $3 " | " $6 " | " $7 " |" }
END {
    if (bad) { exit 1 }
    if (want == "h") { print "" }
    if (want != "dot") { exit }
    split("encoders;monitors, supply;glove;D/A;enables, relay;stops, ready;serial lines", what, ";")
    for (i = 1; i <= parts; i++) {
        print " " order[i] " [label=\"" order[i] " " what[i] "|" at[order[i]] "\"];"
    }
    print " chip [label=\"STM32F405RG|" chip "\"];\n" edges "}"
}
