/* SPDX-License-Identifier: MIT */
/* exhand: from 22 glove voltages and 5 encoder counts to 5 motor currents, in
 * integers, without allocation, with the same bits on every machine.
 *
 *   numbers   units fix bytes angle error      formats, arithmetic, cursors, sine and cosine
 *             signal params                    one descriptor per value; values that may change
 *   sensing   frame                            raw codes of a tick, as a board reads and writes
 * them quad velocity                    counts to position and velocity filter quantizer glove
 * glove voltages to codes that stand still, to angles hand                             glove angles
 * to the robot hand's fingertips laws      contact passivity                a force from a contact,
 * and no energy out of it gains precontact                 limits of stiffness; the virtual contact
 * q_lim actuation table drive                      force to current, within limits supply track the
 * drives' voltage; does the current follow? safety    safety watch guard               states and
 * gate; speed limit; configuration, self-test a finger  axis                             the tick
 * of one finger, in its order bench     calibrate probe                  tables of the box, and the
 * motions that measure them talking   record ring trace                the log, the newest of it, a
 * few signals wire                             packets between controller and world regs modbus
 * modbus_rtu           the box as registers; a Modbus slave slots                            images
 * in flash that outlive a power cut board                                      what a port
 * provides; only the loop calls it
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
#define EXH_VERSION_MINOR 3
#define EXH_VERSION_PATCH 0
#define EXH_VERSION_NUMBER \
    ((uint32_t)EXH_VERSION_MAJOR << 16 | (uint32_t)EXH_VERSION_MINOR << 8 | EXH_VERSION_PATCH)

/* numbers */
#include "exhand/angle.h"
#include "exhand/authority.h"
#include "exhand/bytes.h"
#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/params.h"
#include "exhand/signal.h"
#include "exhand/units.h"

/* sensing */
#include "exhand/filter.h"
#include "exhand/filter_cheap.h"
#include "exhand/frame.h"
#include "exhand/glove.h"
#include "exhand/hand.h"
#include "exhand/quad.h"
#include "exhand/quantizer.h"
#include "exhand/velocity.h"

/* laws */
#include "exhand/contact.h"
#include "exhand/gains.h"
#include "exhand/passivity.h"
#include "exhand/precontact.h"

/* actuation */
#include "exhand/drive.h"
#include "exhand/supply.h"
#include "exhand/table.h"
#include "exhand/tracking.h"

/* safety */
#include "exhand/integrity.h"
#include "exhand/safety.h"
#include "exhand/chatter.h"
#include "exhand/motion.h"
#include "exhand/polarity.h"

/* the tick of one finger */
#include "exhand/axis.h"

/* a guard for any motor */
#include "exhand/limiter.h"

/* measuring the box */
#include "exhand/calibrate.h"
#include "exhand/probe.h"

/* talking */
#include "exhand/keyed.h"
#include "exhand/mac.h"
#include "exhand/modbus.h"
#include "exhand/modbus_rtu.h"
#include "exhand/record.h"
#include "exhand/regs.h"
#include "exhand/ring.h"
#include "exhand/slots.h"
#include "exhand/trace.h"
#include "exhand/wire.h"

#endif
