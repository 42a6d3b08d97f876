# SPDX-License-Identifier: MIT
# Force over position of bilateral contacts, a panel per speed, as the paper's: pairs, ten-point
# averages, fitted line.
#
#   gnuplot -e "files='bilateral_natural_index'; names='natural'; ..." bilateral_force.gp
#
#   files        prefixes of CSV files _raw.csv, _avg.csv and _line.csv, header q_m,f_mon_n;
#                positions past each approach's own q_lim
#   names, fingers, stiffnesses (N/m, 0: no line), k, b, link
#                as contact.gp has them
# Optional:
#   out_force    PNG to write                            (force.png)
#   band_lo, band_hi   the regression's force band, N     (0.8, 4.5)

if (!exists("out_force")) out_force = 'force.png'
if (!exists("band_lo")) band_lo = 0.8
if (!exists("band_hi")) band_hi = 4.5

n = words(files)
width = 150.0 + 720*n
set terminal pngcairo size width,900 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out_force
set datafile separator ','

ink = '#333333'
set style line 1 lc rgb '#1f5fbf' pt 2 ps 0.9 lw 0.9   # blue crosses: pairs in the band
set style line 2 lc rgb '#b9c9e2' pt 2 ps 0.5 lw 0.6   # faint: pairs outside it
set style line 3 lc rgb '#d62728' pt 6 ps 0.9 lw 0.9   # red circles: averaged positions
set style line 4 lc rgb '#1a8f2e' lw 3.2               # green: the line

inside(f) = f >= band_lo && f <= band_hi ? f : NaN
outside(f) = f >= band_lo && f <= band_hi ? NaN : f

set multiplot
set lmargin at screen 0; set rmargin at screen 1
set tmargin at screen 1; set bmargin at screen 0
unset border; unset tics; unset title; unset arrow
set xrange [0:1]; set yrange [0:1]
set key at screen 0.5, screen 0.985 center top horizontal Left \
    reverse maxrows 1 samplen 1.4 width -2 \
    textcolor rgb ink
plot NaN with points ls 1 ps 1.4 title sprintf('pairs, %g to %g N', band_lo, band_hi), \
     NaN with points ls 2 ps 1.4 title 'other pairs', \
     NaN with points ls 3 ps 1.4 title 'mean of ten positions', \
     NaN with lines ls 4 title 'linear fit, position over force'
set key off
gains = k eq '' || b eq '' ? "the scene's own k and b" : \
    sprintf('k = %s N/m, b = %s Ns/m', k, b)
set label 9 sprintf('%s, link: %s', gains, link) at screen 0.5, \
    screen 0.895 center \
    noenhanced textcolor rgb ink font ',17'
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.6 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set tmargin at screen 0.79; set bmargin at screen 0.13
set xlabel 'string past the virtual contact (mm)' textcolor rgb ink
set yrange [0:band_hi + 1.0]
set xrange [-0.1:0.6]
set xtics nomirror 0.1
set ytics nomirror 1
set format x '%g'

do for [i = 1:n] {
    P = word(files, i)
    S = real(word(stiffnesses, i))
    set lmargin at screen (100.0 + 720*(i-1)) / width
    set rmargin at screen (100.0 + 720*(i-1) + 650) / width
    set title sprintf("{/:Bold %s}, %s: %s", word(names, i), word(fingers, i), \
        S > 0 ? sprintf('measured stiffness %.0f N/m', S) : 'no line through these') \
        textcolor rgb ink offset 0,-0.3
    if (i == 1) { set ylabel 'monitored force (N)' textcolor rgb ink } else { unset ylabel }
    set object 1 rectangle from graph 0, first band_lo to graph 1, first band_hi \
        fc rgb '#f4f7fb' fs solid noborder behind
    plot P.'_raw.csv' using (column('q_m')*1e3):(outside(column('f_mon_n'))) with points ls 2, \
         P.'_raw.csv' using (column('q_m')*1e3):(inside(column('f_mon_n'))) with points ls 1, \
         P.'_avg.csv' using (column('q_m')*1e3):(column('f_mon_n')) with points ls 3, \
         P.'_line.csv' using (column('q_m')*1e3):(column('f_mon_n')) with lines ls 4
    unset object 1; unset label 9
}
unset multiplot
unset output
