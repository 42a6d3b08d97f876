# SPDX-License-Identifier: MIT
# Error of low-passes over fc/fs: rms above, peak below; a column an input.
width = 1500; height = 1130
load here.'/style.gp'
set multiplot
set logscale xy
set xrange [7e-6:0.6]; set yrange [3e-10:2e7]
set xtics ('10^{-5}' 1e-5, '10^{-4}' 1e-4, '10^{-3}' 1e-3, '0.01' 0.01, '0.1' 0.1, '0.45' 0.45) \
    font ',16'
set ytics 1e-8,100 font ',16'
inputs = 'step square noise'
array what[3] = ['step to 0.37', 'square wave, full scale', 'white noise, full scale']
array of[2] = ['rms', 'peak']
array name[9] = ['CMSIS df1_q31', 'CMSIS 32x64 b1 adj.', 'CMSIS df1_q31 x/4', 'idsp DF1Dither', \
    'idsp Lowpass<2>', 'plain float DF2T', 'plain double DF2T', \
    'exhand-cheap', 'exhand']
array mark[9] = [5, 9, 4, 11, 13, 6, 12, 6, 7]
array shade[9] = ['#d07800', '#d07800', '#f0b060', '#8a4f00', '#8a4f00', float_colour, \
    float_colour, ours_colour, ours_colour]
value_of(i, m, k) = (strcol('input') eq word(inputs, i) && strcol('measure') eq m) \
    ? column(name[k]) : NaN
do for [m = 1:2] {
    do for [i = 1:3] {
        set lmargin at screen 0.075 + 0.312*(i - 1)
        set rmargin at screen 0.075 + 0.312*(i - 1) + 0.285
        set tmargin at screen 0.955 - 0.425*(m - 1)
        set bmargin at screen 0.955 - 0.425*(m - 1) - 0.345
        set format y (i == 1 ? '10^{%T}' : '')
        set title what[i] font 'DejaVu Sans Bold,18' textcolor rgb ink offset 0,-0.6
        set xlabel (m == 2 ? 'fc/fs' : '') textcolor rgb ink offset 0,0.4
        set ylabel (i == 1 ? of[m].' error, ppm' : '') textcolor rgb ink
        if (m == 2 && i == 3) { set key at screen 0.5,0.045 center center maxrows 3 samplen 1.5 \
            width -1 Left reverse noenhanced } else { unset key }
        plot for [k = 1:9] data using 'fc_fs':(value_of(i, m == 1 ? 'rms' : 'max', k)) \
            with linespoints lw (k == 9 ? 3 : 1.5) pt mark[k] ps (k == 9 ? 1.4 : 1) \
            lc rgb shade[k] title name[k]
    }
}
unset multiplot
unset output
