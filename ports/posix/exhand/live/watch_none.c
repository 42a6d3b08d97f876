/* SPDX-License-Identifier: MIT */
/* In place of watch_libmodbus.c where that package is not. */
#include "live/watch.h"

#include "base/option.h"

int watch_modbus_open(const char *where)
{
    cli_complain("--modbus: %s: this program was built without libmodbus: install libmodbus-dev "
                 "and build it again",
        where);
    return 3;
}

int watch_modbus_look(struct watch_box *b, watch_fresh fresh)
{
    (void)b;
    (void)fresh;
    return 3;
}

void watch_modbus_close(void) {}
