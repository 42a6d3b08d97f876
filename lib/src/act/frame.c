/* SPDX-License-Identifier: MIT */
/* A frame of the device through a cursor. */
#include "exhand/frame.h"

#include "../num/pack.h"

void exh_drive_in_serialize(struct exh_bytes *c, struct exh_drive_in *in, unsigned n)
{
    for (unsigned i = 0; i < n; i++) { exh_bytes_u32(c, &in->enc_raw[i]); }
    pack_i16s(c, in->mon_raw, n);
    exh_bytes_i16(c, &in->supply_raw);
    exh_bytes_u32(c, &in->din);
}

void exh_drive_out_serialize(struct exh_bytes *c, struct exh_drive_out *out, unsigned n)
{
    pack_i16s(c, (int16_t *)out->dac_raw, n);
    exh_bytes_u8(c, &out->enable);
    exh_bytes_u8(c, &out->alive);
}
