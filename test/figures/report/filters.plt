# SPDX-License-Identifier: MIT
# What is left at zero input, over the cut-off.
width = 1500; height = 800
load here.'/style.gp'
set logscale xy
set format xy '10^{%T}'
set xrange [1e-6:0.6]; set yrange [1e-6:3e4]
set ytics ('0' 1.6e-6, '10^{-5}' 1e-5, '10^{-4}' 1e-4, '10^{-3}' 1e-3, '10^{-2}' 1e-2, \
    '10^{-1}' 0.1, '1' 1, '10' 10, '100' 100, '10^3' 1e3, '10^4' 1e4)
set xlabel 'cut-off over rate' textcolor rgb ink
set ylabel 'left at zero input, codes of 16 bits' textcolor rgb ink
set key at graph 0.98,0.96 right top Left reverse samplen 2
left_of(c) = column(c) >= 0 ? (column(c) > 0 ? column(c) : 1.6e-6) : NaN
second(c) = column('order') == 2 ? column(c) : NaN
plot data using (second(1)):(left_of(5)) with linespoints pt 5 ps 1.1 lw 2 lc rgb integer_colour \
    title 'direct form, 32 bits, truncated', \
     '' using (second(1)):(left_of(6)) with linespoints pt 4 ps 1.3 lw 2 lc rgb '#f0c690' \
     title 'direct form, 32 bits, rounded', \
     '' using 1:(left_of(4)) with points pt 7 ps 1.6 lc rgb ours_colour title 'ours, both orders'
unset output
