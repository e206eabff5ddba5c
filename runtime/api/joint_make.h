// What the calls that make joints share: the base that the defs of all kinds have, checked and put into a joint, and
// the one way from a def into a world.
#pragma once

#include "api/joint_parts.h"
#include "api/sized.h"

namespace taut {

// Where a joint that is made sits: on bodies a and b, and on the housing, where it has one.
struct JointPlaces {
    JointEnd end[2];
    JointEnd guide[2];  // both on one node
};

template <class Def>
constexpr bool kHoused = requires(Def def) {
    def.housing;
};

Check& check_base(Check& check, const JointKind& kind, const taut_joint_base& base);

// Finds and places ends a and b; at least one of them must move by forces.
taut_result place_ends(Check& check, const World& world, const JointKind& kind, const taut_joint_base& base,
                       JointPlaces& places);
// The same with a housing, on which frames a and b are.
taut_result place_housed_ends(Check& check, const World& world, const JointKind& kind, const taut_joint_base& base,
                              taut_body housing, const taut_frame& frame_a, const taut_frame& frame_b,
                              JointPlaces& places);

// All of a joint that base and places say.
Joint make_joint(const JointKind& kind, const taut_joint_base& base, const JointPlaces& places);
taut_result add_joint(Check& check, World& world, const Joint& joint, taut_joint* out);

// check_own(check, kind, def), set_own(check, world, kind, def, joint): what this def has beside its base.
template <class Def, class CheckOwn, class SetOwn>
taut_result add_by_def(const char* call, taut_world handle, taut_joint_kind which, const Def* given, void (*init)(Def*),
                       taut_joint* out, CheckOwn&& check_own, SetOwn&& set_own) {
    Check check(call);
    Def def;
    const JointKind& kind = joint_kind(which);
    if (!check.pointer("def", given).pointer("out", out) || !take_def(check, given, init, def)) return check.result();
    if constexpr (requires { def.reserved; }) check.zero("reserved", def.reserved);
    check_base(check, kind, def.base);
    if constexpr (kHoused<Def>)
        check_frames(check.within("housing_"), def.housing_frame_a, def.housing_frame_b).within("");
    check_own(check, kind, def);
    if (!check) return check.result();
    return with_world(call, handle, Use::write, [&](World& world) {
        JointPlaces places;
        taut_result found;
        if constexpr (kHoused<Def>)
            found = place_housed_ends(check, world, kind, def.base, def.housing, def.housing_frame_a,
                                      def.housing_frame_b, places);
        else
            found = place_ends(check, world, kind, def.base, places);
        if (found != TAUT_OK) return found;
        Joint joint = make_joint(kind, def.base, places);
        set_own(check, world, kind, def, joint);
        return check ? add_joint(check, world, joint, out) : check.result();
    });
}

}  // namespace taut
