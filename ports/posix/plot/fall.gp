# SPDX-License-Identifier: MIT
# Position of the falling mass over time, a panel per loop rate: how deep it falls past the virtual
# contact, where it comes to rest, and when.
#
#   gnuplot -e "out='fall.png'; files='90.csv 100.csv'; rates='90 100'; ..." fall.gp
#
#   files        CSV logs of one fall each, with the header
#                t_s,q_m,qd_m_per_s,f_des_n,i_des_a,c,f_mon_n
#   rates        Hz, one per file; ks: N/m; bs: Ns/m
# All are lists with spaces between their words. Optional:
#   out          PNG to write                            (fall.png)
#   q_lims       positions of the virtual contact, m, one a file  (0)
#   zoom_s       length of the panels, s                  (1)
#   observe_s    length of the observation, s             (5)
#   rest_mm      a mass that stays within this rests      (0.2)

reset # another script may have run before
if (!exists("out")) out = 'fall.png'
if (!exists("q_lims")) q_lims = ""
q_lim(i) = words(q_lims) >= i ? real(word(q_lims, i)) : 0
if (!exists("zoom_s")) zoom_s = 1
if (!exists("observe_s")) observe_s = 5
if (!exists("rest_mm")) rest_mm = 0.2

panels = words(files)
across = panels < 3 ? panels : 3
down = (panels + across - 1) / across
width = 130.0 + 480*across
height = 130.0 + 400*down
set terminal pngcairo size width,height font 'DejaVu Sans,18' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','
ink = '#333333'
past(i) = (column('q_m') - q_lim(i))*1e3

# The same axes in every panel, or the panels could not be compared.
q_high = 1
do for [i = 1:panels] {
    stats word(files, i) using (past(i)) name 'Q' nooutput
    if (Q_max > q_high) { q_high = Q_max }
}
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set xrange [-0.05*zoom_s:zoom_s]
set yrange [-0.5*q_high:1.1*q_high]
set xtics zoom_s/4.0
set key off

set multiplot
set label 1 '{/:Bold Depth of the falling mass in the wall, at each loop rate}' at screen 0.5, \
    screen 1 - 26/height center textcolor rgb ink
set label 2 'depth is the position past the virtual contact, which the dashed line shows' \
    at screen 0.5, screen 1 - 56/height center textcolor rgb ink font ',15'
do for [i = 1:panels] {
    FILE = word(files, i)
    c = (i-1) % across; r = (i-1) / across
    undefine C_* R_*
    stats FILE using (column('c') > 0 ? column('t_s') : NaN) name 'C' nooutput
    T0 = exists("C_min") ? C_min : 0 # a mass that never touches keeps the log's time
    stats FILE using (column('t_s') > T0 + 0.9*observe_s ? past(i) : NaN) name 'E' nooutput
    END = exists("E_median") ? E_median : NaN
    stats FILE using (abs(past(i) - END) > rest_mm ? column('t_s') - T0 : NaN) name 'R' nooutput
    WHEN = exists("R_max") ? R_max : NaN
    set lmargin at screen (110.0 + 480*c) / width
    set rmargin at screen (110.0 + 480*c + 430) / width
    set tmargin at screen 1 - (100.0 + 400*r + 60) / height
    set bmargin at screen 1 - (100.0 + 400*r + 330) / height
    set title sprintf("{/:Bold %s Hz}, k = %s N/m, b = %s Ns/m\n%s", word(rates, i), word(ks, i), \
        word(bs, i), WHEN < 0.9*observe_s ? sprintf('rests %.1f mm deep after %.1f s', END, WHEN) \
        : 'does not rest') textcolor rgb ink font ',16' offset 0,-0.4
    if (i + across > panels) { set xlabel 'time since contact (s)' textcolor rgb ink
    } else { unset xlabel }
    if (c == 0) { set ylabel 'depth (mm)' textcolor rgb ink } else { unset ylabel }
    plot 0 with lines lc rgb ink lw 1.6 dt (7,5), \
         FILE using (column('t_s') - T0):(past(i)) with steps lc rgb '#0072b2' lw 2.2
    unset label
}
unset multiplot
unset output
