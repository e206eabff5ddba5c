# Frâncu 2016, figures 8.3 and 8.4: there 50 x 50 on a Core i7 3770 at 8 ms, conjugate residuals below Gauss-Seidel at
# equal iterations (8.3); 35 iterations of Gauss-Seidel take 7.7 ms, 12 of conjugate residuals 5 ms (8.4).
eval picture(1060, 480)
set output "cloth_solvers.png"
set multiplot layout 1, 2 margins 0.08, 0.77, 0.13, 0.92 spacing 0.10, 0
set logscale y
set xlabel "time, s"
set ylabel "mean strain of a link" offset 1,0
set format y "10^{%T}"
set title "50 × 50, steps of 8 ms, 30 iterations"
unset key
methods = "gauss_seidel sor_1.2 accelerated_jacobi minimum_residual conjugate_residuals direct"
names = "'Gauss-Seidel' 'SOR, ω = 1.2' 'accelerated Jacobi' 'minimum residual' 'conjugate residuals' 'direct'"
array hues = [0x2e8b57, 0x8fbc8f, 0xb3261e, 0xd9730d, 0x6a4c93, 0x0b62b0]
of(method, file) = rows('$1 == "' . method . '"', file)
plot for [i = 1:6] of(word(methods, i), "cloth_solvers.csv") using 2:3 with lines lc rgb hues[i] lw 2
set title "Cost of a step, one thread"
set xlabel "iterations"
set ylabel "median, ms"
set format y "%g"
set key at graph 1.05, graph 0.9 left top
plot for [i = 1:5] of(word(methods, i), "cloth_solvers_cost.csv") using 2:3 with linespoints lc rgb hues[i] lw 2 \
        pt 7 title word(names, i), \
    of("direct", "cloth_solvers_cost.csv") using 2:3 with points lc rgb hues[6] pt 5 title "direct, no iterations", \
    "+" using (35):(7.7) every ::0::0 with points lc rgb hues[1] pt 2 ps 1.5 lw 2 title "thesis: Gauss-Seidel", \
    "+" using (12):(5) every ::0::0 with points lc rgb hues[5] pt 2 ps 1.5 lw 2 title "thesis: conj. residuals"
unset multiplot
