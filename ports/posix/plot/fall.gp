# SPDX-License-Identifier: MIT
# One fall over time, a row per loop rate: how the system stops the mass, and that
# it comes to rest. Wide panels show the first 0.3 s after contact, narrow ones the
# whole observation; a pair of them shares its vertical axis.
#
#   gnuplot -e "out='fall.png'; files='90.csv 100.csv'; rates='90 100'; ..." fall.gp
#
#   files        CSV logs of one fall each, with the header
#                t_s,q_m,qd_m_per_s,f_des_n,i_des_a,c,f_mon_n
#   rates        Hz, one per file; ks: N/m; bs: Ns/m
#   stiffnesses  N/m as they shall be printed, one per file; '-' for none
# All are lists with spaces between their words. Optional:
#   out          PNG to write                            (fall.png)
#   q_lims       positions of the virtual contact, m, one a file  (0)
#   zoom_s       length of the wide panels, s             (0.3)
#   observe_s    length of the observation, s             (5)
#   q_top_mm, f_top_N   tops of the axes                  (from the data)

reset # another script may have run before
if (!exists("out")) out = 'fall.png'
if (!exists("q_lims")) q_lims = ""
q_lim(i) = words(q_lims) >= i ? real(word(q_lims, i)) : 0
if (!exists("zoom_s")) zoom_s = 0.3
if (!exists("observe_s")) observe_s = 5

rows = words(files)
set terminal pngcairo size 2000,190+330*rows font 'DejaVu Sans,20' linewidth 1.6 \
    background '#ffffff'
set output out
set datafile separator ','

ink = '#333333'
set style line 1 lc rgb '#1f5fbf' lw 1.8                # position
set style line 2 lc rgb '#555555' lw 1.4 dt (8,5)        # virtual contact
set style line 3 lc rgb '#f0a060' lw 1.8                 # commanded force
set style line 4 lc rgb '#c03028' lw 1.2                 # monitored force

# The same axes in every row, or the rows could not be compared.
q_low = 0; q_high = 0; f_high = 0
do for [i = 1:rows] {
    FILE = word(files, i)
    stats FILE using ((column('q_m') - q_lim(i))*1e3) name 'Q' nooutput
    stats FILE using (column('f_mon_n')) name 'F' nooutput
    stats FILE using (column('f_des_n')) name 'D' nooutput
    if (Q_max > q_high) { q_high = Q_max }
    if (F_max > f_high) { f_high = F_max }
    if (D_max > f_high) { f_high = D_max }
}
if (!exists("q_top_mm")) q_top_mm = 1.08 * q_high
if (!exists("f_top_N")) f_top_N = 1.08 * f_high
q_bottom_mm = -0.35 * q_top_mm
f_bottom_N = -0.04 * f_top_N
step(top) = top > 50 ? 20 : top > 20 ? 10 : top > 8 ? 5 : top > 4 ? 2 : top > 2 ? 1 : 0.5
q_step_mm = step(1.35 * q_top_mm)
f_step_N = step(f_top_N)

# Columns as shares of the width: position wide, narrow, force wide, narrow.
left(c)  = c == 0 ? 0.062 : c == 1 ? 0.368 : c == 2 ? 0.566 : 0.872
right(c) = c == 0 ? 0.344 : c == 1 ? 0.486 : c == 2 ? 0.848 : 0.990
# Rows: 100 px above them for the key, 90 px below; 330 px each, 62 px of it heading.
px = 190.0 + 330*rows
row_top(i)    = 1.0 - (100.0 + 330*(i-1) + 62) / px
row_bottom(i) = 1.0 - (100.0 + 330*i - 16) / px

set multiplot
set key off

# The key of all panels, from one empty plot.
set lmargin at screen 0; set rmargin at screen 1
set tmargin at screen 1; set bmargin at screen 0
unset border; unset tics
set xrange [0:1]; set yrange [0:1]
set key at screen 0.525, screen 1.0-26.0/px center top horizontal Left reverse maxrows 1 \
    samplen 2.2 width 1 textcolor rgb ink
plot NaN with lines ls 1 title 'position q', NaN with lines ls 2 title 'virtual contact q_{lim}', \
     NaN with lines ls 3 title 'commanded force F_{des}', \
     NaN with lines ls 4 title 'monitored force F_{mon}'
set key off
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1

do for [i = 1:rows] {
    FILE = word(files, i)
    undefine C_* # of the row before
    stats FILE using (column('c') > 0 ? column('t_s') : NaN) name 'C' nooutput
    T0 = exists("C_min") ? C_min : 0 # a mass that never touches keeps the log's time
    S = word(stiffnesses, i)
    HEAD = sprintf('{/:Bold %s Hz}   k = %s N/m, b = %s Ns/m,  %s', word(rates, i), word(ks, i), \
        word(bs, i), S eq '-' ? 'no stiffness' : 'measured stiffness '.S.' N/m')
    set label 1 HEAD at screen left(0), screen row_top(i) + 26.0/px left textcolor rgb ink
    set tmargin at screen row_top(i)
    set bmargin at screen row_bottom(i)
    do for [c = 0:3] {
        set lmargin at screen left(c)
        set rmargin at screen right(c)
        unset xlabel; unset ylabel
        if (c % 2 == 0) {
            set xrange [-zoom_s/6.0:zoom_s]
            set xtics nomirror zoom_s/3.0
        } else {
            set xrange [0:observe_s]
            set xtics nomirror ceil(observe_s/3.0)
        }
        if (c < 2) { set yrange [q_bottom_mm:q_top_mm] } else { set yrange [f_bottom_N:f_top_N] }
        if (c < 2) { set ytics nomirror q_step_mm } else { set ytics nomirror f_step_N }
        if (c % 2 == 0) { set format y '%g' } else { set format y '' }
        if (i < rows) { set format x '' } else { set format x '%g' }
        if (i == rows && c % 2 == 0) { set xlabel 'time since contact (s)' textcolor rgb ink }
        if (i == rows && c % 2 == 1) { set xlabel 'whole fall (s)' textcolor rgb ink }
        if (c == 0) { set ylabel 'q (mm)' textcolor rgb ink }
        if (c == 2) { set ylabel 'F (N)' textcolor rgb ink }
        if (c < 2) {
            plot FILE using (column('t_s') - T0):((column('q_m') - q_lim(i))*1e3) with steps ls 1, \
                 0 with lines ls 2
        } else {
            plot FILE using (column('t_s') - T0):(column('f_des_n')) with steps ls 3, \
                 FILE using (column('t_s') - T0):(column('f_mon_n')) with lines ls 4
        }
        unset label 1
    }
}
unset multiplot
unset output
