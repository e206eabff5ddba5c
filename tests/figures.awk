# What programs kept (figures.h) as the table of figures.md, first what stood there: of a test that ran again its lines
# are replaced. Of all starts and parameters the value nearest its bound stands.
BEGIN { FS = "\t" }

FNR == 1 { ++files }

files == 1 { # figures.md
    if ($0 !~ /^\| `/) next
    split($0, cells, "`")
    old[cells[2]] = old[cells[2]] $0 "\n"
    next
}

{ # test, expression, value, relation, bound
    key = $1 SUBSEP $2
    apart = $4 == "<=" ? $5 - $3 : $3 - $5
    if ($5 != 0) apart /= $5 < 0 ? -$5 : $5
    if (key in nearest && nearest[key] <= apart) next
    if ($4 == ">=" && $5 == 0 || $5 >= 1e30) next # that something is there at all, and times that are not held
    nearest[key] = apart
    gsub(/\|/, "\\|", $2)
    if (length($2) > 100) $2 = substr($2, 1, 97) "..."
    row[key] = sprintf("| `%s` | `%s` | %.3g | %s %.3g |", $1, $2, $3, $4, $5)
    tests[$1] = 1
}

END {
    for (key in row) print row[key]
    for (test in old)
        if (!(test in tests)) printf "%s", old[test]
}
