/* SPDX-License-Identifier: MIT */
/* A scene of constants, without link and records: SCENE_ROM in its scene.mk. */
#include "pc104.h"

int pc104_link_option(const char *name, const char *value)
{
    (void)name;
    (void)value;
    return 0;
}

void pc104_link_open(const struct exh_scene *sc) { (void)sc; }

int pc104_link_up(void) { return 0; }

void pc104_link_poll(void) {}

void pc104_link_dry(void) {}

void pc104_link_report(void) {}

/* There is no peer. Each port has its own copy, so that it can be read and copied alone. */
int exh_board_link_send(const void *buf, size_t len_B)
{
    (void)buf;
    (void)len_B;
    return 0;
}

int exh_board_link_recv(void *buf, size_t cap_B)
{
    (void)buf;
    (void)cap_B;
    return 0;
}
