# Frâncu 2016, figures 8.8 and 8.10. There Gauss-Seidel and improved Jacobi lie together, Sequential Positions lower in
# overlap, and in velocity only from some iterations on: velocity time stepping leaves gamma overlap / h of it however
# often it iterates, Sequential Positions (1 - k_v)^n overlap / h.
eval picture(1060, 420)
set output "grains.png"
set multiplot layout 1, 2 margins 0.08, 0.78, 0.14, 0.9 spacing 0.1, 0
of(method, file) = rows('$1 == "' . method . '"', file)
set logscale y
set format y "10^{%T}"
set yrange [1e-2:1e2]
set title "3000 grains without friction, 15 iterations"
set xlabel "frame"
set ylabel "sum of overlaps, m" offset 1,0
unset key
plot of("gauss_seidel", "grains_error.csv") using 2:3 with lines lc rgb taut lw 2, \
    of("improved_jacobi", "grains_error.csv") using 2:3 with lines lc rgb bare lw 2, \
    of("sequential_positions", "grains_error.csv") using 2:3 with lines lc rgb plain lw 2
unset logscale y
set format y "%g"
set yrange [0:0.06]
set title "1000 grains, first 100 frames"
set xlabel "iterations"
set ylabel "mean velocity along contacts, m/s"
set key at graph 1.04, graph 1 left top
plot of("gauss_seidel", "grains_velocity.csv") using 2:3 with linespoints lc rgb taut lw 2 pt 7 ps 0.5 title "VTS, GS", \
    of("improved_jacobi", "grains_velocity.csv") using 2:3 with linespoints lc rgb bare lw 2 pt 7 ps 0.5 \
    title "VTS, Jacobi", \
    of("sequential_positions", "grains_velocity.csv") using 2:3 with linespoints lc rgb plain lw 2 pt 7 ps 0.5 \
    title "Sequential P."
unset multiplot
