# SPDX-License-Identifier: MIT
# Force around a fault: let go by the release law at several rates, and cut.
#
#   gnuplot -e "rates='90 2000'" faults.gp
#
#   rates        Hz; of each faults_RATEHz_release.csv and _cut.csv, header
#                t_s,force_n,coded_a,motor_a,state; 0 s is the tick that sees the cause
# Optional:
#   out_faults   PNG to write                            (faults.png)
#   kf           N per A of the motor                    (3.339)

if (!exists("out_faults")) out_faults = 'faults.png'
if (!exists("kf")) kf = 3.339

n = words(rates)
set terminal pngcairo size 1600,860 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out_faults
set datafile separator ','

ink = '#333333'
color(i) = word('#d55e00 #e69f00 #009e73 #0072b2 #000000', i)
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.6 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set xlabel 'time since the tick that sees the cause (ms)' textcolor rgb ink
set xrange [-10:35]
set yrange [0:7]
set key top right Left reverse samplen 2 spacing 1.15 textcolor rgb ink
fast = word(rates, n)

set multiplot layout 1,2 margins screen 0.07,0.985,0.13,0.88 spacing screen 0.06
set label 1 '{/:Bold Force in the ticks after a fault, a finger in the wall}' \
    at screen 0.5,0.965 center textcolor rgb ink

set title 'the dead-man switch is released' textcolor rgb ink offset 0,-0.3
set ylabel 'force commanded (N)' textcolor rgb ink
set object 1 rectangle from first 0, graph 0 to first 20, \
    graph 1 fc rgb '#f4f7fb' fs solid noborder behind
set label 2 "no force after 20 ms,\nor after 4 ticks\nbelow 500 Hz" at first 0.7, \
    graph 0.955 left textcolor rgb '#6d7f96' font ',15'
plot for [i = 1:n] 'faults_'.word(rates, i).'Hz_release.csv' \
    using (1e3*column('t_s')):(column('force_n')) \
     with steps lc rgb color(i) lw 1.8 title word(rates, i).' Hz'
unset label 1; unset label 2; unset object 1

set title 'the emergency stop opens (cut), beside it' textcolor rgb ink offset 0,-0.3
set ylabel 'force at '.fast.' Hz (N)' textcolor rgb ink
plot 'faults_'.fast.'Hz_release.csv' using (1e3*column('t_s')):(column('force_n')) with steps \
         lc rgb '#56b4e9' lw 1.8 title 'released: commanded', \
     '' using (1e3*column('t_s')):(kf*column('motor_a')) with lines lc rgb '#0072b2' lw 1.8 \
         title 'released: in the motor', \
     'faults_'.fast.'Hz_cut.csv' using (1e3*column('t_s')):(column('force_n')) with steps \
         lc rgb '#e69f00' lw 1.8 title 'cut: commanded', \
     '' using (1e3*column('t_s')):(kf*column('motor_a')) with lines \
         lc rgb '#d55e00' lw 1.8 dt (7,3) title 'cut: in the motor'
unset multiplot
unset output
