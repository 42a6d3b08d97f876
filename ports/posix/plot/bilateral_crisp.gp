# SPDX-License-Identifier: MIT
# Crispness over k and b: the steepest millisecond of the monitored force in the first three of a
# contact, per speed at contact. Pairs whose contacts do not come to rest are marked.
#
#   gnuplot -e "data='crisp.csv'; speed='0.2'" bilateral_crisp.gp
#
#   data         k_n_per_m,b_ns_per_m,contacts,settled,rested,...,rise_n_per_m,speed_m_per_s
#                (exhand-lab bilateral --crisp)
#   speed        of the approach, m/s of string
# Optional:
#   out          PNG to write                            (crisp.png)
#   paper_k, paper_b   the paper's point                 (20000, 60)

if (!exists("out")) out = 'crisp.png'
if (!exists("paper_k")) paper_k = 20000
if (!exists("paper_b")) paper_b = 60

set terminal pngcairo size 1300,900 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','

ink = '#333333'
set palette defined (0 '#f2f6fb', 0.35 '#9fc3e6', 0.7 '#2f74b8', 1 '#0b2f5e')
set cblabel 'crispness: (dF_{mon}/dt) / speed  (kN/m)' textcolor rgb ink
set border lc rgb ink lw 0.8
set tics out scale 0.5 textcolor rgb ink
set xtics nomirror; set ytics nomirror
set lmargin at screen 0.115; set rmargin at screen 0.845
set tmargin at screen 0.86; set bmargin at screen 0.115
set xlabel 'stiffness k (kN/m)' textcolor rgb ink
set ylabel 'damping b (Ns/m)' textcolor rgb ink
set label 1 sprintf("{/:Bold Crispness}: how fast force rises in a contact at %s m/s", speed) \
    at screen 0.47, screen 0.965 center textcolor rgb ink
set key at screen 0.47, screen 0.925 center top horizontal Left \
    reverse maxrows 1 samplen 0.6 width -2 font ',17' textcolor rgb ink
stats data using (column('k_n_per_m')/1e3) name 'K' nooutput
stats data using (column('b_ns_per_m')) name 'B' nooutput
set xrange [K_min - 1.6 : K_max + 1.6]
set yrange [B_min - 5.2 : B_max + 5.2]
set cbrange [0:*]
dk = 0.5*(K_max - K_min)/12; db = 0.5*(B_max - B_min)/10 # half a cell
plot data using (column('k_n_per_m')/1e3):(column('b_ns_per_m')): \
         (column('k_n_per_m')/1e3 - dk):(column('k_n_per_m')/1e3 + dk): \
         (column('b_ns_per_m') - db):(column('b_ns_per_m') + db):(column('rise_n_per_m')/1e3) \
         with boxxyerror fs solid noborder lc palette notitle, \
     data using (column('k_n_per_m')/1e3):(column('rested') < column('contacts') \
     ? column('b_ns_per_m') : NaN) \
         with points pt 2 ps 1.6 lw 1.8 lc rgb '#d62728' title 'a contact did not come to rest', \
     '+' using (paper_k/1e3):(paper_b) every ::0::0 with points pt 3 ps 3 lw 2.6 lc rgb '#1a8f2e' \
     title "the paper's gains"
unset output
