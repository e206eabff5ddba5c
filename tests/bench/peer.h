// What peer engines need that Taut computes itself.
#pragma once

#include "engine.h"

namespace bench {

// Of a dynamic body: as given, else from its density and shape [kg].
double mass_of(const scenes::Scene& scene, const scenes::Body& body);

uint64_t hash_of_motions(const Engine& engine, size_t bodies);

}  // namespace bench
