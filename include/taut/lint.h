/**
 * @file lint.h
 * What in a world is likely to yield, jump or tremble, found without stepping it: for tools and development builds.
 */
#ifndef TAUT_LINT_H
#define TAUT_LINT_H

#include <taut/base.h>
#include <taut/body.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What is the matter; taut_lint_text says it in words. value and limit of an entry are in the unit given here. */
typedef enum taut_lint_kind {
    TAUT_LINT_BLOCK_MASS_RATIO = 0,    /**< heaviest over lightest body of joints and attachments that are solved
                                            directly; body: the lightest */
    TAUT_LINT_JOINT_MASS_RATIO = 1,    /**< of the two ends of a swept joint; body: the lighter */
    TAUT_LINT_CONTACT_MASS_RATIO = 2,  /**< of a body that rests on a lighter one; body: the lighter */
    TAUT_LINT_LIGHT_BETWEEN_HEAVY = 3, /**< second heaviest neighbour over the body between them */
    TAUT_LINT_THIN_INERTIA = 4,        /**< largest over smallest principal inertia of a body in a joint */
    TAUT_LINT_SOFT_LOAD = 5,           /**< force of a swept joint over the weight of its lighter end, last step */
    TAUT_LINT_SOFT_COMPLIANCE = 6,     /**< compliance of a swept joint, over h^2 J W J^T [1]: acts as rigid */
    TAUT_LINT_REDUNDANT_ROWS = 7, /**< rows of a joint that other joints hold already: internal forces are arbitrary */
    TAUT_LINT_JOINT_APART = 8,    /**< gap of a rigid joint or attachment [m]: closes with a jump */
    TAUT_LINT_JOINT_MISALIGNED = 9,      /**< angle of a rigid joint that is off [rad]: closes with a jump */
    TAUT_LINT_STOP_OVERRUN = 10,         /**< coordinate beyond a rigid stop [m]: is pushed back */
    TAUT_LINT_STOP_OVERRUN_ANGLE = 11,   /**< the same of an angle [rad] */
    TAUT_LINT_NARROW_STOPS = 12,         /**< room between two stops [m]: trembles; lock the axis instead */
    TAUT_LINT_NARROW_STOPS_ANGLE = 13,   /**< the same of an angle [rad] */
    TAUT_LINT_CABLE_COARSE = 14,         /**< angle between two segments on a sphere, capsule or cylinder in the last
                                              step [rad]; body: of the segment behind the bend */
    TAUT_LINT_CABLE_SHORT_SEGMENTS = 15, /**< mean segment over the diameter; body: the cable's first */
    TAUT_LINT_CABLE_STRAIN = 16,   /**< of the most stretched segment in the last step [1]; body: of the segment */
    TAUT_LINT_SOFT_SLIVER = 17,    /**< least height over longest edge at rest of a cloth's triangle or a solid's
                                        tetrahedron, least over mean volume that the Gauss points of a hexahedron stand
                                        for: counts its vertices as stiff and slow; body: a vertex of the worst */
    TAUT_LINT_SOFT_INVERTED = 18,  /**< volume of a solid's cell over that at rest, below 0: turned inside out; body: a
                                        vertex of the worst */
    TAUT_LINT_SOFT_TOO_STIFF = 19, /**< substeps that a swept cloth or solid takes for its stiffness at rest over the
                                        most that it may take: acts softer; body: a vertex of the stiffest element */
    TAUT_LINT_SOFT_SEAM = 20,      /**< distance of two vertices of a cloth or solid that lie in one place and are not
                                        joined, over its size: the mesh comes apart there; body: the first of them */
    TAUT_LINT_SOFT_NOT_MANIFOLD = 21, /**< triangles of a solid's boundary that meet at an edge: cells that touch along
                                           it alone; body: a vertex of the first such edge */
    TAUT_LINT_JOINT_LOCKED = 22, /**< error [m or rad] of a rigid row of a joint that locked axes leave nothing to move:
                                      stays, and its force means nothing; body: one that is locked */
    TAUT_LINT_KIND_MAX = 0x7fffffff
} taut_lint_kind;

/** One finding. */
typedef struct taut_lint_entry {
    taut_lint_kind kind;                 /**< what is the matter */
    uint32_t reserved;                   /**< zero */
    taut_body body;                      /**< null where none is meant */
    taut_joint joint;                    /**< null where none is meant */
    float value;                         /**< found */
    float limit;                         /**< what it should keep to */
    taut_attachment attachment;          /**< null where none is meant */
    char body_name[TAUT_BODY_NAME_SIZE]; /**< of body, see taut_body_set_name; empty where it has none */
} taut_lint_entry;

/**
 * Looks at joints, masses, contacts and forces as they are now; contacts and forces are those of the last step.
 * Entries come in the order of their kinds, within a kind in that of slots. Of a cable's finding taut_body_get_cable
 * names the cable, of a cloth's or solid's, of which there is one of a kind at most, taut_body_get_cloth and
 * taut_body_get_solid; loads and stiffness that its joints do not hold are findings of bodies and joints as everywhere.
 * Changes nothing. Takes memory of the world while it runs, and time that grows with the cube of a looped mechanism's
 * rows, seconds for a thousand; of more than 1200 it does not look for redundant ones.
 * @param entries null if capacity is 0.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED,
 *         TAUT_OUT_OF_MEMORY. Thread safety: one thread at a time per world, not inside a step.
 */
TAUT_API taut_result taut_world_lint_sized(taut_world world, taut_lint_entry* entries, uint32_t capacity,
                                           uint32_t* count, uint32_t size);
static inline taut_result taut_world_lint(taut_world world, taut_lint_entry* entries, uint32_t capacity,
                                          uint32_t* count) {
    return taut_world_lint_sized(world, entries, capacity, count, (uint32_t)sizeof(*entries));
}
/** A sentence on what the kind means and what to do, "unknown" for other values. Thread safety: any thread. */
TAUT_API const char* taut_lint_text(taut_lint_kind kind);

#ifdef __cplusplus
}
#endif

#endif
