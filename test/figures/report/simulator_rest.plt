# SPDX-License-Identifier: MIT
# What becomes of the time until rest and of the stiffness, over what the plant costs.
width = 1800; height = 850
load here.'/style.gp'
array method[5] = ['explicit', 'semi-implicit', 'midpoint', 'rk4', 'leapfrog']
array says[5] = ['explicit Euler', 'semi-implicit Euler', 'implicit midpoint', 'RK4', \
    'leapfrog (the simulator)']
array colour[5] = ['#999999', '#8c564b', '#1a8f2e', '#d07800', ours_colour]
array mark[5] = [8, 10, 4, 6, 7]
is(m) = strcol('method') eq method[m]
set multiplot layout 1,2 margins 0.065,0.985,0.27,0.92 spacing 0.08
set logscale x
set format x '10^{%T}'
set xlabel 'instructions of the plant for a second' textcolor rgb ink
set ylabel 'standard errors of the difference' textcolor rgb ink offset 1,0
set title 'time until rest, off at the worst rate'
set logscale y
set yrange [0.5:100]
set key at screen 0.5,0.08 center center maxrows 3 samplen 2 width -3 Left reverse
set xrange [1e6:2e7]
set xtics 10
least(v) = abs(v) < 0.5 ? 0.5 : abs(v)
set arrow 1 from graph 0, first 2 to graph 1, first 2 nohead lw 2 dt 2 lc rgb bad_colour
plot for [m = 1:5] data using (is(m) ? column(3) : NaN):(least(column(5))) \
    with linespoints lw 1.6 pt mark[m] ps 1.3 lc rgb colour[m] title says[m], \
     data using (is(5) && column(2) == 250 ? column(3) : NaN):(least(column(5))) with \
     points pt 7 ps 2.8 lc rgb ours_colour notitle, \
     data using (strcol('method') eq 'flow' ? column(3) : NaN):(0.5) with points pt 13 ps 2.4 \
     lc rgb '#7b3fa0' title 'exact flow, the reference', \
     NaN with lines lw 2 dt 2 lc rgb bad_colour title 'two standard errors: chance'
unset key
unset ylabel
set title 'stiffness, off at the worst rate'
plot for [m = 1:5] data using (is(m) ? column(3) : NaN):(least(column(8))) \
    with linespoints lw 1.6 pt mark[m] ps 1.3 lc rgb colour[m] notitle, \
     data using (is(5) && column(2) == 250 ? column(3) : NaN):(least(column(8))) with \
     points pt 7 ps 2.8 lc rgb ours_colour notitle, \
     data using (strcol('method') eq 'flow' ? column(3) : NaN):(0.5) with points pt 13 ps 2.4 \
     lc rgb '#7b3fa0' notitle
unset multiplot
unset output
