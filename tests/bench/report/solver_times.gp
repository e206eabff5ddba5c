# Frâncu 2016, tables 8.1 (two cores), 8.2 (four) and 8.3 (one thread): there on a Core i5-3317U and a Core i7 3770.
eval picture(1000, 460)
set output "solver_times.png"
set title "A frame by Gauss-Seidel and by accelerated Jacobi, 15 iterations in one step of 16 ms"
set logscale y
set ylabel "median, ms"
set yrange [0.5:500]
set style data histograms
set style histogram clustered gap 2
set style fill solid 0.9 noborder
set xtics rotate by 0 noenhanced
of(solver, threads) = rows(sprintf('$2 == "%s" && $3 == %d', solver, threads), "solver_times.csv")
plot of("gauss_seidel", 1) using 4:xtic(1) lc rgb ode title "Gauss-Seidel", \
    of("gauss_seidel", 2) using 4 lc rgb "#8fbc8f" title "the same, 2 threads", \
    of("accelerated_jacobi", 1) using 4 lc rgb bare title "Jacobi", \
    of("accelerated_jacobi", 2) using 4 lc rgb "#e08a84" title "the same, 2 threads", \
    of("gauss_seidel", 1) using 5 lc rgb "#333333" title "thesis: Gauss-Seidel, 1", \
    of("accelerated_jacobi", 1) using 5 lc rgb "#777777" title "thesis: Jacobi, 1", \
    of("gauss_seidel", 1) using 6 lc rgb "#999999" title "thesis: Gauss-Seidel, 2", \
    of("accelerated_jacobi", 1) using 6 lc rgb "#bbbbbb" title "thesis: Jacobi, 2"
