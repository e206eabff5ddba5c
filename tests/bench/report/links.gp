# Joint gap and cost against the number of links.
eval picture(1060, 720)
set output "links.png"
set multiplot layout 2, 2 margins 0.10, 0.81, 0.08, 0.95 spacing 0.12, 0.16
set logscale xy
set xrange [4:250]
set xtics (5, 10, 20, 50, 100, 200)
set xlabel "links"
set format y "%g %%"
set ylabel "gap, % of a link's length" offset 1,0
set yrange [0.002:1e5]
set object 1 rectangle from graph 0, first 25 to graph 1, graph 1 fillcolor rgb faint fillstyle solid noborder behind
of(engine, ratio) = rows(sprintf('$1 == "%s" && $3 == %d', engine, ratio), "links.csv")
burst(engine, ratio) = rows(sprintf('$5 && $1 == "%s" && $3 == %d', engine, ratio), "links.csv")
gap(ratio) = sprintf("ratio = %d; plot ", ratio) . \
    "of('taut', ratio) using 2:4 with linespoints lc rgb taut lw 3 pt 7 notitle," . \
    "of('bullet_4', ratio) using 2:4 with lines lc rgb bullet lw 2 notitle," . \
    "of('ode_4', ratio) using 2:4 with lines lc rgb ode lw 2 notitle," . \
    "of('bullet', ratio) using 2:4 with lines lc rgb bullet lw 1.5 dt 2 notitle," . \
    "of('ode', ratio) using 2:4 with lines lc rgb ode lw 1.5 dt 2 notitle," . \
    "for [e in 'bullet_4 bullet'] burst(e, ratio) using 2:4 with points lc rgb bullet pt 2 ps 1.2 lw 2 notitle," . \
    "for [e in 'ode_4 ode'] burst(e, ratio) using 2:4 with points lc rgb ode pt 2 ps 1.2 lw 2 notitle," . \
    "burst('taut', ratio) using 2:4 with points lc rgb taut pt 2 ps 1.2 lw 2 notitle"
set title "Largest gap of a joint, 1:1"
eval gap(1)
set title "Largest gap of a joint, 1:100"
eval gap(100)
set title "Largest gap of a joint, 1:1000"
eval gap(1000)
unset object 1
set title "Cost of a frame, 1:100, one thread"
set yrange [1:1e5]
set format y "%g"
set ylabel "median, µs" offset 1,0
set key at graph 1.05, graph 1.9 left center
plot of("taut", 100) using 2:7 with linespoints lc rgb taut lw 3 pt 7 title "Taut", \
    of("taut", 100) using 2:8 with lines lc rgb taut lw 1.5 dt 3 title "one solve of Taut", \
    of("bullet_4", 100) using 2:7 with lines lc rgb bullet lw 2 title "Bullet, 4 substeps", \
    of("ode_4", 100) using 2:7 with lines lc rgb ode lw 2 title "ODE, 4 substeps", \
    of("bullet", 100) using 2:7 with lines lc rgb bullet lw 1.5 dt 2 title "Bullet, 1 step", \
    of("ode", 100) using 2:7 with lines lc rgb ode lw 1.5 dt 2 title "ODE, 1 step", \
    NaN with points lc rgb "#555555" pt 2 ps 1.2 lw 2 title "burst"
unset multiplot
