# SPDX-License-Identifier: MIT
# A calibration: force over current as measured, the table made of it, the straight
# line, and below how far each point lies from that line.
#
#   gnuplot -e "out='c.png'; points='calibration.csv'; table='table.csv'; kf=3.3; kf_mon=3.3"
#   calibration.gp
#
#   points   CSV: force_n,current_a,monitored_a,friction_n,residual_current_n,residual_monitor_n
#   table    CSV: current_a,force_n,monitored_a,force_monitored_n
#   kf, kf_mon   slopes of the lines, N/A
# Optional: out, the PNG to write (calibration.png)

reset # another script may have run before
if (!exists("out")) out = 'calibration.png'
set terminal pngcairo size 1500,1300 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','

ink = '#333333'
set style line 1 lc rgb '#1f5fbf' pt 7 ps 1.6 lw 1.6    # points by current
set style line 2 lc rgb '#d62728' pt 6 ps 2.2 lw 1.6    # points by monitor
set style line 3 lc rgb '#1f5fbf' lw 1.8                # table
set style line 4 lc rgb '#777777' lw 1.4 dt (8,5)       # line
set style line 5 lc rgb '#9dbbe6' lw 6                  # what friction holds

stats points using (column('current_a') + column('friction_n')/kf) name 'I' nooutput
stats points using (column('force_n')) name 'F' nooutput
i_top = I_max * 1.04
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.6 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set xrange [0:i_top]
set lmargin at screen 0.10; set rmargin at screen 0.97

set multiplot
set tmargin at screen 0.93; set bmargin at screen 0.42
set title sprintf('Known masses: %.4f N/A by current, %.4f N/A by monitor', kf, kf_mon) \
    textcolor rgb ink
set ylabel 'string force (N)' textcolor rgb ink
set yrange [0:F_max * 1.25]
set format x ''
set key top left Left reverse samplen 1.6 textcolor rgb ink
plot points using (column('current_a')):(column('force_n')):(column('friction_n')/kf) \
         with xerrorbars ls 5 pt -1 ps 0 title 'lift and sink: what friction holds', \
     kf * x with lines ls 4 title 'straight line through the origin', \
     table using (column('current_a')):(column('force_n')) with lines ls 3 \
         title 'table (beyond the last point: straight on)', \
     points using (column('current_a')):(column('force_n')) with points ls 1 \
     title 'points, coded current', \
     points using (column('monitored_a')):(column('force_n')) with points ls 2 \
     title 'points, monitored current'

unset title; unset key
set tmargin at screen 0.37; set bmargin at screen 0.09
set format x '%.1f'
set xlabel 'current (A)' textcolor rgb ink
set ylabel 'residual (mN)' textcolor rgb ink
set yrange [*:*]
set offsets 0, 0, 1, 1
plot 0 with lines ls 4, \
     points using (column('current_a')):(column('residual_current_n')*1e3) with impulses \
     lc rgb '#1f5fbf' lw 1.2, \
     points using (column('current_a')):(column('residual_current_n')*1e3) with points ls 1, \
     points using (column('monitored_a')):(column('residual_monitor_n')*1e3) with points ls 2
unset multiplot
unset output
