# SPDX-License-Identifier: MIT
# Settling and stiffness over fingers and hands, beside the paper's: of each finger mass, hand
# stiffness and hand damping the median contact, and a line to its quickest.
#
#   gnuplot -e "data='hands.csv'; k='20000'; b='60'; speed='0.87'" bilateral_hands.gp
#
#   data         mass_kg,hand_k_n_per_m,hand_b_ns_per_m,contacts,settled,rested,settle_s,rest_s,
#                stiffness_n_per_m,...,quick,quickest_s (exhand-lab bilateral --hands)
# Optional:
#   out          PNG to write                            (hands.png)

if (!exists("out")) out = 'hands.png'

set terminal pngcairo size 1560,940 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','

ink = '#333333'
masses = '0.02 0.05 0.1 0.2'
damps = '2 10 40'
array colour[4] = ['#1a8fa0', '#1f5fbf', '#e67e00', '#7a1fa2']
array mark[4] = [11, 7, 5, 9]
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set lmargin at screen 0.09; set rmargin at screen 0.735
set tmargin at screen 0.90; set bmargin at screen 0.115
set logscale x
set xrange [13:1500]
set yrange [0:100]
set xtics (15, 25, 50, 100, 200, 500, 1000)
set ytics 20
set xlabel 'time to rest (ms): q within 0.2 mm, F_{mon} within 1.5 N of where they end' \
    textcolor rgb ink
set ylabel 'stiffness by the analysis of the paper (kN/m)' textcolor rgb ink
stats data using (column('contacts')) name 'ALL' nooutput
stats data using (column('rested')) name 'REST' nooutput
stats data using (column('quick')) name 'QUICK' nooutput
stats data using (column('stiffness_n_per_m') > 100e3 ? 1 : 0) name 'ABOVE' nooutput
set label 1 sprintf("{/:Bold %d fingers and hands}, contacts at %s m/s, k = %s N/m, b = %s Ns/m", \
    ALL_records, speed, k, b) \
    at screen 0.40, screen 0.955 center textcolor rgb ink
set label 2 sprintf("each line: a finger and hand,\nfrom its quickest contact\nto its median one". \
    "\n\n%.0f contacts,\n%.0f come to rest,\n%.0f within 25 ms%s", \
    ALL_sum, REST_sum, QUICK_sum, ABOVE_sum > 0 ? sprintf("\n\n%.0f hands above\n100 kN/m", \
    ABOVE_sum) : "") at screen 0.75, screen 0.40 left textcolor rgb ink
set key at screen 0.75, screen 0.90 left top vertical Left reverse samplen 1.0 spacing 1.35 \
    textcolor rgb ink
here(i, v) = column('mass_kg') == real(word(masses, i)) ? v : NaN
size_of(v) = 0.7 + 0.55*log(v)/log(2)*0.6
plot for [i = 1:4] data using (1e3*column('quickest_s')):(here(i, \
    column('stiffness_n_per_m')/1e3)): \
         (1e3*(column('rest_s') - column('quickest_s'))):(0) with vectors nohead \
         lc rgb colour[i] lw 0.9 notitle, \
     for [i = 1:4] data using (1e3*column('quickest_s')):(here(i, \
     column('stiffness_n_per_m')/1e3)) \
         with points pt 2 ps 0.6 lw 1 lc rgb colour[i] notitle, \
     for [i = 1:4] data using (1e3*column('rest_s')):(here(i, \
     column('stiffness_n_per_m')/1e3)):(size_of(column('hand_b_ns_per_m'))) \
         with points pt mark[i] ps variable lc rgb colour[i] notitle, \
     for [i = 1:4] NaN with points pt mark[i] ps 1.7 lc rgb colour[i] \
     title sprintf('finger %s kg', word(masses, i)), \
     for [i = 1:3] NaN with points pt 6 ps size_of(real(word(damps, i))) lc rgb '#777777' \
     title sprintf('hand damps %s Ns/m', word(damps, i)), \
     '+' using (25):(41.25) every ::0::0 with points pt 3 ps 3.4 lw 3 lc rgb '#d62728' \
     title "the paper's contact"
unset output
