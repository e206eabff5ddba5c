# Frâncu 2016, figures 8.11 and 8.12. There conjugate gradients decay by jumps, regularised projection smoothly and
# slower, energy preserving projection slowest (8.11); damping by 10 h takes the motion away within a swing (8.12).
# Here Newmark's scheme gains energy on such a sheet, which folds: a curve that leaves the picture has burst.
eval picture(1060, 480)
set output "cloth_energy.png"
set multiplot layout 1, 2 margins 0.08, 0.76, 0.13, 0.92 spacing 0.28, 0
set xlabel "time, s"
set ylabel "energy over the start's, J" offset 1,0
of(curve, file) = rows('$1 == "' . curve . '"', file)
set title "Rubber, 10 × 10, 2 N/m: all of it"
set yrange [-2.5:1.5]
set key at graph 1.02, graph 1 left top
plot of("conjugate_gradients", "rubber_energy.csv") using 2:3 with lines lc rgb taut lw 2 title "CG, Euler", \
    of("gauss_seidel", "rubber_energy.csv") using 2:3 with lines lc rgb bare lw 2 title "GS, Euler", \
    of("gauss_seidel_newmark", "rubber_energy.csv") using 2:3 with lines lc rgb ode lw 2 title "GS, Newmark", \
    of("direct", "rubber_energy.csv") using 2:3 with lines lc rgb "#777777" dt 2 title "direct, Euler", \
    of("direct_newmark", "rubber_energy.csv") using 2:3 with lines lc rgb plain dt 2 title "direct, Newmark"
set title "40 × 40, 2 kN/m: motion and height"
set yrange [-5:0.5]
plot of("gauss_seidel", "damped_energy.csv") using 2:3 with lines lc rgb taut lw 2 title "GS, Euler", \
    of("gauss_seidel_10h", "damped_energy.csv") using 2:3 with lines lc rgb bare lw 2 title "GS, damped by 10 h", \
    of("gauss_seidel_newmark_h", "damped_energy.csv") using 2:3 with lines lc rgb ode lw 2 title "GS, Newmark, by h", \
    of("direct", "damped_energy.csv") using 2:3 with lines lc rgb "#777777" dt 2 title "direct, Euler", \
    of("direct_10h", "damped_energy.csv") using 2:3 with lines lc rgb plain dt 2 title "direct, by 10 h"
unset multiplot
