# SPDX-License-Identifier: MIT
# What a scene costs on each port: four panels of bars, cost.csv (scene, port, text, data, bss,
# stack, instructions).
width = 1500
height = 1050
load here.'/style.gp'
set multiplot
set logscale y
set style fill solid 1.0 noborder
set boxwidth 0.26
set xrange [0.5:7.5]
unset grid
set grid ytics lc rgb '#dddddd' lw 0.6
set xtics ('minimal' 1, 'drop' 2, 'guarded' 3, 'glove' 4, 'bilateral' 5, 'bringup' 6, \
    'calibrate' 7) font ',14' scale 0
set ytics font ',14'
place(s) = s eq 'minimal' ? 1 : s eq 'drop' ? 2 : s eq 'guarded' ? 3 : s eq 'glove' ? 4 \
    : s eq 'bilateral' ? 5 : s eq 'bringup' ? 6 : s eq 'calibrate' ? 7 : NaN
array port[3] = ['posix', 'pc104', 'mps2']
array colour[3] = ['#9bb8e3', '#1f5fbf', '#d07800']
array what[4] = ['code and constants, B', 'memory, B', 'worst stack, B', 'instructions per tick']
array low[4] = [3000., 100., 300., 500.]
array high[4] = [600000., 5e7, 10000., 30000.]
value_of(k) = k == 1 ? column('text_B') : k == 2 ? column('data_B') + column('bss_B') : k == 3 \
    ? column('stack_B') : column('insn_per_tick')
short(v) = v < 9999.5 ? sprintf('%.0f', v) : v < 99950 ? sprintf('%.1fk', v/1e3) : v < 999500 \
    ? sprintf('%.0fk', v/1e3) : sprintf('%.1fM', v/1e6)
do for [k = 1:4] {
    set lmargin at screen ((k - 1) % 2 == 0 ? 0.055 : 0.555)
    set rmargin at screen ((k - 1) % 2 == 0 ? 0.49 : 0.99)
    set tmargin at screen (k < 3 ? 0.90 : 0.445)
    set bmargin at screen (k < 3 ? 0.54 : 0.05)
    set yrange [low[k]:high[k]]
    set format y '10^{%T}'
    set title what[k] font 'DejaVu Sans Bold,17' offset 0,-0.5
    unset key
    plot for [p = 1:3] data using (stringcolumn('port') eq port[p] ? place(stringcolumn('scene')) \
        + 0.28*(p - 2) : NaN):(value_of(k)) with boxes lc rgb colour[p], \
         for [p = 1:3] '' using (stringcolumn('port') eq port[p] ? place(stringcolumn('scene')) + \
         0.28*(p - 2) : NaN):(value_of(k)*1.08):(short(value_of(k))) \
             with labels rotate by 90 left font ',13' textcolor rgb ink
}
unset logscale; unset border; unset tics; unset title; unset grid
set lmargin at screen 0; set rmargin at screen 1; set tmargin at screen 1; set bmargin at screen 0
set xrange [0:width]; set yrange [0:height]
array says[3] = ['posix: library and scene for x86-64', 'pc104: whole image, constants for cards', \
    'mps2: whole image, Cortex-M3']
array at[3] = [90, 560, 1080]
do for [p = 1:3] { set label p says[p] at at[p] + 20, height - 25 font ',15' textcolor rgb ink; \
    set object p rectangle from at[p] - 8, height - 34 to at[p] + 10, \
    height - 16 fillcolor rgb colour[p] fillstyle solid noborder }
plot NaN notitle
unset multiplot
unset output
