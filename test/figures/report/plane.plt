# SPDX-License-Identifier: MIT
# sigma over beta: four panels of alpha and delay, with the borders of theory.
width = 1700; height = 1250
load here.'/style.gp'
array border[4]
lines = data[1:strlen(data) - 4].'_border.csv'
do for [p = 0:3] { stats lines using ($1 == p ? $4 : NaN) nooutput; border[p + 1] = STATS_mean }
set multiplot layout 2,2 margins 0.075,0.985,0.15,0.955 spacing 0.05,0.075
set yrange [-0.04:1.24]
set xtics 0.5
set ytics 0.25
set samples 1000
array alpha[4] = [0.05, 0.05, 0.4, 0.4]
array delay[4] = [0, 1, 0, 1]
of(p, end) = ($1 == p && strcol('ends') eq end) ? column('beta') : NaN
unset key
do for [p = 0:3] {
    a = alpha[p + 1]; d = delay[p + 1]; e = border[p + 1]
    set title sprintf(d == 1 ? '{/Symbol a} = %g, %d tick of delay' \
        : '{/Symbol a} = %g, %d ticks of delay', a, d) textcolor rgb ink offset 0,-0.7
    set xlabel (p > 1 ? '{/Symbol b} = c/(K T)' : '') textcolor rgb ink
    set ylabel (p % 2 == 0 ? '{/Symbol s} = F_c/(K D)' : '') textcolor rgb ink offset 0.5,0
    set xrange [d:d + 2.05]
    set arrow 1 from e, graph 0 to e, graph 1 nohead lw 2.5 dt 2 lc rgb ink front
    if (p == 3) { set key at screen 0.5,0.035 center center maxrows 2 samplen 2 Left reverse }
    plot data using (of(p, 'rest')):'sigma' with points pt 7 ps 1.3 lc rgb ours_colour notitle, \
         '' using (of(p, 'cycle')):'sigma' with points pt 7 ps 1.3 lc rgb '#9bb8e3' notitle, \
         '' using (of(p, 'grows')):'sigma' with points pt 7 ps 1.3 lc rgb '#f0c690' notitle, \
         x > e ? 0.5 : (pi*sqrt(a)*(e - x)*20/4 < 0.5 ? 0.5 : NaN) with lines lw 2.5 lc rgb ink \
         title '{/Symbol s} = 1/2', \
         x < e ? pi*sqrt(a)*(e - x)*20/4 : NaN with lines lw 2.5 lc rgb bad_colour \
         title 'A* = 20 steps', \
         NaN with lines lw 2.5 dt 2 lc rgb ink title 'spectral radius 1', \
         NaN with points pt 7 ps 1.6 lc rgb ours_colour title 'rests at every load', \
         NaN with points pt 7 ps 1.6 lc rgb '#9bb8e3' title 'cycles at some', \
         NaN with points pt 7 ps 1.6 lc rgb '#f0c690' title 'grows'
}
unset multiplot
unset output
