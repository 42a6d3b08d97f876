/* SPDX-License-Identifier: MIT */
/* Slots: an image of parameters or a calibration in flash. A power cut leaves the old or the new.
 *
 * There are two areas that can be erased separately, each with room for one image. The newest whole
 * image is valid, and saving writes to the other slot. So one slot is always whole. The caller
 * erases, programs and reads; these functions process bytes. The image has its own magic, version
 * and CRC (exh_params_save, exh_calib_save, exh_glove_cal_save). Use one pair of slots per kind.
 *
 * A slot contains "EXHS", sequence u32, length u32, the image, CRC-32 of all bytes before, and the
 * sequence again; little-endian. Later bytes are ignored. Program the bytes in order, the last word
 * last. After a power cut, there are two cases:
 *
 * - Between two words, with ones, zeros or an older image of the same length after the cut: the
 *   last word differs from the first sequence, or the slot is complete. This does not rely on the
 *   CRC.
 * - During an erasure, or within a word: bytes may be arbitrary. The CRC accepts them once in 2^32.
 *   It detects all errors of 1, 2 or 3 bits in images up to 11 kB, and all bursts of 32 bits.
 *
 * Save (buf has EXH_SLOT_B(2048) bytes), then load at start:
 *
 *   int32_t n = exh_params_save(&params, buf + EXH_SLOT_HEAD_B, sizeof buf - EXH_SLOT_B(0));
 *   if (n > 0) { n = exh_slots_encode(&to, slot[0], slot[1], SLOT_B, buf, sizeof buf, (size_t)n); }
 *   if (n > 0) { board_erase(slot[to], SLOT_B); board_program(slot[to], buf, n); }
 *   if (exh_slots_find(&is, slot[0], slot[1], SLOT_B) >= 0) {
 *       err = exh_params_load(&params, is.image, is.len_B, NULL);
 *   }
 *
 * If exh_slots_find() does not return to after saving, the flash is worn or protected; report it,
 * the old image remains valid. A whole image may be of another program version: the other slot
 * holds the one before. Erasing and programming take milliseconds and stop many processors. Never
 * save while a drive is enabled. */
#ifndef EXHAND_SLOTS_H
#define EXHAND_SLOTS_H

#include "exhand/error.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_SLOT_HEAD_B 12u /* bytes before the image */
#define EXH_SLOT_TAIL_B 8u  /* bytes after the image */
/* Bytes of a slot with an image of image_B bytes. A constant expression if image_B is one. */
#define EXH_SLOT_B(image_B) (EXH_SLOT_HEAD_B + (image_B) + EXH_SLOT_TAIL_B)

/* The content of a slot. */
struct exh_slot {
    const uint8_t *image; /* points into the slot */
    uint32_t len_B;       /* length of the image */
    uint32_t sequence;    /* 1 .. 2^32 - 2 */
};

/* Decodes a slot of slot_B bytes with any content; reads no byte beyond. -EXH_E_UNKNOWN: no "EXHS",
 * as in a blank slot. -EXH_E_SHORT: the slot is shorter than its content. -EXH_E_CRC: cut off or
 * damaged. After an error, *is is unchanged. */
int exh_slot_decode(struct exh_slot *is, const void *slot, size_t slot_B);

/* Returns the valid slot, 0 or 1, and decodes it to *newest. -EXH_E_ABSENT: neither is whole;
 * *newest is unchanged. Of two whole slots, the one whose sequence is 1 .. 2^31 - 1 ahead modulo
 * 2^32 is valid, else slot 0. */
int exh_slots_find(struct exh_slot *newest, const void *slot0, const void *slot1, size_t slot_B);

/* Prepares the next save. The caller puts an image of image_B bytes at buf + EXH_SLOT_HEAD_B. This
 * function writes head and tail around it. The new sequence follows the valid slot's; 1 follows
 * 2^32 - 2. Without a valid slot, it is slot 0 with sequence 1.
 * - Returns the bytes of buf to program at the start of slot *to, which the caller erases before.
 * - 0: the valid slot *to already holds this image. Do not wear the flash.
 * - -EXH_E_SHORT: the result exceeds cap_B, slot_B or 2^31 - 1. Nothing changes. */
int32_t exh_slots_encode(unsigned *to, const void *slot0, const void *slot1, size_t slot_B,
    void *buf, size_t cap_B, size_t image_B);

#ifdef __cplusplus
}
#endif
#endif
