# SPDX-License-Identifier: MIT
# Lists the targets of makefiles: "##@ GROUP", "## SENTENCE" or "##N SENTENCE" is before a target.
# few: only targets with a number N, in the order of N.
/^##@ / { group = substr($0, 5); next }
text && /^## / { text = text substr($0, 3); next } # it goes on
/^##[0-9]? / { number = substr($0, 3, 1); text = substr($0, 4 + (number != " ")); next }
text && /^[a-z][^=]*:([^=]|$)/ {
    sub(/:.*/, "")
    if (few && number != " ") {
        printf "%s  %-10s %s\n", number, $1, text
    }
    if (!few) {
        if (group) {
            printf "%s%s\n", shown++ ? "\n" : "", group
        }
        printf "  %-15s %s\n", $1, text
        group = ""
    }
    text = ""
}
