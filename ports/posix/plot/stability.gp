# SPDX-License-Identifier: MIT
# The k-b plane at each loop rate: how many falls come to rest, and the border where half of them
# do, with its interval. Also the border of the exact linear test, and the paper's point.
#
#   gnuplot -e "cells='stability.csv'; border='border.csv'; rho='rho.csv'; ..." stability.gp
#
#   cells        rate_hz,...,k_n_per_m,b_ns_per_m,resting_falls,falls,...  (exhand-lab drop --sweep)
#   border       rate_hz,ray,k_n_per_m,b_ns_per_m,k_low_n_per_m,...: a point a ray
#   rho          rate,k,b,rho on a grid; two empty lines between rates, in order of rates
#   rates        Hz; k_tops, b_tops: ends of the axes, N/m and Ns/m, one per rate
#   paper_ks, paper_bs   the paper's point at each rate; -1 for none
# Lists have spaces between their words. Optional:
#   out          PNG to write                            (stability.png)

reset # another script may have run before
if (!exists("out")) out = 'stability.png'

panels = words(rates)
across = panels < 3 ? panels : 3
down = (panels + across - 1) / across
width = 120.0 + 480*across
height = 190.0 + 420*down
set terminal pngcairo size width,height font 'DejaVu Sans,18' linewidth 1.6 background '#ffffff'
set datafile separator ','

ink = '#333333'
set style line 1 lc rgb '#56b4e9' pt 7 ps 0.6             # at rest
set style line 2 lc rgb '#0072b2' pt 8 ps 1.0             # some of its falls at rest
set style line 3 lc rgb '#d55e00' pt 2 ps 0.8 lw 1.0      # oscillates
set style line 4 lc rgb '#000000' lw 3                    # simulated border
set style line 7 lc rgb '#333333' lw 1.2 dt (2,3)         # its interval
set style line 5 lc rgb '#cc79a7' lw 2.6 dt (9,4)         # rho = 1
set style line 6 lc rgb '#000000' pt 4 ps 2.2 lw 2.4      # the paper's point

# Contours first: they need a plot of their own.
do for [i = 1:panels] {
    set contour base; unset surface
    set cntrparam levels discrete 1
    set table sprintf('%s.%d.rho1', out, i)
    splot rho index (i-1) using 2:3:4 with lines
    unset table
    unset contour; set surface
}

set output out
set multiplot
set lmargin at screen 0; set rmargin at screen 1
set tmargin at screen 1; set bmargin at screen 0
unset border; unset tics
set xrange [0:1]; set yrange [0:1]
set label 1 '{/:Bold Gains at which a falling mass comes to rest, at each loop rate}' \
    at screen 0.5, screen 1 - 24/height center textcolor rgb ink
set key at screen 0.5, screen 1 - 44/height center top horizontal Left reverse maxrows 2 \
    samplen 2.4 width 1 textcolor rgb ink font ',15'
plot NaN with points ls 1 ps 1.6 title 'all falls rest', \
     NaN with points ls 2 ps 1.6 title 'some rest', \
     NaN with points ls 3 ps 1.2 title 'none rests', \
     NaN with lines ls 4 title 'border: half of the falls rest', \
     NaN with lines ls 7 title 'its 95 % interval', \
     NaN with lines ls 5 title 'border of the linear model', \
     NaN with points ls 6 title "the paper's gains"
unset label 1; set key off
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1

step(top) = (p = 10**floor(log10(top)), top/p > 5 ? 2*p : top/p > 2 ? p : p/2)
do for [i = 1:panels] {
    c = (i-1) % across; r = (i-1) / across
    set lmargin at screen (110.0 + 480*c) / width
    set rmargin at screen (110.0 + 480*c + 410) / width
    set tmargin at screen 1.0 - (120.0 + 420*r + 40) / height
    set bmargin at screen 1.0 - (120.0 + 420*r + 350) / height
    k_top = real(word(k_tops, i)) / 1e3
    b_top = real(word(b_tops, i))
    RATE = real(word(rates, i))
    set xrange [0:1.02*k_top]
    set yrange [0:1.03*b_top]
    set xtics step(k_top); set ytics step(b_top)
    set title '{/:Bold '.word(rates, i).' Hz}' textcolor rgb ink offset 0,-0.6
    if (r == down - 1 || i + across > panels) { set xlabel 'stiffness k (kN/m)' textcolor rgb ink
    } else { unset xlabel }
    if (c == 0) { set ylabel 'damping b (Ns/m)' textcolor rgb ink } else { unset ylabel }
    mine(v) = column('rate_hz') == RATE ? v : NaN
    blank(n) = real(word(strcol(1), n)) # gnuplot's own tables have no commas
    all(v) = mine(column('resting_falls') == column('falls') ? v : NaN)
    rest(x) = column('resting_falls')
    some(v) = rest(0) > 0 && rest(0) < column('falls') ? mine(v) : NaN
    none(v) = mine(column('resting_falls') == 0 ? v : NaN)
    pk = real(word(paper_ks, i)); pb = real(word(paper_bs, i))
    set label 1 '' at (pk < 0 ? NaN : pk/1e3), pb point ls 6 front
    plot cells using (column('k_n_per_m')/1e3):(none(column('b_ns_per_m'))) with points ls 3, \
         cells using (column('k_n_per_m')/1e3):(some(column('b_ns_per_m'))) with points ls 2, \
         cells using (column('k_n_per_m')/1e3):(all(column('b_ns_per_m'))) with points ls 1, \
         sprintf('%s.%d.rho1', out, i) using (blank(1)/1e3):(blank(2)) with lines ls 5, \
         border using (column('k_low_n_per_m')/1e3):(mine(column('b_low_ns_per_m'))) \
             with lines ls 7, \
         border using (column('k_high_n_per_m')/1e3):(mine(column('b_high_ns_per_m'))) \
             with lines ls 7, \
         border using (column('k_n_per_m')/1e3):(mine(column('b_ns_per_m'))) with lines ls 4
    unset label 1
}
unset multiplot
unset output
do for [i = 1:panels] { system sprintf("rm -f '%s.%d.rho1'", out, i) }
