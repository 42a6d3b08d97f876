/* SPDX-License-Identifier: MIT */
/* in place of libmodbus.c where that package is not. */
#include "slave/slave.h"

#include "base/option.h"

int live_modbus_open(const char *where)
{
    cli_complain("--modbus: %s: this program was built without libmodbus: install libmodbus-dev "
                 "and build it again",
        where);
    return 3;
}

int live_modbus_serve(void) { return 3; }

void live_modbus_close(void) {}
