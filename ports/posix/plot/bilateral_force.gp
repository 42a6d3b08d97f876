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
width = 120.0 + 520*n
if (width < 900) { width = 900.0 }
set terminal pngcairo size width,760 font 'DejaVu Sans,18' linewidth 1.6 background '#ffffff'
set output out_force
set datafile separator ','

ink = '#333333'
set style line 1 lc rgb '#56b4e9' pt 7 ps 0.7          # pairs in the band
set style line 3 lc rgb '#d55e00' pt 6 ps 0.9 lw 0.9   # averaged positions
set style line 4 lc rgb '#000000' lw 3 dt 1            # the line
inside(f) = f >= band_lo && f <= band_hi ? f : NaN

set multiplot
set lmargin at screen 0; set rmargin at screen 1
set tmargin at screen 1; set bmargin at screen 0
unset border; unset tics; unset title; unset arrow; unset label
set xrange [0:1]; set yrange [0:1]
set label 1 '{/:Bold Bilateral contact: force over position, and the fitted stiffness}' \
    at screen 0.5, screen 0.96 center textcolor rgb ink
gains = k eq '' || b eq '' ? "the scene's own k and b" : \
    sprintf('k = %s N/m, b = %s Ns/m', k, b)
set label 9 sprintf('%s, link: %s; shown: pairs of %g to %g N, which the fit uses', gains, link, \
    band_lo, band_hi) at screen 0.5, screen 0.915 center noenhanced textcolor rgb ink font ',15'
set key at screen 0.5, screen 0.885 center top horizontal Left reverse maxrows 1 samplen 1.6 \
    width 1 textcolor rgb ink
plot NaN with points ls 1 ps 1.4 title 'a tick', \
     NaN with points ls 3 ps 1.4 title 'mean position of ten ticks', \
     NaN with lines ls 4 title 'linear fit of the means'
unset label; set key off
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.6 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set tmargin at screen 0.74; set bmargin at screen 0.14
set xlabel 'position past the virtual contact (mm)' textcolor rgb ink
set yrange [0:band_hi + 0.5]
set xrange [0:0.6]
set xtics nomirror 0.1
set ytics nomirror 1

do for [i = 1:n] {
    P = word(files, i)
    S = real(word(stiffnesses, i))
    set lmargin at screen (100.0 + 520*(i-1)) / width
    set rmargin at screen (100.0 + 520*(i-1) + 460) / width
    set title sprintf("{/:Bold %s}, %s finger\n%s", word(names, i), word(fingers, i), \
        S > 0 ? sprintf('measured stiffness %.0f N/m', S) : 'no line fits') \
        textcolor rgb ink offset 0,-0.3
    if (i == 1) { set ylabel 'monitored force (N)' textcolor rgb ink } else { unset ylabel }
    plot P.'_raw.csv' using (column('q_m')*1e3):(inside(column('f_mon_n'))) with points ls 1, \
         P.'_avg.csv' using (column('q_m')*1e3):(column('f_mon_n')) with points ls 3, \
         P.'_line.csv' using (column('q_m')*1e3):(column('f_mon_n')) with lines ls 4
}
unset multiplot
unset output
