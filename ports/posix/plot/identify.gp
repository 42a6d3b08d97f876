# SPDX-License-Identifier: MIT
# A round of identify: the string as measured and as the model moves it, what is between them, and
# the current. Above the free rotor, below the known mass.
#
#   gnuplot -e "out='identify.png'; trace='trace.csv'" identify.gp
#
#   trace   CSV: stage,t_s,part,current_a,measured_mm,modelled_mm,apart_mm
# Optional: out, the PNG to write (identify.png)

reset # another script may have run before
if (!exists("out")) out = 'identify.png'
set terminal pngcairo size 1500,1300 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','

ink = '#333333'
set style line 1 lc rgb '#1f5fbf' lw 3.0
set style line 2 lc rgb '#d62728' lw 1.2
set style line 3 lc rgb '#777777' lw 1.0
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.6 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set lmargin at screen 0.10; set rmargin at screen 0.97
of(stage, y) = (column('stage') == stage ? y : NaN)
ten(span) = 10.0**floor(log10(span))
tics_of(span) = ten(span)*(span > 4*ten(span) ? 2 : span > 2*ten(span) ? 1 : 0.5) # 2 to 5 of them

set multiplot
set key at screen 0.97, screen 0.985 right top horizontal samplen 2 textcolor rgb ink
set ylabel offset 1,0
do for [stage = 0:1] {
    high = stage == 0 ? 0.93 : 0.655
    set tmargin at screen high; set bmargin at screen high - (stage == 0 ? 0.16 : 0.27)
    set title (stage == 0 ? 'A pulse, nothing on the string' : 'A round with the known mass') \
        textcolor rgb ink offset 0,-0.5
    set ylabel 'string in (mm)' textcolor rgb ink
    set format x (stage == 0 ? '%g' : '')
    if (stage == 0) { set xlabel 'time (s)' textcolor rgb ink offset 0,0.5 } else { unset xlabel }
    stats trace using (of(stage, column('t_s'))) name 'T' nooutput
    set xrange [0 : T_max]
    plot trace using (column('t_s')):(of(stage, column('measured_mm'))) with lines ls 1 \
             title 'measured', \
         trace using (column('t_s')):(of(stage, column('modelled_mm'))) with lines ls 2 \
             title 'modelled'
    unset key
}
unset title
set tmargin at screen 0.365; set bmargin at screen 0.235
set ylabel 'apart (mm)' textcolor rgb ink
stats trace using (of(1, column('apart_mm'))) name 'A' nooutput
if (A_max > A_min) { set ytics tics_of(A_max - A_min) }
plot trace using (column('t_s')):(of(1, column('apart_mm'))) with lines ls 3
set tmargin at screen 0.215; set bmargin at screen 0.075
set ytics autofreq
set ylabel 'current (A)' textcolor rgb ink
set format x '%g'
set xlabel 'time (s)' textcolor rgb ink offset 0,0.5
plot trace using (column('t_s')):(of(1, column('current_a'))) with lines ls 1
unset multiplot
