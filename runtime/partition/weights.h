// How many weights a contact in sweeps may bear.
#pragma once

#include <algorithm>

#include "partition/partition.h"

namespace taut {

// A contact between bodies that bears twenty times the weight of the lighter is taken in as one with a body of ten
// times its mass is, whatever presses: swept, a box of .2 kg sinks in by 3.5 mm under 50 N, and by 7 cm under 1 kN.
// What stands high bears as many weights itself, and twice that as it lands.
constexpr double kPressed = 20;         // weights, or
constexpr double kPressedByBody = 2;    // so many for each body of the island
constexpr double kLeastGravity = 9.81;  // where there is less, weights are as on Earth [m/s^2]

inline double most_weights(uint32_t bodies) { return std::max(kPressed, kPressedByBody * bodies); }
inline double least_gravity(const PartitionRules& rules) { return std::max(rules.gravity.norm(), kLeastGravity); }

}  // namespace taut
