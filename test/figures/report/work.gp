# SPDX-License-Identifier: MIT
# Work-precision diagrams: what work.py has put into NAME.panels, NAME_points.csv, NAME_front.csv
# and NAME_leader.csv.
stem = data[1:strlen(data) - 4]
load stem.'.panels'
legend_px = 46.
heading_px = 44.
width = n_columns*panel_w + 30
if (width < 1000) { width = 1000 }
height = n_rows*panel_h + legend_px + heading_px
load here.'/style.gp'
set multiplot
set logscale xy
unset key
set label 1000 heading.' (lower and further left is better)' at screen 0.5, screen 1 - 22/height \
    center font 'DejaVu Sans Bold,20' textcolor rgb ink
small = sprintf(',%d', font)
points_of(k, kind, named) = (column('panel') == k && column('kind') == kind && \
    column('named') == named) ? column('cost') : NaN
label_of(k) = (column('panel') == k && column('named') == 1) ? column('label_cost') : NaN
array colour[3] = [ours_colour, integer_colour, float_colour]
array number[3] = [0x0072b2, 0xa84800, 0x000000]
do for [k = 1:n_panels] {
    c = (k - 1) % n_columns; r = (k - 1)/n_columns
    set lmargin at screen (30. + c*panel_w + left)/width
    set rmargin at screen (30. + (c + 1)*panel_w - right)/width
    set tmargin at screen 1 - (heading_px + r*panel_h + top)/height
    set bmargin at screen 1 - (heading_px + (r + 1)*panel_h - bottom)/height
    set xrange [value(sprintf('x0_%d', k)) : value(sprintf('x1_%d', k))]
    set yrange [value(sprintf('y0_%d', k)) : value(sprintf('y1_%d', k))]
    decades = log10(value(sprintf('x1_%d', k))/value(sprintf('x0_%d', k)))
    rises = log10(value(sprintf('y1_%d', k))/value(sprintf('y0_%d', k)))
    set xtics auto font small; set ytics auto font small; set format y '10^{%T}'
    if (decades < 2.4) { set xtics (1, 3, 10, 30, 100, 300, 1000, 3000, 10000, 30000) }
    if (decades < 1.4) { set xtics (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, \
        5000, 10000, 20000) }
    if (decades < 0.6) { set xtics (1, 2, 3, 5, 7, 10, 20, 30, 50, 70, 100, 200, 300, 500, 700, \
        1000, 2000, 3000, 5000, 7000, 10000, 20000) }
    if (rises < 1.5) { set format y '%g'; set ytics (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100) }
    set title value(sprintf('title_%d', k)) font 'DejaVu Sans Bold,18' \
        textcolor rgb ink offset 0,-0.6
    set xlabel value(sprintf('x_label_%d', k)) font ',16' textcolor rgb ink offset 0,0.4
    set ylabel (c == 0 ? y_label : '') textcolor rgb ink offset 1.5,0
    plot stem.'_front.csv' using (column('panel') == k ? column('cost') : NaN):'error' \
        with lines lw 2 lc rgb '#7fb8d8', \
         stem.'_leader.csv' using ($1 == k ? $2 : NaN):3 with lines lw 0.5 lc rgb '#bbbbbb', \
         stem.'_points.csv' using (points_of(k, 2, 0)):'error' with points pt 6 ps 0.9 lw 0.8 \
         lc rgb '#aaaaaa', \
         '' using (points_of(k, 1, 0)):'error' with points pt 5 ps 0.8 lc rgb '#f0b58c', \
         '' using (points_of(k, 2, 1)):'error' with points pt 6 ps 1.6 lw 1.6 lc rgb float_colour, \
         '' using (points_of(k, 1, 1)):'error' with points pt 5 ps 1.3 lc rgb integer_colour, \
         '' using (points_of(k, 0, 1)):'error' with points pt 7 ps 1.9 lc rgb ours_colour, \
         '' using (label_of(k)):'label_error':'label':(number[column('kind') + 1]) \
         with labels font small noenhanced textcolor rgb variable
    unset label 1000
}
unset title; unset xlabel; unset ylabel; unset border; unset tics; unset logscale; unset grid
set lmargin at screen 0; set rmargin at screen 1; set tmargin at screen 1; set bmargin at screen 0
set xrange [0:width]; set yrange [0:height]
lx = (width - 1000)/2. + 30; ly = legend_px/2
array entry[5] = ['ours', 'other integer code', 'floating point', 'best integer code', \
    'faint: the others']
array gap[5] = [0, 100, 360, 560, 800]
do for [k = 1:5] { set label k entry[k] at lx + gap[k] + 22, ly left font ',16' \
    textcolor rgb ink }
set arrow 1 from lx + gap[4] - 12, ly to lx + gap[4] + 14, ly nohead lw 2 lc rgb '#7fb8d8'
plot '+' using (lx):(ly) every ::0::0 with points pt 7 ps 1.9 lc rgb ours_colour, \
     '+' using (lx + gap[2]):(ly) every ::0::0 with points pt 5 ps 1.3 lc rgb integer_colour, \
     '+' using (lx + gap[3]):(ly) every ::0::0 with points pt 6 ps 1.6 lw 1.6 lc rgb float_colour, \
     '+' using (lx + gap[5]):(ly) every ::0::0 with points pt 5 ps 0.8 lc rgb '#f0b58c'
unset multiplot
unset output
