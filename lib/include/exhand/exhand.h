/* SPDX-License-Identifier: MIT */
/* exhand: from 22 glove voltages and 5 encoder counts to 5 motor currents. It uses integers only,
 * allocates no memory, and gives the same bits on every machine.
 *
 *   group      header                       what it does
 *   numbers    units fix bytes angle error  formats, arithmetic, byte cursors, sine, error codes
 *              signal params authority      one descriptor per value; parameters; who may set them
 *   sensing    frame                        raw codes that a board reads and writes in a tick
 *              quad velocity                encoder count to position and velocity
 *              filter filter_cheap          low-pass of second order, accurate or cheap
 *              quantizer                    codes without jitter
 *              glove hand                   voltages to joint angles; angles to fingertips
 *   laws       contact passivity            contact force; passivity observer and controller
 *              gains precontact             stable stiffness and damping; virtual contact q_lim
 *   actuation  table drive                  force to current to D/A code, within limits
 *              supply tracking              supply voltage; does the current follow?
 *   safety     safety integrity             states and gate; checks of configuration and memory
 *              chatter motion polarity      limit cycle; overspeed; sign of motor and encoder
 *              limiter                      a guard for any motor, in one structure and one step
 *   finger     axis                         one tick of one finger, in its order
 *   bench      calibrate probe              tables of the device; motions that measure them
 *   talking    record ring trace            log, its newest part, a few signals
 *              wire keyed mac               packets of controller and world; signed packets
 *              regs modbus modbus_rtu       registers and a Modbus slave
 *              slots                        images in flash that survive a power cut
 *   port       board                        what a port provides; only the loop calls it
 *
 * A scene is a pure function over these modules; examples/minimal is the shortest one.
 * lib/src/run/loop.c calls it once per tick. docs/DESIGN.md gives the reasons.
 *
 * Call a module directly if you have your own loop:
 *
 *   #include "exhand/exhand.h"
 *   int32_t pos = exh_quad_pos_m_q30(&quad_par, cnt);
 *   int32_t vel = exh_velocity_window_step(&window, &window_cfg, cnt);
 *   int32_t force_N_q20 = exh_contact_force(&contact_par, (struct exh_contact_in){pos, vel, lim});
 */
#ifndef EXHAND_EXHAND_H
#define EXHAND_EXHAND_H

/* The version of the library, by semantic versioning. The number is major << 16 | minor << 8 |
 * patch; HELLO packets, logs and a register carry it. Wire, records, images and the register map
 * have their own versions, defined in their headers. */
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
