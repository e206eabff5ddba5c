// Contacts with faces that are inside of what several solids make up together, as at the seams of a floor of boxes:
// they go over to the faces that are left, or are dropped; collision::is_internal() knows which.
//
// Asked are the contacts of one collider with several others that move as one: with what forces do not move, or with
// the colliders of one body. Of two such contacts the deeper one holds the collider off what is beyond its plane.
#pragma once

#include "detect/manifolds.h"

namespace taut {

// After find_contacts() and what the host ignores; some of Pairs::active go.
void open_internal_faces(const Detection& of);

// The same within a frame for what find_contacts_again() found: they lose their points.
void open_internal_faces_again(const Detection& of, std::span<const uint32_t> active_pairs);

}  // namespace taut
