/**
 * @file draw.h
 * Pictures of a world for those who look for a fault: lines, triangles and labels of shapes, contacts, joints, bounds,
 * centres of mass, islands and sleep, as arrays that a host hands to its own renderer. Nothing is called back.
 */
#ifndef TAUT_DRAW_H
#define TAUT_DRAW_H

#include <taut/base.h>
#include <taut/math.h>
#include <taut/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Bits of taut_draw_def.what.
 * Shapes, as lines: the edges of colliders, and of the triangles of cloths and solids; of round shapes circles and four
 * lines along the axis, of meshes the edges between facets, of a plane a square of 20 m and 1 m of its normal.
 */
#define TAUT_DRAW_SHAPES 1u
/** Triangles of the same, counter-clockwise from outside; of round shapes of 24 sides. */
#define TAUT_DRAW_FACES 2u
/** Lines: the normal of each contact that touches, 0.1 m long. */
#define TAUT_DRAW_CONTACTS 4u
/** Lines: of joints and attachments from the centres of bodies to the anchors, and between the anchors. */
#define TAUT_DRAW_JOINTS 8u
/** Lines: axis-aligned boxes of colliders, without planes. */
#define TAUT_DRAW_BOUNDS 16u
/** Lines: the axes of dynamic bodies at their centres of mass, 0.1 m, red, green, blue. */
#define TAUT_DRAW_CENTRES 32u
/** Lines: of contacts that touch and of joints and attachments, to the scale of the def. */
#define TAUT_DRAW_FORCES 64u
/** Labels: with centres the masses of bodies, with forces their sizes. */
#define TAUT_DRAW_LABELS 128u
/** All of these. */
#define TAUT_DRAW_ALL 255u

/** How colliders, cloths and solids are coloured. */
typedef enum taut_draw_colours {
    TAUT_DRAW_BY_KIND = 0,   /**< static grey, kinematic violet, dynamic orange and dark blue asleep, sensors green, in
                                  quarantine red */
    TAUT_DRAW_BY_ISLAND = 1, /**< bodies that the last step solved together alike; all else as by kind */
    TAUT_DRAW_COLOURS_MAX = 0x7fffffff
} taut_draw_colours;

/** Colours are 0xRRGGBBAA. */
typedef struct taut_draw_line {
    taut_pos from, to; /**< [m] */
    uint32_t colour;   /**< 0xRRGGBBAA */
    uint32_t reserved; /**< zero */
} taut_draw_line;

/** Corners go round counter-clockwise as seen from outside. */
typedef struct taut_draw_triangle {
    taut_pos corners[3]; /**< [m] */
    uint32_t colour;
    uint32_t reserved; /**< zero */
} taut_draw_triangle;

/** A word at a place. */
typedef struct taut_draw_label {
    taut_pos position; /**< [m] */
    uint32_t colour;
    char text[20]; /**< ends with a zero byte: a number of three digits and its unit */
} taut_draw_label;

/** What is drawn, and how. */
typedef struct taut_draw_def {
    uint32_t struct_size;
    uint32_t what;             /**< sum of TAUT_DRAW_ bits. Default shapes, contacts and joints */
    taut_draw_colours colours; /**< default TAUT_DRAW_BY_KIND */
    float force_scale;         /**< length of a force's line [m/N], [0, 1e6]. Default 0.001 */
    taut_pos low, high; /**< box of the world [m], within 1e7, low <= high: what lies outside is left out: colliders
                             by their bounds, triangles of meshes by theirs, contacts and joints by their points.
                             Default all */
} taut_draw_def;

/** Where it goes: the host's arrays and how long they are, and what came. */
typedef struct taut_drawing {
    uint32_t struct_size;
    uint32_t line_capacity, triangle_capacity, label_capacity; /**< entries that the arrays have room for */
    taut_draw_line* lines;         /**< may be null where its capacity is 0; so may the others */
    taut_draw_triangle* triangles; /**< likewise */
    taut_draw_label* labels;       /**< likewise */
    uint32_t line_count, triangle_count,
        label_count;   /**< out: what there is to draw, as far as the arrays reach in them */
    uint32_t reserved; /**< zero */
} taut_drawing;

/** Defaults. */
TAUT_API void taut_draw_def_init_sized(taut_draw_def* def, uint32_t size);
static inline void taut_draw_def_init(taut_draw_def* def) { taut_draw_def_init_sized(def, (uint32_t)sizeof(*def)); }
/** No arrays. */
TAUT_API void taut_drawing_init_sized(taut_drawing* drawing, uint32_t size);
static inline void taut_drawing_init(taut_drawing* drawing) {
    taut_drawing_init_sized(drawing, (uint32_t)sizeof(*drawing));
}

/**
 * Draws a world as it is now, contacts and forces as the last step left them, always in the same order. Thread safety:
 * as queries (query.h); the world allocates nothing.
 * @param def null: the defaults. @param drawing counts and arrays are written.
 * @return TAUT_OK; TAUT_TOO_SMALL: an array is too short, the counts tell what is needed, and the arrays hold the first
 *         of each; TAUT_NULL_POINTER, TAUT_INVALID_ARGUMENT, TAUT_STRUCT_SIZE, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_draw(taut_world world, const taut_draw_def* def, taut_drawing* drawing);

#ifdef __cplusplus
}
#endif

#endif
