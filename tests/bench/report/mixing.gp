# Frâncu 2016, section 8.3 and figure 8.14: a thousand grains fall on a sheet, by projection (PBD), velocity time
# stepping (VTS) and mixtures of the two. A curve ends where the sheet has burst: contacts after links put heavy grains
# on light links, which know of it in the next step only.
eval picture(1060, 420)
set output "mixing.png"
set multiplot layout 1, 2 margins 0.08, 0.76, 0.14, 0.9 spacing 0.1, 0
names = "position_based velocity links_first velocity_first post_stabilised sequential_positions"
array label[6] = ["PBD", "VTS", "links by PBD, then VTS", "VTS, then PBD", "VTS, positions after", "Sequential Positions"]
array colour[6] = [bare, taut, bullet, ode, "#777777", plain]
of(method) = rows('$1 == "' . method . '"', "mixing.csv")
set xlabel "time, s"
set logscale y
set format y "10^{%T}"
set title "Links of the sheet"
set ylabel "mean strain" offset 1,0
unset key
plot for [i = 1:6] of(word(names, i)) using 2:3 with lines lc rgb colour[i] lw 2
set title "Grains"
set ylabel "root mean square speed, m/s"
set key at graph 1.02, graph 1 left top
plot for [i = 1:6] of(word(names, i)) using 2:4 with lines lc rgb colour[i] lw 2 title label[i]
unset multiplot
