# Tournier et al. 2015, table 2: largest condition number while a stiff sheet of 10 x 10 falls, and MINRES on a sheet of
# 1 GPa: there some 1000 iterations of the compliance form, and none to 10000 of the stiffness form. Here the stiffness
# form's residual falls at once and tells nothing: a tenth of the velocity takes it three times as many iterations as
# the compliance form. Both go on slowly, the stiffness form, which is positive definite, less so.
eval picture(1060, 480)
set output "table2.png"
set multiplot layout 1, 2 margins 0.08, 0.76, 0.13, 0.92 spacing 0.30, 0
set logscale y
set yrange [10:1e17]
set format y "10^{%T}"
set xlabel "time, s"
set xtics 0.2
set ylabel "condition number" offset 1,0
set title "A sheet of 10 × 10 falls"
set key at graph 1.02, graph 1 left top
of(element, form) = rows(sprintf('$1 == "%s" && $2 == "%s"', element, form), "conditioning.csv")
plot of("links", "stiffness") using 3:4 with linespoints lc rgb bare lw 2 pt 5 title "links, stiffness", \
    1e12 with lines lc rgb bare dt 3 title "in the paper", \
    of("links", "compliance") using 3:4 with linespoints lc rgb taut lw 2 pt 7 title "links, compliance", \
    1e5 with lines lc rgb taut dt 3 title "in the paper", \
    of("triangles", "stiffness") using 3:4 with linespoints lc rgb bullet lw 2 pt 4 title "FEM, stiffness", \
    1e6 with lines lc rgb bullet dt 3 title "in the paper", \
    of("triangles", "compliance") using 3:4 with linespoints lc rgb ode lw 2 pt 6 title "FEM, compliance", \
    1e3 with lines lc rgb ode dt 3 title "in the paper"
set title "Minimum residuals, 20 × 20, 1 GPa m"
set logscale x
set xtics auto
set xrange [1:1e4]
set yrange [1e-10:100]
set xlabel "iterations"
set ylabel "error of the velocity" offset 1,0
set key at graph 1.02, graph 1 left top
curve(form, scaled) = rows(sprintf('$1 == "%s" && $2 == %d', form, scaled), "minres.csv")
plot curve("stiffness", 0) using 3:5 with lines lc rgb bare lw 2 title "stiffness", \
    curve("compliance", 0) using 3:5 with lines lc rgb taut lw 2 title "compliance", \
    curve("stiffness", 1) using 3:5 with lines lc rgb bullet lw 2 dt 2 title "stiffness, scaled", \
    curve("compliance", 1) using 3:5 with lines lc rgb ode lw 2 dt 2 title "compliance, scaled", \
    curve("stiffness", 0) using 3:4 with lines lc rgb bare dt 3 title "stiffness, residual", \
    curve("compliance", 0) using 3:4 with lines lc rgb taut dt 3 title "compliance, residual"
unset multiplot
