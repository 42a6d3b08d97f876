# SPDX-License-Identifier: MIT
# The headers' plain comments as Doxygen wants them, line for line. The first comment is the file's.
# One at the margin describes all lines until an empty line, if there are any. One behind code
# describes that code. One between "---" begins a section. One in a function's body is not changed.

# The comment that begins in line i, as one line.
function text(i,   t, s) {
    t = substr(line[i], index(line[i], "/*") + 3)
    while (t !~ /\*\//) { s = line[++i]; sub(/^ *(\*( |$))?/, "", s); t = t " " s }
    sub(/ *\*\/.*/, "", t)
    return plain(t)
}
# In which line that one ends.
function end(i) { while (line[i] !~ /\*\//) i++; return i }
# Doxygen takes the first sentence for the short text, and any dot before a blank for its end.
function plain(s) { gsub(/\.\. /, "..\\&nbsp;", s); gsub(/\(eq\. /, "(equation ", s); return s }
# Prints it, with the text that opens it and the text behind it. Lines set far in are shown as they
# are, except lists.
function comment(open, behind,   s, last, list) {
    last = end(i); s = line[i]; sub(/\/\*/, open, s)
    while (i < last) {
        print plain(s); s = line[++i]
        if (s == " *") list = 0
        else if (s ~ /^ \* +- /) list = 1
        else if (!list) sub(/^ \*   /, " *       ", s)
    }
    print plain(s) behind
}
# Of several members or enumerators in line i, all but the last, each with what is said of all.
function apart(said,   code, type, of, n, k, stop) {
    code = line[i]; sub(/ *\/\*.*/, "", code); n = split(code, of, /, /); stop = ","
    if (n < 2 || code ~ /=/) return
    if (sub(/;$/, "", of[n])) { stop = ";"; type = of[1]; sub(/[^ ]+$/, "", type);
        sub(/.* /, "", of[1]) }
    for (k = 1; k < n; k++) printf "%s%s%s /**< %s */ ", type, of[k], stop, said
    line[i] = type of[n] (type ? ";" : "") " " substr(line[i], index(line[i], "/*"))
}
{ line[NR] = $0 }
END {
    for (i = 1; i <= NR; i++) {
        s = code = line[i]; sub(/ *\/\*.*/, "", code)
        if (s == "{") body = 1
        if (body) {
            if (s == "}") body = open = 0
            print s
        } else if (s == "" && !inside) {
            print section && (line[i + 1] ~ /^\/\* ---/ || line[i + 1] ~ /^#if/ &&
                line[i + 2] == "}") ? "/**@}*/" : ""
            doc = ""
        } else if (i == 1) {
            if (FILENAME ~ /exhand\.h$/) printf "/** @mainpage exhand\n@copydoc exhand.h */ "
            sub(/ *\*\/$/, " @file */", line[end(1)])
            comment("/**", "")
        } else if (s ~ /^\/\* ---/) {
            section = 1; sub(/ --- *\*\/$/, " */", line[i]); sub(/ ---$/, "", line[i]);
                sub(/ ---/, "", line[i])
            comment("/** @name", " /**@{*/")
        } else if (s ~ /^\/\*/) {
            if (line[end(i) + 1] == "") comment("/*", "")
            else { doc = text(i); fresh = 1; comment("/**", "") }
        } else if (s ~ /^ +\/\*/) {
            comment("/**", "")
        } else if (s ~ /^#(if|endif|else|include)/ || s ~ /^extern "C"/) {
            print s
        } else if (inside) {
            if (s ~ /^\}/) inside = open = 0
            if (s !~ /\/\*/) {
                if (s ~ /^ +EXH_[^(]*$/) {
                    print FILENAME ":" i ": warning: not documented:" s > "/dev/stderr"
                }
                print s
            } else { apart(text(i)); comment("/**<", "") }
        } else {
            starts = !open
            inside = code ~ /\{$/
            open = code ~ /^#/ ? code ~ /\\$/ : code !~ /[;}]$/
            if (inside && s ~ /\/\*/) print "/** " text(i) " */ " code
            else if (s ~ /\/\*/) { if (s ~ /^extern/) apart(text(i)); comment("/**<", "") }
            else if (starts && !fresh && doc != "")
                print code ~ /^#/ ? code " /**< " doc " */" : "/** " doc " */ " code
            else print s
            fresh = 0
        }
    }
}
