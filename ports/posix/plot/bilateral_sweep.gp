# SPDX-License-Identifier: MIT
# What is felt over delay, jitter and loss: stiffness as a share of that over a perfect link,
# and missed contacts. A column per loss, a line per jitter.
#
#   gnuplot -e "data='sweep.csv'; jitters='0 0.5 1'; losses='0 0.1'; ..." bilateral_sweep.gp
#
#   data         delay_s,jitter,loss,approaches,felt,missed,early,same_bits,share
#                (exhand-lab bilateral --sweep); delay of one way, jitter as a share of it
#   jitters, losses   values in data, in its order (losses run fastest), spaces between them
#   speed        m/s of string; ray_mm: from where walls are seen; fps: frames of the world
#   allowed_ms   delay there and back up to which a wall is known in time by the advice
# Optional:
#   out          PNG to write                            (sweep.png)

if (!exists("out")) out = 'sweep.png'

n = words(losses)
width = 200.0 + 520*n
set terminal pngcairo size width,1000 font 'DejaVu Sans,20' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','

ink = '#333333'
array colour[4] = ['#1f5fbf', '#e67e00', '#7a1fa2', '#1a8f2e']
array mark[4] = [7, 5, 9, 11]
tint(i) = colour[(i-1) % 4 + 1]

stats data using (column('felt')) name 'FELT' nooutput
stats data using (column('same_bits')) name 'SAME' nooutput
set multiplot
set lmargin at screen 0; set rmargin at screen 1
set tmargin at screen 1; set bmargin at screen 0
unset border; unset tics; unset title
set xrange [0:1]; set yrange [0:1]
set key at screen 0.5, screen 0.985 center top horizontal Left \
    reverse maxrows 1 samplen 1.6 width -6 \
    textcolor rgb ink
plot for [i = 1:words(jitters)] NaN with linespoints lc rgb tint(i) lw 2.2 pt mark[i] ps 1.4 \
         title (real(word(jitters, i)) == 0 ? 'no jitter' : sprintf('jitter +- %g %% of delay', \
         100*real(word(jitters, i)))), \
     NaN with lines lc rgb '#333333' lw 1.6 dt (7,5) title 'advised up to here'
set key off
set label 9 sprintf('walls seen from %s mm, world at %s frames/s, %s m/s of string; '. \
    '%.0f of %.0f contacts that are felt have every bit of the perfect link', \
    ray_mm, fps, speed, SAME_sum, FELT_sum) at screen 0.5, screen 0.935 center noenhanced \
    textcolor rgb ink font ',17'
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set xrange [-3:103]
set xtics nomirror 20

rows = n*words(jitters)
do for [c = 1:n] {
    first(i) = (i-1)*n + c-1
    LOSS = real(word(losses, c))
    set lmargin at screen (160.0 + 520*(c-1)) / width
    set rmargin at screen (160.0 + 520*(c-1) + 470) / width
    near(i) = 0.7*(i - 2) # side by side where they are the same
    set arrow 1 from first allowed_ms, graph 0 to first allowed_ms, \
        graph 1 nohead lc rgb '#333333' lw 1.6 dt (7,5)
    set title sprintf('{/:Bold %g %% lost}, each way', 100*LOSS) textcolor rgb ink offset 0,-0.6
    set tmargin at screen 0.84; set bmargin at screen 0.50
    set format x ''; unset xlabel
    set yrange [0:1.25]; set ytics nomirror 0.25
    if (c == 1) { set format y '%g'; \
        set ylabel "stiffness of what is felt,\nshare of the perfect link's" textcolor rgb ink } \
        else { set format y ''; unset ylabel }
    plot for [i = 1:words(jitters)] data every rows::first(i) \
        using (2e3*column('delay_s') + near(i)): \
        (column('share')) with linespoints lc rgb tint(i) lw 2.2 pt mark[i] ps 1.4
    unset title; unset label 9
    set tmargin at screen 0.45; set bmargin at screen 0.11
    set format x '%g'; set xlabel 'delay there and back (ms)' textcolor rgb ink
    set yrange [-4:104]; set ytics nomirror 25
    if (c == 1) { set ylabel 'missed contacts (%)' textcolor rgb ink }
    plot for [i = 1:words(jitters)] data every rows::first(i) \
        using (2e3*column('delay_s') + near(i)): \
        (100.0*column('missed')/column('approaches')) with linespoints \
        lc rgb tint(i) lw 2.2 pt mark[i] ps 1.4
}
unset multiplot
unset output
