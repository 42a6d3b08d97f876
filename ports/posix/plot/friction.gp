# SPDX-License-Identifier: MIT
# The stability border against friction: how far both of the paper's gains may be raised
# until the falls no longer come to rest. Panels: all friction, dry alone, viscous alone.
#
#   gnuplot -e "data='friction.csv'; rates='90 100 ...'" friction.gp
#
#   data         friction,rate_hz,times,gain,gain_low,gain_high,open,gain_linear
#                (exhand-lab drop --friction); gain empty: at rest at no gain tried; open 1: at
#                rest at the last gain that the scene takes
#   rates        Hz, spaces between them
# Optional:
#   out          PNG to write                            (friction.png)

reset # another script may have run before
if (!exists("out")) out = 'friction.png'

set terminal pngcairo size 1600,860 font 'DejaVu Sans,18' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','

ink = '#333333'
# Marks differ too, for grey print.
array colour[6] = ['#000000', '#d55e00', '#0072b2', '#009e73', '#cc79a7', '#e69f00']
array mark[6] = [7, 5, 9, 4, 6, 8]
tint(i) = colour[(i-1) % 6 + 1]
sign(i) = mark[(i-1) % 6 + 1]
low = 0.08

set multiplot
set lmargin at screen 0; set rmargin at screen 1
set tmargin at screen 1; set bmargin at screen 0
unset border; unset tics
set xrange [0:1]; set yrange [0:1]
set label 1 '{/:Bold Gains at which a falling mass comes to rest, against friction}' \
    at screen 0.5, screen 0.965 center textcolor rgb ink
set key at screen 0.5, screen 0.925 center top horizontal Left reverse maxrows 1 samplen 2.4 \
    width 1 textcolor rgb ink
plot for [i = 1:words(rates)] NaN with linespoints lc rgb tint(i) lw 2 pt sign(i) ps 1.5 \
         title word(rates, i).' Hz'
set key off
set label 1 'bars: 95 % interval; marks at the foot: no gain tried lets the mass rest' \
    at screen 0.5, screen 0.845 center textcolor rgb ink font ',15'
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set logscale y
set xrange [-0.06:2.06]; set yrange [low:12]
set xtics 0.5
set ytics (0.1, 0.2, 0.5, 1, 2, 5, 10)
set tmargin at screen 0.76; set bmargin at screen 0.13
set xlabel "friction / the device's friction" textcolor rgb ink

heads = '"all friction" "dry friction alone" "viscous friction alone"'
do for [c = 0:2] {
    KIND = word('all dry viscous', c + 1)
    set lmargin at screen 0.075 + 0.312*c
    set rmargin at screen 0.075 + 0.312*c + 0.285
    set title '{/:Bold '.word(heads, c + 1).'}' textcolor rgb ink offset 0,-0.6
    if (c == 0) {
        set ylabel "gain / the paper's gain, half of the falls rest" textcolor rgb ink
        set format y '%g'
    } else {
        unset ylabel
        set format y ''
    }
    here(i, v) = strcol('friction') eq KIND && column('rate_hz') == real(word(rates, i)) ? v : NaN
    set arrow 1 from -0.06,1 to 2.06,1 nohead lc rgb '#777777' lw 1.4
    plot for [i = 1:words(rates)] data using (here(i, column('times'))): \
             (valid(4) ? column('gain') : NaN):(column('gain_low')):(column('gain_high')) \
             with yerrorbars lc rgb tint(i) lw 1 pt 0, \
         for [i = 1:words(rates)] data using (here(i, column('times'))): \
             (valid(4) ? column('gain') : NaN) with linespoints lc rgb tint(i) lw 2 \
             pt sign(i) ps 1.5, \
         for [i = 1:words(rates)] data using (here(i, column('times')) + 0.02*(i - 3.5)): \
             (valid(4) ? NaN : 0.092) with points lc rgb tint(i) pt sign(i) ps 1.4
    unset label 1
}
unset multiplot
unset output
