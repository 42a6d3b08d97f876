# SPDX-License-Identifier: MIT
# One contact over time, a column per speed, as the paper's time plot of a contact. Force commanded
# and force by the current monitor are above, velocity is below. A line is where contact begins.
#
#   gnuplot -e "files='bilateral_natural_index'; names='natural'; contacts='0.547'; ..." contact.gp
#
#   files        CSV files without their .csv, with the header
#                t_s,q_m,qd_m_per_s,f_des_n,i_des_a,c,f_mon_n,d_m,q_lim_m
#   names        what a column is called; fingers: whose contact it is
#   contacts     when it begins, s; -1: there was none
#   speeds       m/s at contact; settles: ms, -1 never
#   k, b, link   as they shall be printed; no k or no b: materials have their own
# Lists have spaces between their words. Optional:
#   out_contact  PNG to write                            (contact.png)
#   before_ms, after_ms   shown, before and after contact (10, 110)

if (!exists("out_contact")) out_contact = 'contact.png'
if (!exists("before_ms")) before_ms = 10
if (!exists("after_ms")) after_ms = 110

n = words(files)
width = 190.0 + 560*n
set terminal pngcairo size width,980 font 'DejaVu Sans,18' linewidth 1.6 background '#ffffff'
set output out_contact
set datafile separator ','

ink = '#333333'
set style line 1 lc rgb '#d55e00' pt 2 ps 0.8 lw 1.2   # force commanded
set style line 2 lc rgb '#0072b2' lw 2.2               # force by the monitor
set style line 3 lc rgb '#000000' lw 2.0               # velocity
set style line 4 lc rgb '#777777' lw 1.6 dt (7,5)               # contact begins

# The same axes in every column, or they could not be compared.
f_top = 1; v_top = 0.1; v_low = 0
do for [i = 1:n] {
    T0 = real(word(contacts, i))
    if (T0 < 0) { continue }
    shown(v) = column('t_s') > T0 - before_ms/1e3 && column('t_s') < T0 + after_ms/1e3 ? v : NaN
    stats word(files, i).'.csv' using (shown(column('f_des_n'))) name 'F' nooutput
    stats word(files, i).'.csv' using (shown(column('f_mon_n'))) name 'M' nooutput
    stats word(files, i).'.csv' using (shown(column('qd_m_per_s'))) name 'V' nooutput
    if (F_max > f_top) { f_top = F_max }
    if (M_max > f_top) { f_top = M_max }
    if (V_max > v_top) { v_top = V_max }
    if (V_min < v_low) { v_low = V_min }
}

set multiplot
set lmargin at screen 0; set rmargin at screen 1
set tmargin at screen 1; set bmargin at screen 0
unset border; unset tics; unset title
set xrange [0:1]; set yrange [0:1]
set label 1 '{/:Bold Force and velocity in bilateral contacts at each speed}' at screen 0.5, \
    screen 0.975 center textcolor rgb ink
set key at screen 0.5, screen 0.955 center top horizontal Left \
    reverse maxrows 1 samplen 1.6 width -1 \
    textcolor rgb ink
plot NaN with points ls 1 ps 1.4 title 'commanded force F_{des}', \
     NaN with lines ls 2 title 'force by the current monitor F_{mon}', \
     NaN with lines ls 3 title 'velocity', NaN with lines ls 4 title 'contact begins'
unset label 1; set key off
gains = k eq '' || b eq '' ? "the scene's own k and b" : \
    sprintf('k = %s N/m, b = %s Ns/m', k, b)
limit = f_top > 21.5 && f_top < 22.6 ? '; force ends at 22 N, the drive at its 6.6 A' : ''
set label 9 sprintf('%s, link: %s%s', gains, link, limit) at screen 0.5, \
    screen 0.872 center \
    noenhanced textcolor rgb ink font ',17'
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set xrange [-before_ms:after_ms]
set xtics nomirror 20
set ytics nomirror autofreq

do for [i = 1:n] {
    T0 = real(word(contacts, i))
    FILE = word(files, i).'.csv'
    ms = "(column('t_s') - T0)*1e3"
    set lmargin at screen (130.0 + 560*(i-1)) / width
    set rmargin at screen (130.0 + 560*(i-1) + 490) / width
    S = real(word(settles, i))
    set title sprintf("{/:Bold %s}, %s: %s m/s at contact\n%s", word(names, i), word(fingers, i), \
        word(speeds, i), T0 < 0 ? 'no contact' : S < 0 \
        ? 'F_{mon} does not settle to 5 %' : \
        sprintf('F_{mon} settles to 5 %% in %.0f ms', S)) \
        textcolor rgb ink offset 0,-0.6
    set arrow 1 from first 0, graph 0 to first 0, graph 1 nohead ls 4 front
    set tmargin at screen 0.775; set bmargin at screen 0.43
    set yrange [-0.04*f_top : 1.07*f_top]
    set format x ''
    unset xlabel
    if (i == 1) { set ylabel 'force (N)' textcolor rgb ink } else { unset ylabel }
    plot FILE using ((column('t_s') - T0)*1e3):(column('f_mon_n')) with lines ls 2, \
         FILE using ((column('t_s') - T0)*1e3):(column('f_des_n')) with points ls 1
    unset title; unset label 9
    set tmargin at screen 0.385; set bmargin at screen 0.10
    set yrange [v_low - 0.06*(v_top - v_low) : v_top + 0.08*(v_top - v_low)]
    set format x '%g'
    set xlabel 'time since contact (ms)' textcolor rgb ink
    if (i == 1) { set ylabel 'velocity (m/s)' textcolor rgb ink }
    plot FILE using ((column('t_s') - T0)*1e3):(column('qd_m_per_s')) with lines ls 3
}
unset multiplot
unset output
