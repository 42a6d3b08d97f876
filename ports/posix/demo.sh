#!/bin/sh
# SPDX-License-Identifier: MIT
# demo.sh LAB DIR PLOTS: the paper's experiments in the paper's order, each with a heading, a
# verdict and its pictures; DIR/index.html shows them. LAB is exhand-lab, PLOTS the folder of the
# scripts for gnuplot, without which there are no pictures. On a desktop the page opens.
# Exit status: 0 all passed, 1 a verdict or a picture failed, else that of the command that failed.
lab=$1 dir=$2 plots=$3
if [ ! -x "$lab" ] || [ ! -d "$plots" ] || ! mkdir -p "$dir"; then
    echo "usage: demo.sh LAB DIR PLOTS: give the program, a folder to write, the scripts" >&2
    exit 2
fi
page=$dir/index.html.new passed=0 failed=0 pid=
trap '[ -z "$pid" ] || kill "$pid"; exit 130' INT TERM
rm -f "$dir"/stability*.csv

html() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g' >>"$page"; }

part() # TITLE MEANING
{
    printf '\n== %s ==\n%s\n' "$1" "$2"
    { printf '<h2>%s</h2>\n<p>%s</p>\n' "$1" "$2"; } >>"$page"
}

# A dot every two seconds, where no terminal shows the command's own progress.
run() # NAME WORD...
{
    text=$dir/$1.txt
    shift
    "$lab" "$@" >"$text" &
    pid=$! n=0 dots=
    while kill -0 $pid 2>/dev/null; do
        sleep 0.2
        n=$((n + 1))
        [ -t 2 ] || [ $((n % 10)) != 0 ] || { printf "%s" "${dots:-running }."; dots=" "; }
    done
    wait $pid
    status=$? pid=
    [ -z "$dots" ] || echo
    [ $status = 0 ] && return
    cat "$text"
    echo "make demo: exhand-lab $* failed with exit status $status" >&2
    exit $status
}

verdict() # 1 or 0, TEXT
{
    if [ "$1" = 1 ]; then word=passed passed=$((passed + 1)); else
        word=FAILED failed=$((failed + 1)); fi
    echo "$word: $2"
    printf '<p><b>%s</b>: ' "$word" >>"$page"
    echo "$2" | html
    echo '</p>' >>"$page"
}

# What awk prints: 1 or 0, and the verdict's text.
judge() # FILE PROGRAM
{
    said=$(awk "$2" "$1")
    verdict "${said%% *}" "${said#* }"
}

pictures() # FOLDER SCRIPT NAME...
{
    folder=$1${1:+/} script=$2
    shift 2
    command -v gnuplot >/dev/null || { echo "left out: pictures: gnuplot is missing"; return; }
    (cd "$dir/$folder." && gnuplot -c "$script.gp" "$plots")
    for name; do
        if [ -s "$dir/$folder$name.png" ]; then
            echo "picture: $dir/$folder$name.png"
            echo "<p><img src=\"$folder$name.png\" alt=\"$name\"></p>" >>"$page"
        else
            echo "picture missing: $dir/$folder$name.png" >&2
            failed=$((failed + 1))
        fi
    done
}

links() # FILE...
{
    printf '<p>Files:' >>"$page"
    for file; do printf ' <a href="%s">%s</a>' "$file" "$file" >>"$page"; done
    echo '</p>' >>"$page"
}

cat >"$page" <<'END'
<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>exhand: the paper's experiments</title><style>
body { font-family: sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em }
img { max-width: 100% } td, th { padding: .2em .8em; text-align: right }
</style></head><body>
<h1>The paper's experiments on the simulated device</h1>
<p>Nothing here was measured on hardware. <code>make demo</code> wrote this page.</p>
END

part "1. Signals at rest (Table I)" \
    "Stable bits of joint angle, motor position and motor current. Bits: log2 of span over noise."
