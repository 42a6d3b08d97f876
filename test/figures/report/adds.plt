# SPDX-License-Identifier: MIT
# What one thing more adds: text, memory, instructions per tick, by port. adds_bars.csv,
# adds_names.csv.
stats 'adds_names.csv' using 1 every ::1 nooutput
n = STATS_records
width = 1500
height = 88*n + 150
load here.'/style.gp'
set multiplot
unset key
set style fill solid 1.0 noborder
set logscale x
set yrange [0.45:n + 0.55]
unset ytics
unset grid
set grid xtics lc rgb '#dddddd' lw 0.6
set format x '10^{%T}'
set mxtics 1
set xtics 10, 100, 1e8 font ',14'
array colour[3] = ['#9bb8e3', '#1f5fbf', '#d07800']
array what[3] = ['code and constants, B', 'memory, B', 'instructions per tick']
array high[3] = [1e6, 3e7, 3e5]
do for [k = 1:3] {
    set lmargin at screen 0.24 + 0.255*(k - 1)
    set rmargin at screen 0.24 + 0.255*k - 0.02
    set tmargin at screen 1 - 95./height
    set bmargin at screen 45./height
    set xrange [1:high[k]]
    set title what[k] font 'DejaVu Sans Bold,17' offset 0,-0.5
    plot for [p = 0:2] 'adds_bars.csv' using (column('panel') == k && column('port') == p ? 1 \
        : NaN):'y':(1):(column('value')):(column('y') - 0.115):(column('y') + 0.115) \
             with boxxyerror lc rgb colour[p + 1], \
         '' using (column('panel') == k ? column('value')*1.15 : NaN):'y':(stringcolumn('label')) \
         with labels left font ',12' textcolor rgb ink
}
unset logscale; unset border; unset tics; unset title; unset grid
set lmargin at screen 0; set rmargin at screen 1; set tmargin at screen 1 - 95./height; \
    set bmargin at screen 45./height
set xrange [0:width]
plot 'adds_names.csv' using (0.235*width):'y':(stringcolumn('name')) with labels right font ',15' \
    textcolor rgb ink
array says[3] = ['posix: x86-64', 'pc104: i686', 'mps2: Cortex-M3']
set tmargin at screen 1; set bmargin at screen 0
set yrange [0:height]
do for [p = 1:3] { set label p says[p] at 420 + 330*(p - 1), height - 25 font ',16' \
    textcolor rgb ink; \
    set object p rectangle from 392 + 330*(p - 1), height - 34 to 410 + 330*(p - 1), \
    height - 16 fillcolor rgb colour[p] fillstyle solid noborder }
plot NaN notitle
unset multiplot
unset output
