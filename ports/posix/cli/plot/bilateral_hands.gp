# Settling and stiffness over fingers and hands, beside the paper's: a point per finger mass, hand
# stiffness and hand damping.
#
#   gnuplot -e "data='hands.csv'; k='20000'; b='60'; speed='0.87'" bilateral_hands.gp
#
#   data         mass_kg,hand_k_n_per_m,hand_b_ns_per_m,contacts,settled,rested,settle_s,rest_s,
#                stiffness_n_per_m,... (exhand bilateral --hands)
# Optional:
#   out          PNG to write                            (hands.png)

if (!exists("out")) out = 'hands.png'

set terminal pngcairo size 1560,900 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','

ink = '#333333'
masses = '0.05 0.1 0.2'
stiffs = '150 300 600'
array colour[3] = ['#1f5fbf', '#e67e00', '#7a1fa2']
array mark[3] = [7, 5, 9]
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set lmargin at screen 0.085; set rmargin at screen 0.735
set tmargin at screen 0.90; set bmargin at screen 0.115
set logscale x
set xrange [15:1500]
set yrange [0:120]
set xtics (20, 50, 100, 200, 500, 1000)
set xlabel 'time to rest, median: position within 0.2 mm, F_{mon} within 1.5 N (ms)' textcolor rgb ink
set ylabel 'stiffness by the analysis of the paper (kN/m)' textcolor rgb ink
set label 1 sprintf("{/:Bold Contacts at %s m/s}, k = %s N/m, b = %s Ns/m: 27 fingers and hands", speed, k, b) \
    at screen 0.41, screen 0.955 center textcolor rgb ink
set key at screen 0.75, screen 0.90 left top vertical Left reverse samplen 1.0 spacing 1.35 textcolor rgb ink
here(i, v) = column('mass_kg') == real(word(masses, i)) ? v : NaN
size_of(v) = 0.9 + 1.5*v/600
plot for [i = 1:3] data using (1e3*column('rest_s')):(here(i, column('stiffness_n_per_m')/1e3)):(size_of(column('hand_k_n_per_m'))) \
         with points pt mark[i] ps variable lc rgb colour[i] notitle, \
     for [i = 1:3] NaN with points pt mark[i] ps 1.7 lc rgb colour[i] title sprintf('finger %s kg', word(masses, i)), \
     for [i = 1:3] NaN with points pt 6 ps size_of(real(word(stiffs, i))) lc rgb '#777777' title sprintf('hand %s N/m', word(stiffs, i)), \
     '+' using (25):(41.25) every ::0::0 with points pt 3 ps 3 lw 2.6 lc rgb '#1a8f2e' title "the paper's contact"
unset output
