/**
 * @file math.h
 * Plain value types of the Taut C API. No functions: a host brings its own mathematics.
 */
#ifndef TAUT_MATH_H
#define TAUT_MATH_H

#ifdef __cplusplus
extern "C" {
#endif

/** Position in the world [m]. */
typedef struct taut_pos {
    double x, y, z; /**< [m] */
} taut_pos;
/** Vector: velocity [m/s], force [N], direction [1], local point [m], as said where it is used. */
typedef struct taut_vec3 {
    float x, y, z; /**< components along the axes */
} taut_vec3;
/** Rotation as a unit quaternion x i + y j + z k + w. Accepted within 1e-3 of unit length, then normalised. */
typedef struct taut_quat {
    float x, y, z, w; /**< w: cosine of half the angle */
} taut_quat;
/** Symmetric 3x3 tensor, inertia [kg m^2]. */
typedef struct taut_sym3 {
    float xx, yy, zz, xy, xz, yz; /**< components, xy that of x and y */
} taut_sym3;

#ifdef __cplusplus
}
#endif

#endif
