# Frames of scenes after figures of Gast and Schroeder 2014, as film.txt lists them: a row each, the last six drawn.
wide = 240
high = 180
beside = 190
sheet(name) = system("awk '!/^#/ { ++row } $1 == \"" . name . "\" { print row }' film.txt")
field(row, number) = system(sprintf("awk '!/^#/ && ++row == %s { print $%d }' film.txt", row, number))
unset border
unset tics
unset key
unset grid
do for [name in "tangled film"] {
    count = words(sheet(name))
    eval picture(beside + 6 * wide, high * count)
    set output name . ".png"
    set multiplot
    set xrange [0:319]
    set yrange [0:239]
    do for [i = 1:count] {
        row = word(sheet(name), i)
        last = field(row, 3) + 0
        every = field(row, 4) + 0
        set size real(wide) / (beside + 6 * wide), 1.0 / count
        do for [frame = 1:6] {
            set origin real(beside + (frame - 1) * wide) / (beside + 6 * wide), 1 - real(i) / count
            set margins 0, 0, 0, 0
            if (frame == 1) {
                set label 1 "figure " . field(row, 2) at screen 0.006, 1 - (i - 0.75) / count
                set label 2 field(row, 5) noenhanced at screen 0.006, 1 - (i - 0.55) / count font ",9"
                set label 3 field(row, 6) noenhanced at screen 0.006, 1 - (i - 0.4) / count font ",9"
                set label 4 sprintf("frames %d to %d", last - 5 * every, last) at screen 0.006, 1 - (i - 0.25) / count \
                    font ",9"
            } else {
                unset label
            }
            shown = last - (6 - frame) * every - 1
            plot sprintf("film/%s/%s_%05d.png", row, field(row, 5), shown) binary filetype=png with rgbimage
        }
    }
    unset multiplot
}
