# SPDX-License-Identifier: MIT
# A first contact over time, the original system's and this box's: how far past the wall, and the
# force that is felt there.
#
#   gnuplot -c original.gp PLOTS, inside the directory of --out, where exhand has made one
#
#   files        CSV files with the header t_s,past_m,f_des_n,f_mon_n; names[i]: their titles
# Optional:
#   out          PNG to write                            (original.png)
#   zoom_s       so much of it                           (0.3)

if (!exists("out")) out = 'original.png'
if (!exists("zoom_s")) zoom_s = 0.3

set terminal pngcairo size 1600,1100 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','
ink = '#333333'
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.6 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set style line 1 lc rgb '#d62728' lw 2.2 pt 7 ps 0.7
set style line 2 lc rgb '#e39a2d' lw 2.2 pt 7 ps 0.7
set style line 3 lc rgb '#1f5fbf' lw 2.2
n = words(files)
set multiplot layout 2,1
set xrange [-0.01:zoom_s]
set key top right textcolor rgb ink
set ylabel 'past the wall (mm)' textcolor rgb ink
plot for [i = 1:n] word(files, i) using 't_s':(column('past_m')*1e3) with steps ls i == n ? 3 : i \
    title names[i]
set key off
set ylabel 'monitored force (N)' textcolor rgb ink
set xlabel 'time since contact (s)' textcolor rgb ink
plot for [i = 1:n] word(files, i) using 't_s':'f_mon_n' with steps ls i == n ? 3 : i
unset multiplot
unset output
