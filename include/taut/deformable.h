/**
 * @file deformable.h
 * What cloths (cloth.h) and solids (solid.h) have in common.
 *
 * A deformable is a mesh of vertices, each a particle of the world, and of elements between them. Its vertices are
 * bodies that all other calls may read, push and attach to; they touch what is around them as spheres of half the
 * deformable's thickness. Edges and triangles of its surface, as thick, touch those of other deformables and what
 * shapes have no vertex of it before: corners, edges, balls, cables. With self_collision its own touch each other too,
 * but for those that have a vertex in common, and no thicker than half of their shortest edge. What touches is kept on
 * the side it came from; of two that begin as they overlap, a solid's outside counts, of cloth the side on which most
 * of it is.
 *
 * Events tell of a deformable as of one body, whatever parts of it touch: one begin, persist, end and hit for it and
 * another collider or deformable, with the points of all its vertices, edges and triangles that touch, and one visit of
 * a sensor that meets any of them or lies within a solid. They name it by its first vertex, as body and collider;
 * taut_body_get_cloth and taut_body_get_solid say whose that is. That it touches itself is told by
 * taut_world_get_contacts alone, where each point names the vertex that bears most of it. What one collider of its
 * vertices asks for, the contacts of that vertex give; those of edges and triangles go by one vertex for all, so that
 * taut_cloth_set_contact_events and its like, which ask for all, are the usual way. The pre-solve function is asked
 * about each point of a surface by itself, after those of vertices.
 *
 * Damping by Rayleigh's rule pulls with -(mass_damping M + stiffness_damping K) v. M are the masses, against the world:
 * at the velocity v as a substep begins, over 1 + h mass_damping. K is what the elements' forces change by over the
 * way, taken as a substep begins and its negative part left out, so that it only takes energy (Gast and Schroeder 2014,
 * section 4.2): also that of tension across itself, which the damping of a strain does not see. A mode of frequency w
 * [rad/s] decays at (mass_damping + stiffness_damping w^2) / 2 [1/s]. Where elements are swept, or solved as rows, the
 * part of tension is left out of K.
 *
 * Air pushes a triangle of area A and normal n, past which it goes at w = wind - velocity, by
 *   1/2 air_density A |w| (drag |s| w + lift s (|w| n - s w)),   s = n . w / |w|:
 * drag of the area that the air sees along w, lift across it. It meets both sides of a cloth's triangles, of solids and
 * closed cloths the outer side alone. In any step it slows motion against the air, and never turns it round. What is
 * held and swept bears less of the force than this, the more the longer a substep is.
 */
#ifndef TAUT_DEFORMABLE_H
#define TAUT_DEFORMABLE_H

#ifdef __cplusplus
extern "C" {
#endif

/** Most vertices, triangles or cells of one deformable. */
#define TAUT_DEFORMABLE_MAX 4000000

/** How the world's default solver takes the elements of a deformable; the other solvers take all alike. */
typedef enum taut_deformable_solve {
    TAUT_DEFORMABLE_DIRECT = 0, /**< all at once: exact for any stiffness and load; time grows as vertices^1.5 */
    /** element by element, in substeps of its island's own, as many as its stiffness and what it bears ask for, up to
       64 a step: time grows as vertices; what is stiffer or heavier than these hold gives way. Of solids neo-Hookean
        tetrahedra alone, others are solved directly; bending and quadrilaterals as joints are, far slower */
    TAUT_DEFORMABLE_SWEPT = 1,
    /** the one of these that is predicted to hold its stiffness and its own weight at the lower cost: swept where its
        substeps are as short as its stiffness asks for at any load, and faster; or where a direct solve would take
        longer than the step lasts, and swept it stretches by its own weight within its tolerance. Chosen as it is
        added; taut_cloth_get_solve and taut_solid_get_solve tell */
    TAUT_DEFORMABLE_AUTO = 2,
    TAUT_DEFORMABLE_SOLVE_MAX = 0x7fffffff
} taut_deformable_solve;

#ifdef __cplusplus
}
#endif

#endif
