# Energy against time, a gentle swing and a violent fall.
eval picture(900, 640)
set output "energy.png"
set multiplot layout 2, 1 margins 0.09, 0.77, 0.09, 0.94 spacing 0, 0.16
set yrange [0:1.1]
set ylabel "total energy, start = 1"
set xlabel "time, s"
set key at graph 1.02, graph 1 left top invert
plots = "plot file using 1:5 every ::1 with lines lc rgb bullet lw 1.5 dt 2 title 'Bullet, 1 step'," . \
    "file using 1:7 every ::1 with lines lc rgb ode lw 1.5 dt 2 title 'ODE, 1 step'," . \
    "file using 1:6 every ::1 with lines lc rgb bullet lw 2 title 'Bullet, 4 substeps'," . \
    "file using 1:8 every ::1 with lines lc rgb ode lw 2 title 'ODE, 4 substeps'," . \
    "file using 1:4 every ::1 with lines lc rgb bare lw 2 dt 2 title 'without stiffness'," . \
    "file using 1:3 every ::1 with lines lc rgb plain lw 2 title 'implicit Euler'," . \
    "file using 1:2 every ::1 with lines lc rgb taut lw 2.5 title 'Taut'"
set title "Swing from 30 degrees, 1:10 (ODE and no stiffness lie under Taut)"
file = "energy_swing.csv"
eval plots
set title "Fall from horizontal, 1:1000 (a curve that leaves the picture has burst)"
file = "energy_fall.csv"
set yrange [-0.25:1.5]
unset key
eval plots
unset multiplot
