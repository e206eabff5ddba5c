// taut-demo --replay: draws a recording (taut/record.h), whatever program made it.
#pragma once

#include <stdexcept>

#include "options.h"

namespace demo {

// A file that is no recording, or one that cannot be played; what() says why.
class NoRecording : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Plays and draws the recording, writes the figures, and says whether it came out the same.
bool play(const Options& options);

}  // namespace demo
