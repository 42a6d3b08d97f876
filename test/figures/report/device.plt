# SPDX-License-Identifier: MIT
# Planes of k and b: rows steps and string, all; columns rate and mass.
width = 1900; height = 1150
load here.'/style.gp'
stem = data[1:strlen(data) - 4]
cells = stem.'_plane.csv'
border_of = stem.'_border.csv'
stats cells using 4 nooutput
n = sqrt(STATS_records/4.)
set multiplot layout 2,4 margins 0.05,0.99,0.165,0.945 spacing 0.035,0.1
set logscale xy
set format xy '10^{%T}'
set xrange [0.3/1.1:1100]; set yrange [30/1.2:1.2e6]
array what[4] = ['90 Hz, 0.5 kg', '500 Hz, 0.5 kg', '2000 Hz, 0.5 kg', '20 kHz, 0.02 kg']
size_of_point = 36./n
of(p, c, end) = ($1 == p && strcol(c) eq end) ? $5 : NaN
unset key
do for [row = 0:1] {
    do for [p = 0:3] {
        c = row == 0 ? 'ends_steps_string' : 'ends_all'
        set title what[p + 1].(row == 0 ? ': steps, string' : ': friction too') font ',17' \
            textcolor rgb ink offset 0,-0.7
        set xlabel (row == 1 ? 'b, Ns/m' : '') textcolor rgb ink
        set ylabel (p == 0 ? 'k, N/m' : '') textcolor rgb ink offset 0.5,0
        if (row == 1 && p == 3) { set key at screen 0.5,0.035 center center maxrows 2 samplen 2 \
            Left reverse }
        plot cells using (of(p, c, 'rest')):4 with points pt 5 ps size_of_point*0.75 \
            lc rgb ours_colour notitle, \
             '' using (of(p, c, 'buzz')):4 with points pt 5 ps size_of_point*0.75 lc rgb '#9bb8e3' \
             notitle, \
             '' using (of(p, c, 'swings')):4 with points pt 5 ps size_of_point*0.75 \
             lc rgb '#f0c690' notitle, \
             '' using (of(p, c, 'leaves')):4 with points pt 5 ps size_of_point*0.75 \
             lc rgb bad_colour notitle, \
             border_of using ($1 == p && $2 == 0 ? $3 : NaN):4 with lines lw 2.5 lc rgb ink \
             title 'rho = 1, no friction', \
             border_of using ($1 == p && $2 > 0 ? $3 : NaN):4 with lines lw 2.5 dt 2 lc rgb ink \
             title 'rho = 1, viscous friction', \
             NaN with points pt 5 ps 1.6 lc rgb ours_colour title 'at rest', \
             NaN with points pt 5 ps 1.6 lc rgb '#9bb8e3' title 'within three steps', \
             NaN with points pt 5 ps 1.6 lc rgb '#f0c690' title 'swings', \
             NaN with points pt 5 ps 1.6 lc rgb bad_colour title 'leaves'
    }
}
unset multiplot
unset output
