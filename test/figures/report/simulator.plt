# SPDX-License-Identifier: MIT
# Error over cost of the simulator's plant: a column a problem, instructions above, nanoseconds
# below.
width = 1900; height = 1150
load here.'/style.gp'
array problem[3] = ['smooth', 'stiff', 'ringing']
array title[3] = ['smooth: a mass on its string', 'stiff: 10^6 N/m, rotor of 1 g', \
    'the fall: slack, bounces, stick and slip']
array method[6] = ['explicit', 'semi-implicit', 'midpoint', 'rk4', 'flow', 'leapfrog']
array says[6] = ['explicit Euler', 'semi-implicit Euler', 'implicit midpoint', 'RK4', \
    'exact flow, events located', 'leapfrog (the simulator)']
array colour[6] = ['#999999', '#8c564b', '#1a8f2e', '#d07800', '#7b3fa0', ours_colour]
array mark[6] = [8, 10, 4, 6, 12, 7]
set multiplot layout 2,3 margins 0.065,0.985,0.155,0.95 spacing 0.05,0.09
set logscale xy
set format '10^{%T}'
set xtics 100
set yrange [1e-17:1]
unset key
do for [row = 0:1] {
    do for [p = 1:3] {
        set title (row == 0 ? title[p] : '') textcolor rgb ink offset 0,-0.6
        set xrange [(row == 0 ? 1e5 : 1e4):1e10]
        set xlabel (row == 0 ? 'instructions for a second' : 'ns for a second') \
            textcolor rgb ink offset 0,0.3
        set ylabel (p == 1 ? 'largest error of a position, m' : '') textcolor rgb ink offset 0.6,0
        column_of = row == 0 ? 'instructions_per_s' : 'ns_per_s'
        if (row == 1) { set arrow 1 from 1e9, graph 0 to 1e9, \
            graph 1 nohead lw 2 lc rgb bad_colour; set label 1 'real time' at 4.5e8, \
            1e-9 center rotate by 90 textcolor rgb bad_colour } else { unset arrow 1; \
            unset label 1 }
        if (row == 1 && p == 2) { set key at screen 0.52,0.03 center center maxrows 2 samplen 2.5 \
            Left reverse } else { unset key }
        plot for [m = 1:6] data using (strcol('problem') eq problem[p] && strcol('method') eq \
            method[m] && strcol('step_s') ne '0.00025' && column('error_m') < 1 \
            ? column(column_of) : NaN):(column('error_m') < 1e-17 ? 1e-17 : column('error_m')) \
            with linespoints lw 1.6 pt mark[m] ps 1.2 lc rgb colour[m] title says[m], \
             data using (strcol('problem') eq problem[p] && strcol('step_s') eq '0.00025' \
             ? column(column_of) : NaN):'error_m' with points pt 7 ps 2.6 lc rgb ours_colour \
             title 'its step, 250 us'
    }
}
unset multiplot
unset output
