# The headers' plain comments as Doxygen wants them. A comment at the margin is of all that follows it until an empty line,
# one behind code is of that code, the first is the file's.
function flush(   n, i, depth, c, start) {
    for (i = start = 1; i <= lines; i++) if (line[i] ~ /\*\/$/) { start = i + 1; break }
    for (i = start; i <= lines; i++) {
        c = line[i]; sub(/\/\*.*/, "", c)
        if (depth == 0 && c ~ /^#define/) n++
        depth += gsub(/\{/, "", c) - gsub(/\}/, "", c)
        if (depth == 0 && c ~ /;[ ]*$/) n++
    }
    if (n > 1) print "/**@{*/"
    for (i = 1; i <= lines; i++) print line[i]
    if (n > 1) print "/**@}*/"
    lines = 0
}
function keep(text) { if (held) line[++lines] = text; else print text }
NR == 1 && /^\/\*/ { sub(/^\/\*/, "/** @file\n *"); first = 1 }
/^\/\* ---/ { print; next }
!first && /^\/\*/ && !held { sub(/^\/\*/, "/**"); held = 1 }
/\*\// && first { first = 0 }
/[^ ].*\/\*/ && !/^\/\*/ && !/^ *\/\*/ && !/^#(if|endif|else|include)/ { sub(/\/\*/, "/**<") }
/^ +\/\* / { sub(/\/\*/, "/**") }
/^ *\{/ || /\{$/ { depth++ }
/^ *\}/ { depth-- }
/^$/ && depth <= 0 { if (held) { flush(); held = 0 } print; next }
{ keep($0) }
END { if (held) flush() }
