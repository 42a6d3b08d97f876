# SPDX-License-Identifier: MIT
# Error over time: kernels.py's drift().
width = 1500; height = 800
load here.'/style.gp'
load data[1:strlen(data) - 4].'.names'
set logscale xy
set format y '10^{%T}'
set xtics ('1 s' 1, '10 s' 10, '1 min' 60, '10 min' 600, '1 h' 3600)
set xrange [0.8:5000]
set xlabel 'time at 2 kHz' textcolor rgb ink
set ylabel 'largest error in the last second, '.unit textcolor rgb ink
set key outside right center Left reverse samplen 1.6 noenhanced
array colour[3] = [ours_colour, integer_colour, float_colour]
array mark[10] = [7, 6, 4, 5, 11, 8, 12, 10, 9, 13]
colour_of(k) = colour[value(sprintf('kind_%d', k)) + 1]
plot for [k = 1:n_names] data using 1:(column(k + 1)) with linespoints lw 2 lc rgb colour_of(k) \
     pt mark[k] ps 1.6 title value(sprintf('name_%d', k))
unset output
