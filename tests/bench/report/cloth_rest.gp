# Frâncu 2016, figures 6.3 and 8.7. There conjugate residuals are below Gauss-Seidel from 4 iterations on (6.3), and
# improved Jacobi is below SOR below Gauss-Seidel (8.7).
eval picture(1060, 480)
set output "cloth_rest.png"
set multiplot layout 1, 2 margins 0.08, 0.76, 0.13, 0.92 spacing 0.10, 0
set logscale y
set format y "10^{%T}"
set ylabel "mean strain of a link" offset 1,0
methods = "gauss_seidel sor_1.2 accelerated_jacobi improved_jacobi_0.5 minimum_residual conjugate_residuals direct"
names = "'Gauss-Seidel' 'SOR, ω = 1.2' 'Jacobi, Nesterov' 'improved Jacobi, ω = 0.5' 'minimum residual' " . \
    "'conjugate residuals' 'direct'"
array hues = [0x2e8b57, 0x8fbc8f, 0xb3261e, 0xe08a84, 0xd9730d, 0x6a4c93, 0x0b62b0]
of(method, file) = rows('$1 == "' . method . '"', file)
set title "50 × 50 at rest, steps of 8 ms"
set xlabel "iterations"
unset key
plot for [i = 1:6] of(word(methods, i), "cloth_rest.csv") using 2:3 with linespoints lc rgb hues[i] lw 2 pt 7
set title "100 × 100, steps of 16 ms, 15 iterations"
set xlabel "time, s"
set key at graph 1.03, graph 0.9 left top
plot for [i = 1:7] of(word(methods, i), "cloth_large.csv") using 2:3 with lines lc rgb hues[i] lw 2 title word(names, i)
unset multiplot
