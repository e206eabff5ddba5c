# Frâncu 2016, figures 4.1, 8.11 and 8.12. There nonlinear and linear gradients, projection and exact linear steps are
# alike (4.1); gradients decay by jumps, regularised projection smoothly and slower, energy preserving projection
# slowest (8.11); damping by 10 h takes the motion away within a swing (8.12). Here linear gradients are without
# geometric stiffness, and Newmark's scheme gains energy on a sheet that folds, unless gamma is above 1/2, and on a stiff
# one in any case: a curve that leaves the picture has burst. 25 iterations leave the stiff sheet far from its forces.
eval picture(1460, 480)
set output "cloth_energy.png"
set multiplot layout 1, 3 margins 0.055, 0.855, 0.13, 0.92 spacing 0.175, 0
set xlabel "time, s"
set ylabel "energy over the start's, J" offset 1,0
of(curve, file) = rows('$1 == "' . curve . '"', file)
set title "15 × 15, 200 N/m: all of it"
set key at graph 1.02, graph 1 left top
set yrange [-1.5:1.5]
plot of("conjugate_gradients", "sheet_energy.csv") using 2:3 with lines lc rgb ode lw 2 title "NCG", \
    of("gauss_seidel", "sheet_energy.csv") using 2:3 with lines lc rgb plain lw 2 title "PBD", \
    of("linear_gradients", "sheet_energy.csv") using 2:3 with lines lc rgb bare lw 2 title "CG, linear, no K", \
    of("direct", "sheet_energy.csv") using 2:3 with lines lc rgb taut lw 2 title "exact, linear"
set title "Rubber, 10 × 10, 2 N/m: all of it"
set yrange [-2.5:1.5]
set key at graph 1.02, graph 1 left top
plot of("conjugate_gradients", "rubber_energy.csv") using 2:3 with lines lc rgb taut lw 2 title "CG, Euler", \
    of("gauss_seidel", "rubber_energy.csv") using 2:3 with lines lc rgb bare lw 2 title "GS, Euler", \
    of("gauss_seidel_newmark", "rubber_energy.csv") using 2:3 with lines lc rgb ode lw 2 title "GS, Newmark", \
    of("gauss_seidel_newmark_0.55", "rubber_energy.csv") using 2:3 with lines lc rgb bullet lw 2 \
    title "the same, γ 0.55", \
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
