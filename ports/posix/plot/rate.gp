# SPDX-License-Identifier: MIT
# What a rate of the loop buys: the largest stable stiffness over the rate, simulated with its
# interval and linear, and the paper's rows.
#
#   gnuplot -e "data='stiffness.csv'" rate.gp
#
#   data         rate_hz,k_n_per_m,...,linear_k_n_per_m,...   (exhand-lab drop --sweep)
# Optional:
#   held         the same with the velocity's window held at 0.8 ms
#   out          PNG to write                            (rate.png)

reset # another script may have run before
if (!exists("out")) out = 'rate.png'
set terminal pngcairo size 1500,950 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','
ink = '#333333'
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set logscale xy
set xrange [75:26000]; set yrange [1:300]
set xtics (90, 200, 500, 1000, 2000, 5000, 10000, 20000)
set ytics (1, 2, 5, 10, 20, 50, 100, 200)
set xlabel 'rate of the loop (Hz)' textcolor rgb ink
set ylabel 'largest stable stiffness k (kN/m)' textcolor rgb ink
set key top left Left reverse samplen 2.4 textcolor rgb ink
set arrow 1 from 2000, graph 0 to 2000, graph 1 nohead lc rgb '#1a8f2e' lw 1.4 dt (4,5)
set label 1 'the paper ends' at 2000, graph 0.04 offset 0.8,0 textcolor rgb '#1a8f2e'
k(n) = column(n) > 0 ? column(n)/1e3 : NaN
if (exists("held")) {
    plot data using 1:(k('linear_k_n_per_m')) with linespoints \
        lc rgb '#d07800' lw 2.2 dt (9,4) pt 6 ps 1.2 title 'linear test, {/Symbol r} < 1', \
         data using 1:(k('k_n_per_m')):(k('k_low_n_per_m')):(k('k_high_n_per_m')) \
         with yerrorbars lc rgb '#1f5fbf' lw 1.4 pt 0 notitle, \
         data using 1:(k('k_n_per_m')) with linespoints lc rgb '#1f5fbf' lw 2.4 pt 7 ps 1.4 \
         title 'simulated, velocity over 2 ticks; bars: 95 % interval', \
         held using 1:(k('k_n_per_m')) with points lc rgb '#7a1fa2' pt 9 ps 2.0 \
         title 'simulated, velocity over 0.8 ms', \
         data using 1:(k('paper_k_n_per_m')) with points lc rgb '#1a8f2e' pt 3 ps 2.4 lw 2.2 \
         title 'paper, Table II: k'
} else {
    plot data using 1:(k('linear_k_n_per_m')) with linespoints \
        lc rgb '#d07800' lw 2.2 dt (9,4) pt 6 ps 1.2 title 'linear test, {/Symbol r} < 1', \
         data using 1:(k('k_n_per_m')):(k('k_low_n_per_m')):(k('k_high_n_per_m')) \
         with yerrorbars lc rgb '#1f5fbf' lw 1.4 pt 0 notitle, \
         data using 1:(k('k_n_per_m')) with linespoints lc rgb '#1f5fbf' lw 2.4 pt 7 ps 1.4 \
         title 'simulated; bars: 95 % interval', \
         data using 1:(k('paper_k_n_per_m')) with points lc rgb '#1a8f2e' pt 3 ps 2.4 lw 2.2 \
         title 'paper, Table II: k'
}
unset output
