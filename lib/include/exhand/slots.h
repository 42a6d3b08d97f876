/* SPDX-License-Identifier: MIT */
/* Slots: an image of parameters or of a calibration in flash, that a power cut at any moment leaves
 * old or new.
 *
 * Two areas of memory that is erased as a whole, each with room for one image. The newest whole one
 * counts; what is saved goes to the other. So there is no moment in which none is whole. What
 * erases, programs and reads is the caller's; these are functions of bytes. In no slot an image has
 * a meaning: it has its own magic, version and CRC (exh_params_save, exh_calib_save,
 * exh_glove_cal_save), one kind a pair of slots.
 *
 * A slot: "EXHS", sequence u32, length u32, the image, CRC-32 of all before it, the sequence once
 * more; little-endian. Bytes behind it do not count. They are to be programmed in their order, so
 * the last word is the last:
 *   - cut off between any two of them, with ones, zeros or an older image of the same length
 * standing behind the cut: the last word is not the first sequence, or everything is there. For
 * certain, not by the CRC;
 *   - cut off within an erasure, or within a word that is programmed, bytes may be anything: the
 * CRC takes them for whole once in 2^32. It finds every 1, 2 or 3 bits that turn over in images up
 * to 11 kB, and every 32 in a row.
 *
 *     static uint8_t buf[EXH_SLOT_B(2048)];
 *     unsigned to;
 *     int32_t n = exh_params_save(&params, buf + EXH_SLOT_HEAD_B, sizeof buf - EXH_SLOT_B(0));
 *     if (n > 0) { n = exh_slots_encode(&to, slot[0], slot[1], SLOT_B, buf, sizeof buf, (size_t)n);
 * } if (n > 0) { board_erase(slot[to], SLOT_B); board_program(slot[to], buf, n); if
 * (exh_slots_find(&is, slot[0], slot[1], SLOT_B) != (int)to) { ... worn or protected: tell; the old
 * one counts ... }
 *     }
 *
 *     at start: if (exh_slots_find(&is, slot[0], slot[1], SLOT_B) >= 0) { exh_params_load(&params,
 * is.image, is.len_B, NULL); }
 *
 * An image that is whole may be of another version of the program: whoever wants what was before
 * reads the other slot. Erasing and programming take milliseconds and stop many processors: not
 * while a drive is on.
 */
#ifndef EXHAND_SLOTS_H
#define EXHAND_SLOTS_H

#include "exhand/error.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_SLOT_HEAD_B 12u /* before the image */
#define EXH_SLOT_TAIL_B 8u  /* behind it */
/* Bytes of a slot that holds an image of image_B bytes: a constant expression if that is one. */
#define EXH_SLOT_B(image_B) (EXH_SLOT_HEAD_B + (image_B) + EXH_SLOT_TAIL_B)

/* What is in a slot. */
struct exh_slot {
    const uint8_t *image; /* in the slot itself */
    uint32_t len_B;       /* of the image */
    uint32_t sequence;    /* 1 .. 2^32 - 2 */
};

/* What is in the slot_B bytes of a slot, blank, damaged or anything. 0; -EXH_E_UNKNOWN: nothing was
 * ever saved there
 * ("EXHS" is missing: as when it is blank); -EXH_E_SHORT: the slot is shorter than what it should
 * hold; -EXH_E_CRC: cut off or damaged; *is is untouched then. Reads no byte beyond. */
int exh_slot_decode(struct exh_slot *is, const void *slot, size_t slot_B);

/* 0 or 1, the slot that counts, and what is in it; -EXH_E_ABSENT: none of both is whole, *newest is
 * untouched. Of two the one whose sequence is 1 .. 2^31 - 1 ahead of the other's, mod 2^32; slot 0
 * if neither is. */
int exh_slots_find(struct exh_slot *newest, const void *slot0, const void *slot1, size_t slot_B);

/* What is to be saved next: the caller has put an image of image_B bytes into buf +
 * EXH_SLOT_HEAD_B; this writes head and tail around it. Returns how many bytes of buf are to be
 * programmed, from the beginning of slot *to (erased before, where it has to be); 0: the slot that
 * counts, *to, holds this image, and nothing is to be done (it wears); -EXH_E_SHORT: more than
 * cap_B or slot_B, or those above 2^31 - 1: nothing is written, *to is untouched. The sequence is
 * the one behind that of the slot that counts, 1 behind 2^32 - 2; of none, slot 0 and 1. */
int32_t exh_slots_encode(unsigned *to, const void *slot0, const void *slot1, size_t slot_B,
    void *buf, size_t cap_B, size_t image_B);

#ifdef __cplusplus
}
#endif
#endif
