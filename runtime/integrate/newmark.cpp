// Newmark.  t = beta h,  s = gamma h,  u* = v_n + h ((1/2 - beta) f_n/m + a/2),  v~ = v_n + h ((1 - gamma) f_n/m + a)
// with f_n the springs' forces at x_n (Frâncu 2016, eq. 6.28 to 6.32). Of second order and conserving with beta 1/4 and
// gamma 1/2.
#include "integrate/scheme.h"

namespace taut {
namespace {

void start_newmark(const SchemeStart& from, Speed& ahead, Speed& coast) {
    const auto& [v, gained, history, h, settings] = from;
    ahead = sum(sum(v, h * (0.5 - settings.beta), history.acceleration), 0.5, gained);
    coast = sum(sum(v, h * (1 - settings.gamma), history.acceleration), 1, gained);
}

}  // namespace

const SchemeType kNewmark{"newmark",
                          [](const SchemeSettings& settings) {
                              return Scheme{settings.beta, settings.gamma, false};
                          },
                          start_newmark};

}  // namespace taut
