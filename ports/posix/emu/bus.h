/* SPDX-License-Identifier: MIT */
/* Bus: the port accesses of ports/cards/io.h, answered by an emulated box. */
#ifndef EMU_BUS_H
#define EMU_BUS_H

#include "emu.h"

/* This box answers from now on, until another; NULL: none, all ones. */
void emu_bus_connect(struct emu_box *b);

/* 1: a driver opens its cards; the phase follows from its accesses. A Sensoray 526 is detected
 * until its first write, then tested until its EEPROM is read or its references are converted, then
 * calibrated. A DMM is detected until its FIFO is first reset, then tested. 0: emu_enter() sets the
 * phase. */
void emu_bus_opening(int opening);

#endif
