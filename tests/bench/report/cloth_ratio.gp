# Tournier et al. 2015, section 4: a weight of up to 500 sheets on the free edge of a sheet of 20 x 20 that hangs by two
# corners. The paper tells that a weight of 1:500 is held in real time, and no figures.
eval picture(900, 500)
set output "cloth_ratio.png"
set title "A sheet of 20 × 20 links and a weight fall, 4 s at 60 Hz: largest stretch"
set logscale xy
set xtics ("1:1" 1, "1:10" 10, "1:100" 100, "1:500" 500)
set mxtics 1
set xrange [0.8:650]
set xlabel "mass of the sheet : mass of the weight"
set format y "%g %%"
set ylabel "stretch"
of(engine) = rows('$6 && $1 == "' . engine . '"', "cloth_ratio.csv")
lost(engine) = rows('!$6 && $1 == "' . engine . '"', "cloth_ratio.csv")
plot of("taut") using 2:3 with linespoints lc rgb taut lw 3 pt 7 ps 1.1 title "Taut, ever", \
    of("taut") using 2:4 with linespoints lc rgb taut lw 1.5 dt 2 pt 6 title "Taut, at the end", \
    of("taut_no_k") using 2:3 with linespoints lc rgb bare lw 2 pt 5 title "no geometric stiffness, ever", \
    of("taut_no_k") using 2:4 with linespoints lc rgb bare lw 1.5 dt 2 pt 4 title "the same, at the end", \
    of("bullet") using 2:3 with linespoints lc rgb bullet lw 2 pt 9 title "Bullet, ever", \
    of("bullet_4") using 2:3 with linespoints lc rgb bullet lw 2 dt 2 pt 8 title "Bullet, 4 substeps", \
    lost("taut_no_k") using 2:(1e4) with points lc rgb bare pt 2 ps 1.4 lw 2 title "burst", \
    lost("taut") using 2:(1e4) with points lc rgb taut pt 2 ps 1.4 lw 2 notitle
