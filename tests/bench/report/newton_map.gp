# Gast and Schroeder 2014, figure 2. The cross is where the end rests.
eval picture(1240, 450)
set output "newton_map.png"
set multiplot layout 2, 6 title \
    "Newton's steps in one step of time, by where an end of a bar of twelve vertices begins" \
    margins 0.045, 0.885, 0.03, 0.86 spacing 0.008, 0.02
set palette defined (0 "black", 15 "blue", 30 "cyan", 30.01 "red", 36 "red")
set cbrange [0:36]
set cbtics ("0" 0, "15" 15, "30 or more" 29.5, "not in 500" 33) scale 0
set colorbox user origin screen 0.9, 0.05 size screen 0.014, 0.8
set border 15
unset xtics
unset ytics
unset grid
unset key
set size ratio -1
set xrange [-0.5:79.5]
set yrange [-0.5:79.5]
steps = '"1/4080 s" "1/960 s" "1/480 s" "1/240 s" "1/24 s" "1 s"'
rows_of = '"without search" "with line search"'
colour(solves) = solves >= 500 ? 36 : solves > 30 ? 30 : solves
set arrow 1 from graph 0.57, 0.5 to graph 0.63, 0.5 nohead front lc rgb "white"
set arrow 2 from graph 0.6, 0.47 to graph 0.6, 0.53 nohead front lc rgb "white"
do for [searched = 0:1] {
    do for [step = 1:6] {
        if (searched == 0) { set title word(steps, step) } else { unset title }
        if (step == 1) { set ylabel word(rows_of, searched + 1) } else { unset ylabel }
        if (step == 6 && searched == 1) { set colorbox } else { unset colorbox }
        plot rows(sprintf('$1 == %d && $2 == %d', step, searched), "newton_map.csv") using 3:4:(colour($5)) with image
    }
}
unset multiplot
