/* SPDX-License-Identifier: MIT */
/* An image without Modbus: MODBUS=no. */
#include "pc104.h"

int pc104_modbus_option(const char *name, const char *value)
{
    (void)name;
    (void)value;
    return 0;
}

void pc104_modbus_check(const struct exh_scene *sc) { (void)sc; }

void pc104_modbus_open(const struct exh_scene *sc) { (void)sc; }

void pc104_modbus_start(struct exh_scene_board board) { (void)board; }

void pc104_modbus_poll(const struct exh_scene_in *in) { (void)in; }

uint8_t pc104_modbus_command(void) { return EXH_CMD_NONE; }

int pc104_modbus_dry(unsigned part)
{
    (void)part;
    return 0;
}

void pc104_modbus_report(void) {}
