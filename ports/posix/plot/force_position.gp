# SPDX-License-Identifier: MIT
# Force over position of a falling-mass run: pairs, ten-point averages, fitted line.
# Two panels, as in the paper: (a) the old rate, (b) the new one.
#
#   gnuplot -e "out='fp.png'; a_raw='a_raw.csv'; ..." force_position.gp
#
# For each panel, with prefix a_ and b_:
#   raw, avg, line   CSV files with the header q_m,f_mon_n (fall_write_plot() makes them)
#   rate, k, b       Hz, N/m, Ns/m; numbers or text
#   stiffness        N/m as it shall be printed; '' when there is no line
# Optional:
#   out              PNG to write                        (force_position.png)
#   a_q0, b_q0       position of the virtual contact, m  (0)
#   band_lo, band_hi the regression's force band, N      (0.8, 4.5)
#   fit              which regression the line is        ('linear fit')
#   a_q_hi_mm, b_q_hi_mm   right end of the panel, mm    (from the pairs in the band)

reset # another script may have run before
if (!exists("out")) out = 'force_position.png'
if (!exists("a_q0")) a_q0 = 0
if (!exists("b_q0")) b_q0 = 0
if (!exists("band_lo")) band_lo = 0.8
if (!exists("band_hi")) band_hi = 4.5
if (!exists("fit")) fit = 'linear fit'

set terminal pngcairo size 1800,900 font 'DejaVu Sans,22' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','

ink = '#333333'
set style line 1 lc rgb '#56b4e9' pt 7 ps 0.7          # pairs in the band
set style line 2 lc rgb '#bbbbbb' pt 7 ps 0.5          # pairs outside it
set style line 3 lc rgb '#d55e00' pt 6 ps 0.9 lw 0.9   # averaged positions
set style line 4 lc rgb '#000000' lw 3.2               # the line

inside(f) = f >= band_lo && f <= band_hi ? f : NaN
outside(f) = f >= band_lo && f <= band_hi ? NaN : f
mm(q) = (q - Q0)*1e3

set multiplot

# The key of both panels, from one empty plot.
set lmargin at screen 0; set rmargin at screen 1
set tmargin at screen 1; set bmargin at screen 0
unset border; unset tics
set xrange [0:1]; set yrange [0:1]
set label 1 '{/:Bold Measured stiffness of the virtual contact at two loop rates}' \
    at screen 0.515, 0.96 center textcolor rgb ink
set key at screen 0.515,0.02 center bottom horizontal Left reverse maxrows 1 samplen 1.4 width -1 \
    font ',20' textcolor rgb ink
plot NaN with points ls 1 ps 1.4 title sprintf('a tick, %g to %g N', band_lo, band_hi), \
     NaN with points ls 2 ps 1.4 title 'other ticks', \
     NaN with points ls 3 ps 1.4 title 'mean position of ten ticks', \
     NaN with lines ls 4 title fit
unset label 1; set key off

set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.6 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set tmargin at screen 0.81; set bmargin at screen 0.235
set xlabel 'position past the virtual contact (mm)' textcolor rgb ink
set yrange [0:band_hi + 1.0]
set xtics nomirror; set ytics nomirror 1

do for [panel in 'a b'] {
    RAW = value(panel.'_raw'); AVG = value(panel.'_avg'); LINE = value(panel.'_line')
    Q0 = value(panel.'_q0')
    S = ''.value(panel.'_stiffness')
    undefine P_* # of the panel before
    stats RAW using (mm(column('q_m')) + 0*inside(column('f_mon_n'))) name 'P' nooutput
    if (!exists("P_min")) { P_min = 0; P_max = 1 } # no pair in the band: an empty panel
    pad = 0.06 * (P_max - P_min) + 0.02
    right_mm = exists(panel.'_q_hi_mm') ? value(panel.'_q_hi_mm') : P_max + pad
    left_mm = P_min < 0 ? P_min - pad : 0 # the wall itself is in the picture
    set xrange [left_mm : right_mm]
    set lmargin at screen (panel eq 'a' ? 0.065 : 0.562)
    set rmargin at screen (panel eq 'a' ? 0.487 : 0.985)
    set title sprintf("{/:Bold (%s)  %s Hz}   k = %s N/m, b = %s Ns/m\n%s", panel, \
        ''.value(panel.'_rate'), ''.value(panel.'_k'), ''.value(panel.'_b'), \
        S eq '' ? 'no stiffness' : 'measured stiffness '.S.' N/m') textcolor rgb ink offset 0,-0.3
    if (panel eq 'a') { set ylabel 'monitored force (N)' textcolor rgb ink offset 0.8,0 }
    if (panel eq 'b') { unset ylabel }
    set object 1 rectangle from graph 0, first band_lo to graph 1, first band_hi \
        fc rgb '#f4f7fb' fs solid noborder behind
    plot RAW using (mm(column('q_m'))):(outside(column('f_mon_n'))) with points ls 2, \
         RAW using (mm(column('q_m'))):(inside(column('f_mon_n'))) with points ls 1, \
         AVG using (mm(column('q_m'))):(column('f_mon_n')) with points ls 3, \
         LINE using (mm(column('q_m'))):(column('f_mon_n')) with lines ls 4
    unset object 1
}
unset multiplot
unset output
