# The main picture: joint gap against mass ratio.
eval picture(900, 500)
set output "mass_ratio.png"
set title "Ten 1 kg links and a weight fall from horizontal, 10 s at 60 Hz: largest gap of a joint"
set logscale xy
eval ratios
set yrange [0.002:1e5]
set format y "%g %%"
set ylabel "gap, % of a link's length"
set object 1 rectangle from graph 0, first 25 to graph 1, graph 1 fillcolor rgb faint fillstyle solid noborder behind
set label 1 "burst: open by more than a quarter of a link" at first 1, first 40000 textcolor rgb bare
held(engine) = rows('$1 == "' . engine . '"', "mass_ratio.csv")
burst(engine) = rows('$5 && $1 == "' . engine . '"', "mass_ratio.csv")
plot held("taut") using 3:4 with linespoints lc rgb taut lw 3 pt 7 ps 1.1 title "Taut", \
    held("bullet_4") using 3:4 with lines lc rgb bullet lw 2 title "Bullet, 4 substeps", \
    held("ode_4") using 3:4 with lines lc rgb ode lw 2 title "ODE, 4 substeps", \
    held("bullet") using 3:4 with lines lc rgb bullet lw 1.5 dt 2 title "Bullet, 1 step", \
    held("ode") using 3:4 with lines lc rgb ode lw 1.5 dt 2 title "ODE, 1 step", \
    for [e in "bullet_4 bullet"] burst(e) using 3:4 with points lc rgb bullet pt 2 ps 1.3 lw 2 notitle, \
    for [e in "ode_4 ode"] burst(e) using 3:4 with points lc rgb ode pt 2 ps 1.3 lw 2 notitle, \
    burst("taut") using 3:4 with points lc rgb taut pt 2 ps 1.3 lw 2 notitle, \
    NaN with points lc rgb "#555555" pt 2 ps 1.3 lw 2 title "burst"
