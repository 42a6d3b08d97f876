# SPDX-License-Identifier: MIT
# Delay 0..3: what the simulated wall does, over beta and alpha, and the border of the spectral
# radius.
width = 1700; height = 1250
load here.'/style.gp'
set multiplot layout 2,2 margins 0.075,0.985,0.125,0.955 spacing 0.055,0.075
set logscale xy
set format xy '10^{%T}'
set xrange [1e-3:10]; set yrange [1e-3:30]
border_of = data[1:strlen(data) - 4].'_border.csv'
cells(d, stable) = (column('delay') == d && column('stable') == stable && column('beta') > 0) \
    ? column('beta') : NaN
odd(d) = (column('delay') == d && (column('stable') == 1) != (column('rho') < 1) && \
    abs(column('rho') - 1) >= 0.005) ? column('beta') : NaN
unset key
do for [d = 0:3] {
    set title sprintf(d == 1 ? '%d tick of delay' : '%d ticks of delay', d) \
        textcolor rgb ink offset 0,-0.7
    set xlabel (d > 1 ? '{/Symbol b} = b T/m' : '') textcolor rgb ink
    set ylabel (d % 2 == 0 ? '{/Symbol a} = k T^2/m' : '') textcolor rgb ink offset 0.5,0
    if (d == 3) { set key at screen 0.5,0.028 center center maxrows 1 samplen 2 Left reverse }
    plot data using (cells(d, 0)):'alpha' with points pt 7 ps 0.35 lc rgb '#f0c690' notitle, \
         '' using (cells(d, 1)):'alpha' with points pt 7 ps 0.35 lc rgb ours_colour notitle, \
         border_of using ($1 == d ? $2 : NaN):3 with lines lw 2.5 lc rgb ink \
         title 'spectral radius 1', \
         data using (odd(d)):'alpha' with points pt 2 ps 1.5 lw 2 lc rgb bad_colour \
         title 'disagrees', \
         NaN with points pt 7 ps 1.3 lc rgb ours_colour title 'decays', \
         NaN with points pt 7 ps 1.3 lc rgb '#f0c690' title 'grows'
}
unset multiplot
unset output
