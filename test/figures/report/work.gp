# SPDX-License-Identifier: MIT
# Work-precision diagrams: what work.py has put into NAME.panels, NAME_points.csv and
# NAME_front.csv.
stem = data[1:strlen(data) - 4]
load stem.'.panels'
width = n_columns*panel_w + legend_px + 30
height = n_rows*panel_h + 20
load here.'/style.gp'
set multiplot
set logscale xy
set format y '10^{%T}'
set xtics font ',15'; set ytics font ',15'
unset key
points_of(k, kind, is_here) = (column('panel') == k && column('kind') == kind && column('here') == \
    is_here) ? column('cost') : NaN
do for [k = 1:n_panels] {
    c = (k - 1) % n_columns; r = (k - 1)/n_columns
    set lmargin at screen (30. + c*panel_w + 100)/width
    set rmargin at screen (30. + (c + 1)*panel_w - 20)/width
    set tmargin at screen 1 - (r*panel_h + 50)/height
    set bmargin at screen 1 - ((r + 1)*panel_h - 72)/height
    set xrange [value(sprintf('x0_%d', k)) : value(sprintf('x1_%d', k))]
    set yrange [value(sprintf('y0_%d', k)) : value(sprintf('y1_%d', k))]
    decades = log10(value(sprintf('x1_%d', k))/value(sprintf('x0_%d', k)))
    rises = log10(value(sprintf('y1_%d', k))/value(sprintf('y0_%d', k)))
    set xtics auto; set ytics auto; set format y '10^{%T}'
    if (decades < 2.2) { set xtics (1, 3, 10, 30, 100, 300, 1000, 3000, 10000, 30000) }
    if (decades < 2.2*panel_w/700) { set xtics (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, \
        5000, 10000, 20000) }
    if (decades < 0.8) { set xtics (1, 2, 3, 5, 7, 10, 20, 30, 50, 70, 100, 200, 300, 500, 700, \
        1000, 2000, 3000, 5000, 7000, 10000, 20000) }
    if (rises < 1.5) { set format y '%g'; set ytics (1, 2, 5, 10, 20, 50, 100) }
    set title value(sprintf('title_%d', k)) font 'DejaVu Sans Bold,17' \
        textcolor rgb ink offset 0,-0.6
    set xlabel value(sprintf('x_label_%d', k)) font ',16' textcolor rgb ink offset 0,0.3
    set ylabel (c == 0 ? y_label : '') font ',16' textcolor rgb ink offset 0,0
    plot stem.'_front.csv' using (column('panel') == k ? column('cost') : NaN):'error' \
        with lines lw 2 lc rgb '#9bb8e3', \
         stem.'_points.csv' using (points_of(k, 2, 0)):'error' with points pt 6 ps 1.3 lw 1 \
         lc rgb '#a9d3b0', \
         '' using (points_of(k, 1, 0)):'error' with points pt 5 ps 1.1 lc rgb '#f0c690', \
         '' using (points_of(k, 2, 1)):'error' with points pt 6 ps 1.5 lw 1.6 lc rgb float_colour, \
         '' using (points_of(k, 1, 1)):'error' with points pt 5 ps 1.3 lc rgb integer_colour, \
         '' using (points_of(k, 0, 1)):'error' with points pt 7 ps 1.9 lc rgb ours_colour, \
         '' using (column('panel') == k ? column('label_cost') \
         : NaN):'label_error':(stringcolumn('label')) with labels font ',14' textcolor rgb ink
}
unset title; unset xlabel; unset ylabel; unset border; unset tics; unset logscale; unset grid
set lmargin at screen 0; set rmargin at screen 1; set tmargin at screen 1; set bmargin at screen 0
set xrange [0:width]; set yrange [0:height]
array colour[3] = [ours_colour, integer_colour, float_colour]
lx = n_columns*panel_w + 50
line_px = n_names > 20 ? 27. : 31.
do for [k = 1:n_names] {
    set label 100 + k value(sprintf('name_%d', k)) at lx, height - 45 - line_px*k left \
        font ',15' noenhanced textcolor rgb colour[value(sprintf('name_kind_%d', k)) + 1]
}
y = height - 45 - line_px*(n_names + 1.7)
set label 1 'ours' at lx + 22, y textcolor rgb ours_colour font ',15'
set label 2 'integer code of others' at lx + 22, y - 28 textcolor rgb integer_colour font ',15'
set label 3 'floating point' at lx + 22, y - 56 textcolor rgb float_colour font ',15'
set label 4 'front of integer code' at lx + 22, y - 84 textcolor rgb ink font ',15'
set label 5 '*, faint: measured once elsewhere' at lx, y - 112 textcolor rgb away_colour font ',15'
set arrow 1 from lx - 12, y - 84 to lx + 14, y - 84 nohead lw 2 lc rgb '#9bb8e3'
plot '+' using (lx):(y) every ::0::0 with points pt 7 ps 1.9 lc rgb ours_colour, \
     '+' using (lx):(y - 28) every ::0::0 with points pt 5 ps 1.3 lc rgb integer_colour, \
     '+' using (lx):(y - 56) every ::0::0 with points pt 6 ps 1.5 lw 1.6 lc rgb float_colour
unset multiplot
unset output
