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
color(i) = word('#d62728 #e08a1e #1a8f2e #1f5fbf #5a3d9a', i)
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.6 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set xlabel 'ms from the tick that sees the cause' textcolor rgb ink
set xrange [-10:35]
set yrange [0:8.2]
set key top right Left reverse samplen 2 spacing 1.15 textcolor rgb ink
fast = word(rates, n)

set multiplot layout 1,2 margins screen 0.07,0.985,0.13,0.88 spacing screen 0.06
set label 1 'A finger presses against a wall, and something fails' at screen 0.5,0.965 center \
    textcolor rgb ink

set title '{/:Bold released}: the dead-man switch is let go' textcolor rgb ink offset 0,-0.3
set ylabel 'force commanded (N)' textcolor rgb ink
set object 1 rectangle from first 0, graph 0 to first 20, \
    graph 1 fc rgb '#f4f7fb' fs solid noborder behind
set label 2 "no force after 20 ms,\nor after 4 ticks\nbelow 500 Hz" at first 0.7, \
    graph 0.955 left textcolor rgb '#6d7f96' font ',15'
plot for [i = 1:n] 'faults_'.word(rates, i).'Hz_release.csv' \
    using (1e3*column('t_s')):(column('force_n')) \
     with steps lc rgb color(i) lw 1.8 title word(rates, i).' Hz'
unset label 1; unset label 2; unset object 1

set title '{/:Bold cut} beside it: the emergency stop opens' textcolor rgb ink offset 0,-0.3
set ylabel 'force (N)' textcolor rgb ink
plot 'faults_'.fast.'Hz_release.csv' using (1e3*column('t_s')):(column('force_n')) with steps \
         lc rgb '#9db8e0' lw 1.8 title 'released, commanded, '.fast.' Hz', \
     '' using (1e3*column('t_s')):(kf*column('motor_a')) with lines lc rgb '#1f5fbf' lw 1.8 \
         title 'in the motor', \
     'faults_'.fast.'Hz_cut.csv' using (1e3*column('t_s')):(column('force_n')) with steps \
         lc rgb '#f0a5a5' lw 1.8 title 'cut, commanded', \
     '' using (1e3*column('t_s')):(kf*column('motor_a')) with lines lc rgb '#d62728' lw 1.8 \
         title 'in the motor'
unset multiplot
unset output