run table1 glove --selftest
sed -n '4,8p' "$dir/table1.txt"
judge "$dir/table1.txt" 'BEGIN { at["angle"] = 9; at["position"] = 11; at["current"] = 7 }
    /^  (joint angle|motor position|motor current) / { n++; same += $at[$2] == $NF }
    END { print (n == 3 && same == n), "bits equal the paper'"'"'s for " same + 0 " of " n + 0 \
        " signals" }'
run glove glove --record "$dir/glove.exh" --does poses --seconds 5
links table1.txt

part "2. Calibration" "Known masses on the string give force over current."
run calibration calibrate --out "$dir/calibration"
judge "$dir/calibration.txt" '/^force over current/ { s = $0 }
    END { print (s != ""), s == "" ? "no force constant" : s }'
pictures calibration pictures calibration
links calibration.txt calibration/calibration.csv calibration/table.csv

part "3. Falling mass (Table II)" \
    "A mass falls on the virtual wall. Does it rest, and how stiff is the wall?"
run table2 drop --out "$dir" --gates
sed -n '/^passed: /!p' "$dir/table2.txt"
sed -n 's/^passed: //p' "$dir/table2.txt" >"$dir/gates.txt"
while read -r gate; do verdict 1 "$gate"; done <"$dir/gates.txt"
{
    echo '<table><tr><th>rate, Hz<th>k, N/m<th>b, Ns/m<th>stiffness, N/m<th>95 % interval'
    echo '<th>paper, N/m<th>ours / paper</tr>'
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        { printf "<tr><td>%s<td>%s<td>%s<td>%.0f<td>%.0f..%.0f<td>%s<td>%.2f</tr>\n",
            $at["rate_hz"], $at["k_n_per_m"], $at["b_ns_per_m"], $at["stiffness_b_n_per_m"],
            $at["ci_low"], $at["ci_high"], $at["paper_n_per_m"], $at["ratio"] }' "$dir/table2.csv"
    echo '</table>'
} >>"$page"
pictures "" pictures force_position fall
links table2.txt table2.csv runs.csv

part "4. Stability map" \
    "Gains k and b at which half of the falls rest; then the same against friction."
run stability drop --out "$dir" --sweep --grid 8x3 --falls 3
judge "$dir/stability.txt" '$2 == "|" && $1 ~ /^[0-9]+$/ { n++; below += $3 >= $(NF - 1) }
    END { print (n == 6 && below == n), "the paper'"'"'s k is below the largest stable k at " \
        below + 0 " of " n + 0 " rates" }'
pictures "" sweep stability
links stability.txt stability.csv border.csv
run friction drop --out "$dir" --friction 5 --falls 3
judge "$dir/friction.csv" 'BEGIN { FS = "," } $1 == "all" && $3 == 0 { none[$2] = $4 + 0 }
    $1 == "all" && $3 == 2 { n++; more += $4 > none[$2] }
    END { print (n == 6 && more == n), "twice the friction allows larger gains than none at " \
        more + 0 " of " n + 0 " rates" }'
pictures "" friction friction
links friction.txt friction.csv

part "5. Bilateral contacts" "A finger meets a wall of the virtual world at three speeds."
run bilateral bilateral --out "$dir/bilateral"
judge "$dir/bilateral.txt" '/ approaches of / { n++; good += / 0 missed, 0 early, 0 late/ }
    END { print (n == 3 && good == n), "no contact missed, early or late at " \
        good + 0 " of " n + 0 " speeds" }'
pictures bilateral bilateral contact force
links bilateral.txt bilateral/contacts.csv

echo '</body></html>' >>"$page" && mv "$page" "$dir/index.html"
printf '\n%d passed, %d failed. Tables: %s/*.txt; all on one page: %s/index.html\n' \
    $passed $failed "$dir" "$dir"
if [ -t 1 ] && [ -n "${DISPLAY-}${WAYLAND_DISPLAY-}" ] && command -v xdg-open >/dev/null; then
    xdg-open "$dir/index.html" >/dev/null 2>&1 &
fi
[ $failed = 0 ]
