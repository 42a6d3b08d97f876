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

set terminal pngcairo size 2000,900 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','

ink = '#333333'
array colour[6] = ['#7a1fa2', '#c2185b', '#e67e00', '#8a8d00', '#1a8f2e', '#1f5fbf']
tint(i) = colour[(i-1) % 6 + 1]
low = 0.08

set multiplot
set lmargin at screen 0; set rmargin at screen 1
set tmargin at screen 1; set bmargin at screen 0
unset border; unset tics
set xrange [0:1]; set yrange [0:1]
set key at screen 0.52, screen 0.985 center top horizontal Left reverse maxrows 2 samplen 2.4 \
    width 2 textcolor rgb ink
plot for [i = 1:words(rates)] NaN with linespoints lc rgb tint(i) lw 2.2 pt 7 ps 1.4 \
         title word(rates, i).' Hz', \
     NaN with lines lc rgb '#777777' lw 1.4 dt (7,5) title 'linear, {/Symbol r} = 1', \
     NaN with lines lc rgb '#777777' lw 1.2 title 'bars: 95 % interval', \
     NaN with points lc rgb '#777777' pt 10 ps 1.8 title 'at rest at no gain tried'
set key off
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set logscale y
set xrange [-0.04:2.04]; set yrange [low:12]
set xtics 0.5
set ytics (0.1, 0.2, 0.5, 1, 2, 5, 10)
set tmargin at screen 0.80; set bmargin at screen 0.13
set xlabel 'friction, times that of the device' textcolor rgb ink

heads = '"all friction" "dry friction alone" "viscous friction alone"'
do for [c = 0:2] {
    KIND = word('all dry viscous', c + 1)
    set lmargin at screen 0.065 + 0.315*c
    set rmargin at screen 0.065 + 0.315*c + 0.285
    set title '{/:Bold '.word(heads, c + 1).'}' textcolor rgb ink offset 0,-0.6
    if (c == 0) {
        set ylabel "gains where half of the falls rest, times paper's" textcolor rgb ink
        set format y '%g'
    } else {
        unset ylabel
        set format y ''
    }
    here(i, v) = strcol('friction') eq KIND && column('rate_hz') == real(word(rates, i)) ? v : NaN
    set arrow 1 from -0.04,1 to 2.04,1 nohead lc rgb '#999999' lw 1
    plot for [i = 1:words(rates)] data \
             using (here(i, column('times'))):(column('gain_linear') > low ? column('gain_linear') \
             : NaN) \
             with lines lc rgb tint(i) lw 1.2 dt (7,5), \
         for [i = 1:words(rates)] data using (here(i, column('times'))): \
             (valid(4) ? column('gain') : NaN):(column('gain_low')):(column('gain_high')) \
             with yerrorbars lc rgb tint(i) lw 1.2 pt 0, \
         for [i = 1:words(rates)] data using (here(i, column('times'))): \
             (valid(4) ? column('gain') : NaN) with linespoints lc rgb tint(i) lw 2.2 pt 7 ps 1.2, \
         for [i = 1:words(rates)] data using (here(i, column('times')) + 0.012*(i - 3.5)): \
             (valid(4) ? NaN : 0.092) with points lc rgb tint(i) pt 10 ps 1.6
}
unset multiplot
unset output
