/* SPDX-License-Identifier: MIT */
/* Saves parameters in a tick. Not part of the library's interface. */
#ifndef NUM_PARAMS_SAVE_H
#define NUM_PARAMS_SAVE_H

#include "exhand/params.h"

/* As exh_params_save(), with the table's CRC by a caller that has no time for it in a tick. */
int32_t exh_params_save_by(const struct exh_params *p, uint32_t table_crc, void *buf, size_t cap_B);

#endif
