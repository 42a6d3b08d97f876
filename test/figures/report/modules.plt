# SPDX-License-Identifier: MIT
# Which module is in which scene: bytes in the Cortex-M3 image beside instructions per tick.
# modules_cells.csv, modules_names.csv.
stats 'modules_names.csv' using 1 every ::1 nooutput
n = STATS_records
width = 1500
height = 32*n + 150
load here.'/style.gp'
set multiplot
set border 0
unset grid
unset key
unset colorbox
set tics scale 0
unset ytics
set palette defined (0 '#f2f6fc', 1 '#dce8f7', 2 '#b6d0ee', 3 '#5f93d3', 4.3 '#1f5fbf')
set cbrange [0:4.3]
set xrange [0.5:7.5]
set yrange [0.4:n + 0.6]
set xtics ('minimal' 1, 'drop' 2, 'guarded' 3, 'glove' 4, 'bilateral' 5, 'bringup' 6, \
    'calibrate' 7) font ',14' offset 0,0.3
set style fill solid 1.0 noborder
do for [k = 1:2] {
    set lmargin at screen (k == 1 ? 0.115 : 0.585)
    set rmargin at screen (k == 1 ? 0.555 : 0.995)
    set tmargin at screen 1 - 60./height
    set bmargin at screen 45./height
    set title (k == 1 ? 'bytes of code and constants, Cortex-M3' \
        : 'instructions per tick, x86-64, in contact') font 'DejaVu Sans Bold,17' offset 0,-0.4
    plot 'modules_cells.csv' using (column('panel') == k ? column('x') \
        : NaN):'y':(0.47):(0.44):'log10' with boxxyerror lc palette, \
         '' using (column('panel') == k && column('log10') < 2.6 ? column('x') \
         : NaN):'y':(stringcolumn('label')) with labels font ',14' textcolor rgb ink, \
         '' using (column('panel') == k && column('log10') >= 2.6 ? column('x') \
         : NaN):'y':(stringcolumn('label')) with labels font ',14' textcolor rgb '#ffffff'
}
unset title; unset xtics
set lmargin at screen 0; set rmargin at screen 1
set xrange [0:1]
plot 'modules_names.csv' using (0.11):'y':(stringcolumn('name')) with labels right \
    font ',15' noenhanced textcolor rgb ink
unset multiplot
unset output
