/**
 * @file taut.h
 * All of the Taut C API: real-time constrained dynamics for games.
 */
#ifndef TAUT_TAUT_H
#define TAUT_TAUT_H

#include <taut/attachment.h>
#include <taut/base.h>
#include <taut/body.h>
#include <taut/cable.h>
#include <taut/character.h>
#include <taut/cloth.h>
#include <taut/collider.h>
#include <taut/decomposition.h>
#include <taut/draw.h>
#include <taut/event.h>
#include <taut/forces.h>
#include <taut/joint.h>
#include <taut/lint.h>
#include <taut/math.h>
#include <taut/pre_solve.h>
#include <taut/profile.h>
#include <taut/query.h>
#include <taut/ragdoll.h>
#include <taut/record.h>
#include <taut/sensor.h>
#include <taut/shape.h>
#include <taut/sleep.h>
#include <taut/snapshot.h>
#include <taut/solid.h>
#include <taut/vehicle.h>
#include <taut/world.h>

#endif
