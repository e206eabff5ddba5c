# Table 1 of Tournier et al. 2015. The paper's own errors beside ours.
eval picture(900, 500)
set output "table1.png"
set title "10 m of cable, 500 kg, with a load: elongation in 10 s, one step of 10 ms a frame"
set logscale xy
set xrange [0.3:3e15]
set yrange [1e-14:1e7]
set format y "10^{%T} %%"
set xtics ("1 t" 1, "10^3 t" 1e3, "10^6 t" 1e6, "10^9 t" 1e9, "10^{12} t" 1e12, "10^{15} t" 1e15)
set mxtics 1
set mytics 1
set ytics 1000
set xlabel "load"
set ylabel "elongation"
set key title "Geometric stiffness:" left
$paper << END
1,5e-14
1e3,1e-13
1e6,9e-9
1e9,7e-9
1e12,8e-6
1e15,0.009
END
found(rods, stiffness) = rows(sprintf("$1 == %d && $3 == %d", rods, stiffness), "table1.csv")
held(rods) = rows(sprintf("$1 == %d && $3 == 0 && !$5", rods), "table1.csv")
burst(rods) = rows(sprintf("$1 == %d && $5", rods), "table1.csv")
plot found(10, 1) using 2:4 with linespoints lc rgb taut lw 3 pt 7 ps 1.1 title "with, 10 rods", \
    found(50, 1) using 2:4 with linespoints lc rgb taut lw 2 pt 6 ps 1.3 title "with, 50 rods", \
    $paper using 1:2 with linespoints lc rgb "#777777" lw 1.5 dt 2 pt 4 title "with, in the paper", \
    held(10) using 2:4 with points lc rgb bare pt 5 ps 1.1 title "without, 10 rods", \
    held(50) using 2:4 with points lc rgb bare pt 4 ps 1.3 lw 2 title "without, 50 rods", \
    burst(10) using 2:4 with points lc rgb bare pt 2 ps 1.4 lw 2 title "without: burst", \
    burst(50) using 2:4 with points lc rgb bare pt 2 ps 1.4 lw 2 notitle
