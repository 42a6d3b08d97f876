/* SPDX-License-Identifier: MIT */
/* exhand: from 22 glove voltages and 5 encoder counts to 5 motor currents, in
 * integers, without allocation, with the same bits on every machine.
 *
 *   fix units bytes error        below everything
 *   angle                        binary angles, sine and cosine
 *   signal                       one descriptor per value; parameters
 *   glove                        its codes to 22 joint angles; a user's calibration from poses
 *   hand                         the glove's angles to the robot hand's joints and fingertips
 *   quad -> velocity -> contact -> drive -> safety (the gate)      one tick
 *   axis                         that tick of one finger, in its order, for scenes and firmware
 *   passivity                    no contact gives back more energy than it was given
 *   guard                        configuration that must stand still; self-test
 *   watch                        speed limit of a finger, and an encoder that stands
 *   filter, quantizer            glove voltages to codes that stand still
 *   gains                        which stiffness and damping are taken at this rate
 *   precontact                   the virtual contact q_lim, frozen before it is felt
 *   wire                         packets between controller and world
 *   calibrate, probe             tables of the box, and the motions that measure them
 *   record                       log and replay
 *   trace                        a few signals of every n-th tick, until somebody fetches them
 *   slots                        images in flash that outlive a power cut
 *   modbus                       the box as registers; a Modbus slave
 *   board                        what a port provides; only the loop calls it
 *
 * A scene is a pure function over these modules (examples/minimal is the
 * shortest); lib/src/run/loop.c is the one loop around it. docs/DESIGN.md says why.
 */
#ifndef EXHAND_EXHAND_H
#define EXHAND_EXHAND_H

/* The library's version, as semver has it; the number, major << 16 | minor << 8 | patch, is what a
 * HELLO, a log and a register carry. Wire, records, images and the map of registers have versions
 * of their own, in their headers. */
#define EXH_VERSION_MAJOR 0
#define EXH_VERSION_MINOR 1
#define EXH_VERSION_PATCH 0
#define EXH_VERSION_NUMBER \
    ((uint32_t)EXH_VERSION_MAJOR << 16 | (uint32_t)EXH_VERSION_MINOR << 8 | EXH_VERSION_PATCH)

#include "exhand/angle.h"
#include "exhand/axis.h"
#include "exhand/bytes.h"
#include "exhand/calibrate.h"
#include "exhand/contact.h"
#include "exhand/drive.h"
#include "exhand/error.h"
#include "exhand/filter.h"
#include "exhand/fix.h"
#include "exhand/gains.h"
#include "exhand/glove.h"
#include "exhand/guard.h"
#include "exhand/hand.h"
#include "exhand/modbus.h"
#include "exhand/passivity.h"
#include "exhand/precontact.h"
#include "exhand/probe.h"
#include "exhand/quad.h"
#include "exhand/quantizer.h"
#include "exhand/record.h"
#include "exhand/safety.h"
#include "exhand/signal.h"
#include "exhand/slots.h"
#include "exhand/trace.h"
#include "exhand/units.h"
#include "exhand/velocity.h"
#include "exhand/watch.h"
#include "exhand/wire.h"

#endif
