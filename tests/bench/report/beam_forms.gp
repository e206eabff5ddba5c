# Tournier et al. 2015, section 4.2: a soft cantilever as compliance and as stiffness gives similar results; without
# geometric stiffness it oscillates across.
eval picture(900, 420)
set output "beam_forms.png"
set title "A cantilever of 200 tetrahedra, 1 MPa: sink of its end"
set xlabel "time, s"
set ylabel "sink, mm"
of(form) = rows('$1 == "' . form . '"', "beam_forms.csv")
plot of("stiffness") using 2:(1e3 * $3) with lines lc rgb taut lw 4 title "stiffness", \
    of("compliance") using 2:(1e3 * $3) with lines lc rgb bullet lw 1.5 title "compliance", \
    of("compliance_without") using 2:(1e3 * $3) with lines lc rgb bare lw 1.5 dt 2 title "the same without K"
