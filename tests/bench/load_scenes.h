// Scenes for taut-bench alone, of loads that sweeps hold badly: as the physics tests make them, with one start each.
//   vise_rR     five boxes of 0.2 to 3 kg between a plate that a motor pushes with R N and a wall   (vise_test.cpp)
//   pebbles_rR  a box of R kg falls from a metre onto sixteen pebbles of 1 kg                      (pressed_test.cpp)
//   wallN       N courses of bricks in running bond, eight a course                                   (wall_test.cpp)
//   squeeze_rR  a lift drives two boxes of 12 kg against a ceiling, R mm too far                     (press_test.cpp)
#pragma once

#include "scenes/catalogue.h"

namespace bench {

// The catalogue and these.
const std::vector<scenes::Family>& bench_families();

}  // namespace bench
