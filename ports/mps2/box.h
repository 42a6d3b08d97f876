/* SPDX-License-Identifier: MIT */
/* The box: what a port that has drives fills with its drivers. Here a loop-back. */
#ifndef MPS2_BOX_H
#define MPS2_BOX_H

#include "exhand/frame.h"
#include "exhand/glove.h"

int mps2_box_open(void); /* finds what is there, drives disabled: 0 or -EXH_E_ABSENT, -EXH_E_IO */
int mps2_box_read_drive(struct exh_drive_in *in);
int mps2_box_write_drive(const struct exh_drive_out *out);
int mps2_box_read_glove(struct exh_glove_in *in);
void mps2_box_safe(void); /* any time, any context */
void mps2_box_report(void);

#endif
