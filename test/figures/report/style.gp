# SPDX-License-Identifier: MIT
# What all pictures of the report have in common. Given by report.py: data (NAME.csv), out
# (NAME.png), here (this directory).
if (!exists("width")) width = 1500
if (!exists("height")) height = 950
set terminal pngcairo size width,height font 'DejaVu Sans,18' linewidth 1.6 background '#ffffff'
set output out
set datafile separator ','
set encoding utf8
ink = '#333333'
ours_colour = '#0072b2'
integer_colour = '#d55e00'
float_colour = '#000000'
away_colour = '#999999'
bad_colour = '#cc79a7'
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.5 textcolor rgb ink
set grid lc rgb '#dddddd' lw 0.6 lt 1
set key textcolor rgb ink
