# SPDX-License-Identifier: MIT
# Faults of a motor, with the limiter and without: a row a case, position and torque.
#
#   gnuplot -e "csv='motor.csv'; out='motor.png'" motor.gp

reset
if (!exists("csv")) csv = 'motor.csv'
if (!exists("out")) out = 'motor.png'
set terminal pngcairo size 1600,1200 font 'DejaVu Sans,16' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','
set multiplot layout 3,2
set xlabel 'time, s'
set grid
cases = "jump stall silence"
t(name, limited, is, with, t_s) = is eq name && with == limited ? t_s : 1/0
do for [name in cases] {
    set title name
    set ylabel 'position, rad'
    set yrange [-1.5:3.2]
    set key bottom left
    plot csv using (t(name, 0, strcol(1), $2, $3)):4 with lines lc '#999999' dt 2 title 'target', \
         '' using (t(name, 0, strcol(1), $2, $3)):5 with lines lc '#d62728' title 'bare', \
         '' using (t(name, 1, strcol(1), $2, $3)):5 with lines lc '#1f77b4' title 'limited'
    set ylabel 'torque, N m'
    set yrange [*:*]
    set key top left
    plot csv using (t(name, 0, strcol(1), $2, $3)):7 with lines lc '#d62728' title 'bare', \
         '' using (t(name, 1, strcol(1), $2, $3)):7 with lines lc '#1f77b4' title 'limited'
}
unset multiplot
