# Error left against iterations and against time, for every solver.
eval picture(1180, 1080)
set output "solvers.png"
set multiplot layout 4, 2 margins 0.08, 0.72, 0.05, 0.96 spacing 0.1, 0.09
set logscale xy
set format y "10^{%T}"
names = "gauss_seidel sor_1.2 jacobi accelerated_jacobi_nesterov accelerated_jacobi_power minimum_residual minimum_residual_fixed conjugate_residuals conjugate_gradients"
of(scene, solver) = rows(sprintf('$1 == "%s" && $2 == "%s"', scene, solver), "solvers.csv")
set style increment user
array colour[9] = ["#0b62b0", "#6db3f2", "#999999", "#d9730d", "#e8b04a", "#2e8b57", "#8fcfa8", "#b3261e", "#6a4c93"]
do for [s in "net grains3000 boxes2000 bridge"] {
    set title s noenhanced
    set ylabel "mean error of a row, m" offset 1,0
    set xlabel "iterations"
    unset key
    plot for [i = 1:9] of(s, word(names, i)) using 3:4 with linespoints lc rgb colour[i] lw 2 pt 7 ps 0.5 notitle
    unset ylabel
    set xlabel "time of the substep, ms"
    set title ""
    # The legend beside the first two scenes, for a key is no higher than its plot.
    first = s eq "net" ? 1 : 6
    if (s eq "net" || s eq "grains3000") { set key at graph 1.04, graph 1 left top Left reverse noenhanced }
    plot for [i = 1:9] of(s, word(names, i)) using 5:4 with linespoints lc rgb colour[i] lw 2 pt 7 ps 0.5 \
        title (i >= first && i < first + 5 ? word(names, i) : "")
}
unset multiplot
