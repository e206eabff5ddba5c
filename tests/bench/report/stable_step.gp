# Fig. 5 of Tournier et al. 2015. Steps of 0 in the file: none from 0.1 ms on.
eval picture(900, 500)
set output "stable_step.png"
set title "Ten 1 kg links and a weight, one step a frame: the largest step that holds for 10 s"
set logscale xy
eval ratios
set yrange [8e-5:0.2]
set ylabel "step"
set ytics ("0.1 ms" 1e-4, "1 ms" 1e-3, "10 ms" 1e-2, "100 ms" 0.1, "1/60 s" 1/60.0)
set arrow 1 from graph 0, first 0.1 to graph 1, first 0.1 nohead lc rgb "#777777" dt 3
set label 1 "longest step of the interface" at first 1, first 0.13 textcolor rgb "#777777"
some(step) = step > 0 ? step : NaN
none(step) = step > 0 ? NaN : 1e-4
set key title "Geometric stiffness:" left
file = "stable_step.csv"
plot file using 1:(some($2)) every ::1 with linespoints lc rgb taut lw 3 pt 7 ps 1.1 title "with, from rest", \
    file using 1:(some($4)) every ::1 with linespoints lc rgb taut lw 2 dt 2 pt 6 ps 1.3 title "with, violent starts", \
    file using 1:(some($6)) every ::1 with linespoints lc rgb "#2a9d5c" lw 2 pt 9 title "adaptive, from rest", \
    file using 1:(some($7)) every ::1 with linespoints lc rgb "#2a9d5c" lw 2 dt 2 pt 8 title "adaptive, violent", \
    file using 1:(some($3)) every ::1 with linespoints lc rgb bare lw 3 pt 5 title "without, from rest", \
    file using 1:(some($5)) every ::1 with linespoints lc rgb bare lw 2 dt 2 pt 4 title "without, violent starts", \
    for [c in "3 5"] file using 1:(none(column(c + 0))) every ::1 with points lc rgb bare pt 11 ps 1.5 notitle, \
    NaN with points lc rgb bare pt 11 ps 1.5 title "none from 0.1 ms on"
