// Headers that most tests include, for builds with TAUT_PRECOMPILE; figures.h is in front of all tests in any build.
#pragma once

#include "figures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>
