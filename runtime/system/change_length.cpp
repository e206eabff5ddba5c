// From substeps of one length to those of another within a frame.
#include "system/assemble.h"

namespace taut {

void change_length(Team& team, System& system, const Group& group, Pairs& pairs, double h, double frame) {
    store_joint_lanes(team, system);
    store_lanes(team, system, pairs);
    rescale_grain_lanes(system, h / system.scheme.h);
    rescale_surface_lanes(system, h / system.scheme.h);
    system.scheme.set_length(h);
    load_contact_rows(system);
    load_lanes(team, system, pairs);
    build_joint_lanes(team, system, group, frame);
}

}  // namespace taut
