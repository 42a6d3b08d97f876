# SPDX-License-Identifier: MIT
# The gains that are allowed at each loop rate, over a simulated map, with the rule of the target.
#
#   gnuplot -c gains.gp PLOTS        in a directory of `exhand-lab advise gains --out`
#
#   allowed.csv  rate_hz, b_low, b_high, k_low, k_high: boxes where every fall of the model rests
#   rule.csv     rate_hz, knot, b, k, k_min
#   map.csv      rate_hz, k, b, resting_falls, falls (with has_map=1)
#   rates        Hz; k_tops, b_tops: ends of the axes; paper_ks, paper_bs: the paper's point, -1 for
#   none
# Lists have spaces between their words. Optional:
#   out          PNG to write                            (gains.png)

reset # another script may have run before
if (!exists("out")) out = 'gains.png'

panels = words(rates)
across = panels < 3 ? panels : 3
down = (panels + across - 1) / across
width = 130.0 + 600*across
top = across == 1 && has_map ? 260.0 : across == 2 ? 190.0 : 150.0 # of the key
height = 70.0 + top + 520*down
set terminal pngcairo size width,height font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set datafile separator ','

ink = '#333333'
set style line 1 lc rgb '#0072b2' pt 7 ps 0.7             # at rest
set style line 2 lc rgb '#e69f00' pt 9 ps 1.2             # most of its falls at rest
set style line 3 lc rgb '#d55e00' pt 2 ps 0.6 lw 1.0      # unstable
set style line 4 lc rgb '#dddddd'                         # allowed
set style line 5 lc rgb '#000000' lw 3.0                  # the rule
set style line 6 lc rgb '#000000' pt 4 ps 2.2 lw 2.4      # the paper's point
set style fill solid 1.0 noborder

set output out
set multiplot
set lmargin at screen 0; set rmargin at screen 1
set tmargin at screen 1; set bmargin at screen 0
unset border; unset tics
set xrange [0:1]; set yrange [0:1]
set label 1 '{/:Bold Allowed gains, beside the gains at which simulated falls rest}' at \
    screen 0.5, screen 1 - 24/height center textcolor rgb ink
set key at screen 0.52, screen 1 - 46/height center top horizontal Left reverse maxrows 2 \
    samplen 2.4 width 1 textcolor rgb ink
plot NaN with boxes ls 4 title 'model: all falls rest', \
     NaN with lines ls 5 title 'allowed by the rule, inside', \
     NaN with points ls 6 title "the paper's gains", \
     NaN with points ls 1 ps 1.6 title has_map ? 'simulated: all falls rest' : '', \
     NaN with points ls 2 ps 1.6 title has_map ? 'simulated: 90 % or more rest' : '', \
     NaN with points ls 3 ps 1.2 title has_map ? 'simulated: fewer rest' : ''
unset label 1; set key off
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink

boxes = "'allowed.csv' using (mine((column('k_low_n_per_m')+column('k_high_n_per_m'))/2e3)):". \
        "((column('b_low_ns_per_m')+column('b_high_ns_per_m'))/2):". \
        "(column('k_low_n_per_m')/1e3):(column('k_high_n_per_m')/1e3):". \
        "(column('b_low_ns_per_m')):(column('b_high_ns_per_m')) with boxxyerror ls 4, ". \
        "'rule.csv' using (mine(column('k_n_per_m')/1e3)):(column('b_ns_per_m')) with lines ls 5"
dots(how, ls) = sprintf("'map.csv' using (column('k_n_per_m')/1e3):". \
    "(%s(column('b_ns_per_m'))) with points ls %d", how, ls)
cells = dots('none', 3).', '.dots('some', 2).', '.dots('all', 1)

step(top) = (p = 10**floor(log10(top)), top/p > 5 ? 2*p : top/p > 2 ? p : p/2)
do for [i = 1:panels] {
    c = (i-1) % across; r = (i-1) / across
    set lmargin at screen (130.0 + 600*c) / width
    set rmargin at screen (130.0 + 600*c + 510) / width
    set tmargin at screen 1.0 - (top + 520*r + 40) / height
    set bmargin at screen 1.0 - (top + 520*r + 440) / height
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
    all(v) = mine(column('resting_falls') == column('falls') ? v : NaN)
    some(v) = mine(column('resting_falls') < column('falls') && 10*column('resting_falls') >= \
        9*column('falls') ? v : NaN)
    none(v) = mine(10*column('resting_falls') < 9*column('falls') ? v : NaN)
    pk = real(word(paper_ks, i)); pb = real(word(paper_bs, i))
    set label 1 '' at (pk < 0 ? NaN : pk/1e3), pb point ls 6 front
    eval 'plot '.boxes.(has_map ? ', '.cells : '')
    unset label 1
}
unset multiplot
unset output
