# The tables of yield.md from the counts of tests/bench/yield: SCENE SUBSTEPS RATE KIND GROUP BIN COUNT.
# Bins are octaves of the yield: 0 below 1 um, k from 2^(k - 1) um on, 21: all from 1.05 m on.

function in_words(metres) { return metres < 0.9995e-3 ? sprintf("%.3g um", metres * 1e6) : sprintf("%.3g mm", metres * 1e3) }
function least_of(k) { return 1e-6 * 2 ^ (k - 1) } # of a bin [m]
function percent(part, whole) { return whole > 0 ? sprintf("%.1f", 100 * part / whole) : "-" }
# What a tolerance of bin t makes of the rows or islands of a pace: into both, rules, alone, neither.
function confuse(name, yes, no, pace, t, k) {
    both = rules = alone = neither = 0
    for (k = 0; k < 22; ++k) {
        both += k >= t ? sum[pace, name, yes, k] : 0
        rules += k >= t ? 0 : sum[pace, name, yes, k]
        alone += k >= t ? sum[pace, name, no, k] : 0
        neither += k >= t ? 0 : sum[pace, name, no, k]
    }
}
# The bin from which on the two disagree least, each side counted by its share.
function best(name, yes, no, pace, t, error, least, found) {
    least = 3
    for (t = 1; t < 22; ++t) {
        confuse(name, yes, no, pace, t)
        error = rules / (both + rules + 1e-9) + alone / (alone + neither + 1e-9)
        if (error < least) {
            least = error
            found = t
        }
    }
    return found
}
function line(name, yes, no, pace, t) {
    confuse(name, yes, no, pace, t)
    printf " %s | %s | %s |", in_words(least_of(t)), percent(both, both + rules), percent(neither, alone + neither)
}
# For each pace its own best tolerance, and the best over all paces.
function table_of(title, name, yes, no, i, t) {
    print "\n### " title "\n"
    print "| pace | " yes " | " no " | own tolerance | of " yes " above, % | of " no " below, % | one for all | above, % | below, % |"
    print "|---|--:|--:|--:|--:|--:|--:|--:|--:|"
    t = best(name, yes, no, "all")
    for (i = 0; i <= paces; ++i) {
        printf "| %s | %d | %d |", pace_name[i], total[pace_name[i], name, yes], total[pace_name[i], name, no]
        line(name, yes, no, pace_name[i], best(name, yes, no, pace_name[i]))
        line(name, yes, no, pace_name[i], t)
        print ""
    }
}
function row_of(title, name, group, k) {
    printf "| %s |", title
    for (k = 0; k < 22; k += 2) printf " %d |", sum["all", name, group, k] + sum["all", name, group, k + 1]
    print ""
}

BEGIN {
    paces = split("1x60 2x60 4x60 8x60 16x60 4x30 4x120 4x240", pace_name, " ")
    pace_name[0] = "all"
}
{
    pace = $2 "x" $3
    sum[pace, $4, $5, $6] += $7
    sum["all", $4, $5, $6] += $7
    total[pace, $4, $5] += $7
    total["all", $4, $5] += $7
    if (pace != "4x60") next
    of_scene[$1, $4, $5] += $7
    of_scene[$1, $4, $5, $6] += $7
    scene[$1] = 1
}
END {
    print "Points and islands in substeps, all scenes; pace: substeps x steps a second."
    table_of("Contact points: direct or swept, against a tolerance on the yield", "contacts", "direct", "swept")
    table_of("The same against the yield as it would be at 240 substeps a second: s w |f| / 240^2", "accelerations", "direct", "swept")
    print "\n### The same with a tenth of the pair's contact margin as the tolerance\n"
    print "| pace | direct above | direct below | swept above | swept below | of direct above, % | of swept below, % |"
    print "|---|--:|--:|--:|--:|--:|--:|"
    for (i = 0; i <= paces; ++i) {
        p = pace_name[i]
        d = total[p, "contacts", "direct"]
        s = total[p, "contacts", "swept"]
        da = total[p, "margin", "direct"]
        sa = total[p, "margin", "swept"]
        printf "| %s | %d | %d | %d | %d | %s | %s |\n", p, da, d - da, sa, s - sa, percent(da, d), percent(s - sa, s)
    }
    table_of("Islands: some contact direct or none, against their contact that yields most", "islands", "direct", "swept")
    table_of("Effort: islands with more substeps or sweeps than the world's or as many, against the yield with the world's substeps",
        "effort", "raised", "least")

    print "\n### Contact points by rule and yield, all paces\n"
    printf "| rule | < 2 um |"
    for (k = 2; k < 22; k += 2) printf " %s |", in_words(least_of(k))
    printf "\n|---|"
    for (k = 0; k < 22; k += 2) printf "--:|"
    print ""
    n = split("tower pressed hit load", rule, " ")
    for (r = 1; r <= n; ++r) row_of(rule[r] ": direct", "rule", rule[r])
    row_of("squeezed: swept", "rule", "squeezed")
    row_of("all direct", "contacts", "direct")
    row_of("all swept", "contacts", "swept")
    row_of("joints direct", "joints", "direct")
    row_of("joints swept", "joints", "swept")

    print "\n### By scene at 4x60: contact points against a tenth of the margin\n"
    print "| scene | direct | below, % | swept | above, % | of these in the last second, % |"
    print "|---|--:|--:|--:|--:|--:|"
    for (name in scene) {
        d = of_scene[name, "contacts", "direct"]
        s = of_scene[name, "contacts", "swept"]
        if (d + s > 0)
            printf "| %s | %d | %s | %d | %s | %s |\n", name, d, percent(d - of_scene[name, "margin", "direct"], d), s,
                percent(of_scene[name, "margin", "swept"], s),
                percent(of_scene[name, "margin", "swept", "late"], of_scene[name, "margin", "swept"]) | "sort"
    }
    close("sort")

    print "\n### Islands by error, all paces, %\n"
    print "| error | < 1 um | < 8 um | < 64 um | < 512 um | < 4.1 mm | more |"
    print "|---|--:|--:|--:|--:|--:|--:|"
    n = split("yield residual linearisation", what, " ")
    for (r = 1; r <= n; ++r) {
        printf "| %s |", what[r]
        for (i = 0; i < 6; ++i) {
            part = 0
            for (k = i == 0 ? 0 : 3 * i - 2; k <= (i == 5 ? 21 : 3 * i); ++k) part += sum["all", "error", what[r], k]
            printf " %s |", percent(part, total["all", "error", what[r]])
        }
        print ""
    }
}
