// BDF2.  t = 4/9 h,  s = 2/3 h,  u* = u_{n-1}/3 + 2/3 v~,  v~ = 4/3 v_n - v_{n-1}/3 + 2/3 h a
// with u_{n-1} h the last displacement. Of second order, which a first step by implicit Euler does not change; damps
// slow motion little and fast motion much.
#include "integrate/scheme.h"

namespace taut {
namespace {

void start_bdf2(const SchemeStart& from, Speed& ahead, Speed& coast) {
    const Speed none;
    coast = sum(sum(sum(none, 4.0 / 3, from.v), -1.0 / 3, from.history.before), 2.0 / 3, from.gained);
    ahead = sum(sum(none, 1.0 / 3, from.history.rate), 2.0 / 3, coast);
}

void start_euler(const SchemeStart& from, Speed& ahead, Speed& coast) { ahead = coast = sum(from.v, 1, from.gained); }

const SchemeType kFirst{"implicit_euler", [](const SchemeSettings&) { return Scheme{1, 1, false}; }, start_euler};

}  // namespace

const SchemeType kBdf2{"bdf2",
                       [](const SchemeSettings&) {
                           return Scheme{4.0 / 9, 2.0 / 3, false};
                       },
                       start_bdf2, &kFirst};

}  // namespace taut
