# SPDX-License-Identifier: MIT
# Largest error of whole ticks over the loop's rate: fixed point, double and float.
width = 1600; height = 1000
load here.'/style.gp'
set multiplot
set logscale xy
set format y '10^{%T}'
set xrange [70:26000]
set xtics ('90' 90, '200' 200, '500' 500, '2k' 2000, '5k' 5000, '20k' 20000) font ',15'
set ytics font ',15'
set key at screen 0.5, screen 0.985 center top maxrows 1 Left reverse samplen 2 textcolor rgb ink
scenes = 'minimal drop guarded bilateral guarded glove glove bilateral'
kinds = 'force force force force energy joints fingertips fingertips'
units = 'N N N N J rad m m'
mine(c, k) = (stringcolumn('scene') eq word(scenes, k) && stringcolumn('quantity') eq word(kinds, \
    k)) ? column(c) : NaN
do for [k = 1:8] {
    c = (k - 1) % 4; r = (k - 1)/4
    set lmargin at screen 0.078 + 0.236*c
    set rmargin at screen 0.078 + 0.236*c + 0.18
    set tmargin at screen 0.89 - 0.46*r
    set bmargin at screen 0.89 - 0.46*r - 0.34
    set title sprintf('%s: %s (%s)', word(scenes, k), word(kinds, k), word(units, k)) \
        font 'DejaVu Sans Bold,16' textcolor rgb ink offset 0,-0.6
    set xlabel (r == 1 ? 'rate of the loop (Hz)' : '') font ',16' textcolor rgb ink
    if (k == 1) { set label 1 'peak error against long double' at screen 0.014, \
        screen 0.47 center rotate textcolor rgb ink } else { unset label 1 }
    plot data using 'rate_hz':(mine('float', k)) with linespoints lw 2 pt 6 ps 1.5 \
        lc rgb float_colour title (k == 1 ? 'plain float' : ''), \
         '' using 'rate_hz':(mine('double', k)) with linespoints lw 2 dt (6,4) pt 4 ps 1.4 \
         lc rgb float_colour title (k == 1 ? 'plain double' : ''), \
         '' using 'rate_hz':(mine('fixed', k)) with linespoints lw 2.4 pt 7 ps 1.5 \
         lc rgb ours_colour title (k == 1 ? 'exhand, fixed point' : '')
    unset key
}
unset multiplot
unset output
