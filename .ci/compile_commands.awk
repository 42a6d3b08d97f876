# SPDX-License-Identifier: MIT
# Makes compile_commands.json (dir: the tree) of what `make -n` prints: each command that compiles
# one source.
BEGIN { printf "[" }
/\\$/ { sub(/\\$/, ""); sub(/^[ \t]+/, ""); line = line $0; next }
{
    sub(/^[ \t]+/, "")
    command = line $0
    line = ""
}
match(command, / -c [^ ]+\.c /) {
    file = substr(command, RSTART + 4, RLENGTH - 5)
    sub(/^mkdir -p [^ ]+ && /, "", command)
    gsub(/\\/, "\\\\", command)
    gsub(/"/, "\\\"", command)
    printf "%s\n{\"directory\": \"%s\", \"file\": \"%s\", \"command\": \"%s\"}", n++ ? "," : "",
        dir, file, command
}
END { printf "\n]\n" }
