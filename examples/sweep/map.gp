# SPDX-License-Identifier: MIT
# The borders of a map over all its rates, in its directory: gnuplot -c .../examples/sweep/map.gp
set terminal pngcairo size 1600,900 font 'DejaVu Sans,16'
set output 'map.png'
set datafile separator ','
set multiplot layout 1,2
set grid lc '#dddddd'
set yrange [300:100000]
set border 3 lc '#333333'
set tics nomirror
set logscale y
set format y '%.0s%c'
set xlabel 'damping b (Ns/m)'
set ylabel 'largest stable stiffness k (N/m)'
set logscale cb
set cbrange [90:20000]
set cbtics (90, 200, 500, '1k' 1000, '2k' 2000, '5k' 5000, '10k' 10000, '20k' 20000)
set cblabel 'rate of the loop (Hz)'
set palette defined (0 '#352a87', 1 '#0f5cdd', 2 '#1481d6', 3 '#06a4ca', 4 '#2eb7a4', 5 '#87bf77', \
    6 '#d1bb59', 7 '#fec832', 8 '#e6550d')
set xrange [0:140]
plot 'border.csv' skip 1 using (strcol(2) eq 'k' ? $4 : NaN):3:1 with points pt 7 ps .5 palette \
    notitle
unset colorbox
unset xrange
set logscale x
set xrange [80:22000]
set xtics (90, 200, 500, '1k' 1000, '2k' 2000, '5k' 5000, '10k' 10000, '20k' 20000)
set xlabel 'rate of the loop (Hz)'
set cblabel 'b (Ns/m)'
unset logscale cb
set cbrange [0:140]
set cbtics auto
set colorbox
plot 'border.csv' skip 1 using (strcol(2) eq 'k' ? $1 : NaN):3:4 with points pt 7 ps .6 palette \
    notitle
unset multiplot
