# Loaded before each of the other scripts, which read CSV files of the folder they run in and draw into it.
set datafile separator comma
set encoding utf8
picture(width, height) = sprintf("set terminal pngcairo size %d,%d font 'DejaVu Sans,11' enhanced", width, height)
rows(condition, file) = sprintf("< awk -F, 'NR > 1 && (%s)' %s", condition, file)

taut = "#0b62b0"
bullet = "#d9730d"
ode = "#2e8b57"
bare = "#b3261e"
plain = "#6a4c93"
faint = "#fbeae8"

set border 3 lc rgb "#555555"
set tics nomirror textcolor rgb "#333333"
set grid lc rgb "#dddddd" lt 1
set key outside right center Left reverse samplen 2.5 spacing 1.25

# Of a link's mass to the weight's.
ratios = 'set xtics ("1:1" 1, "1:10" 10, "1:100" 100, "1:1000" 1e3, "1:10 000" 1e4, "1:100 000" 1e5, "1:10^6" 1e6);' . \
    'set mxtics 1; set xrange [0.8:1.3e6]; set xlabel "mass of a link : mass of the weight"'
