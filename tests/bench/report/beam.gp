# A cantilever of 1600 tetrahedra. This mesh converges to 0.87 of theory's sink, near incompressibility to 0.74: linear
# tetrahedra lock.
eval picture(900, 460)
set output "beam.png"
set title "A cantilever: sink of its tip over theory, mean of the fifth second"
set logscale xy
set xtics ("1 MPa" 1, "10 MPa" 10, "100 MPa" 100)
set mxtics 1
set xrange [0.7:140]
set yrange [0.5:40]
set ytics (0.5, 1, 2, 5, 10, 20)
set xlabel "Young's modulus"
set ylabel "of theory"
of(solve, nu) = rows(sprintf('$3 == "%s" && $2 == "%s" && $5', solve, nu), "beam.csv")
plot 0.87 with lines lc rgb "#777777" dt 3 title "this mesh, ν = 0.30", \
    0.74 with lines lc rgb "#777777" dt 4 title "this mesh, ν = 0.49", \
    of("direct", "0.30") using 1:4 with linespoints lc rgb taut lw 3 pt 7 ps 1.1 title "direct, ν = 0.30", \
    of("direct", "0.49") using 1:4 with linespoints lc rgb taut lw 2 pt 6 ps 1.3 title "direct, ν = 0.49", \
    of("swept", "0.30") using 1:4 with linespoints lc rgb plain lw 2 pt 9 title "swept, ν = 0.30", \
    of("swept", "0.49") using 1:4 with linespoints lc rgb plain lw 2 dt 2 pt 8 title "swept, ν = 0.49"
