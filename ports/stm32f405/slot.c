/* SPDX-License-Identifier: MIT */
/* Parameters and calibrations in flash sectors 10 and 11, by slots.h.
 *
 * Erasing stops the processor for a second or more, so nothing is written while the loop runs. A
 * save puts the image into memory that no start clears, and resets the chip. The next start writes
 * it before the watchdog runs. Resistors and this port hold D/A and drives at zero. If the supply
 * fails at any word, the older slot stays valid.
 *
 * Image: u32 length of the parameters' image, that image; then for each calibration u32 length and
 * its image. If no slot has calibrations, those flashed at FIRST, 4 KiB apart, are used. So a new
 * board gets its first ones, and the next save includes them. */
#include "stm.h"

#include "exhand/board.h"
#include "exhand/bytes.h"
#include "exhand/calibrate.h"
#include "exhand/error.h"
#include "exhand/slots.h"

#include <string.h>

#define SLOT_B      16384u
#define IMAGE_MAX_B 4096u
#define MAGIC       0x45584853u /* a save, over a reset */
#define FIRST       0x080A0000u /* sector 9 */
#define FIRST_STEP  4096u
#define POLLS       400000000u /* 128 KiB take 2 s at most: data sheet */
#define WORD        2u         /* FLASH_CR_PSIZE: 32 bits, from 2.7 V */
#define ERRORS \
    (FLASH_SR_OPERR | FLASH_SR_WRPERR | FLASH_SR_PGAERR | FLASH_SR_PGPERR | FLASH_SR_PGSERR)

static __attribute__((section(".noinit"))) struct {
    uint32_t magic, image_B, crc;
    uint32_t word[EXH_SLOT_B(IMAGE_MAX_B) / 4];
} mail;

static uint8_t *bytes(void) { return (uint8_t *)mail.word; }

static const void *slot(unsigned i)
{
    return (const void *)(i ? FLASH_SECTOR_11 : FLASH_SECTOR_10);
}

/* --- flash --- */

static int ready(void)
{
    uint32_t n = 0;
    while (n < POLLS && REG(BASE_FLASH, FLASH_SR) & FLASH_SR_BSY) { n++; }
    return n < POLLS && !(REG(BASE_FLASH, FLASH_SR) & ERRORS);
}

static int program(unsigned to, uint32_t len_B)
{
    int good;
    REG(BASE_FLASH, FLASH_KEYR) = FLASH_KEY1;
    REG(BASE_FLASH, FLASH_KEYR) = FLASH_KEY2;
    REG(BASE_FLASH, FLASH_SR) = ERRORS | FLASH_SR_EOP;
    REG(BASE_FLASH, FLASH_CR) =
        PUT(FLASH_CR_PSIZE, WORD) | PUT(FLASH_CR_SNB, 10 + to) | FLASH_CR_SER;
    REG(BASE_FLASH, FLASH_CR) |= FLASH_CR_STRT;
    good = ready();
    REG(BASE_FLASH, FLASH_CR) = PUT(FLASH_CR_PSIZE, WORD) | FLASH_CR_PG;
    for (uint32_t i = 0; good && i < (len_B + 3) / 4; i++) {
        REG(slot(to), 4 * i) = mail.word[i];
        good = ready();
    }
    REG(BASE_FLASH, FLASH_CR) = FLASH_CR_LOCK;
    REG(BASE_FLASH, FLASH_ACR) &= ~FLASH_ACR_DCEN; /* its content is stale */
    REG(BASE_FLASH, FLASH_ACR) |= FLASH_ACR_DCRST;
    REG(BASE_FLASH, FLASH_ACR) &= ~FLASH_ACR_DCRST;
    REG(BASE_FLASH, FLASH_ACR) |= FLASH_ACR_DCEN;
    return good;
}

/* --- at start --- */

void stm_slot_write(void)
{
    struct exh_slot is;
    unsigned to = 0;
    int32_t n;
    const int asked = mail.magic == MAGIC && mail.image_B <= IMAGE_MAX_B &&
                      mail.crc == exh_crc32(0, bytes() + EXH_SLOT_HEAD_B, mail.image_B);
    mail.magic = 0;
    if (!asked) { return; }
    n = exh_slots_encode(&to, slot(0), slot(1), SLOT_B, mail.word, sizeof mail.word, mail.image_B);
    if (n <= 0) {
        stm_say(n < 0 ? "slot: the image is too long\n" : "slot: nothing is new\n");
        return;
    }
    stm_mpu(0);
    n = program(to, (uint32_t)n);
    stm_mpu(1);
    stm_say(n && exh_slots_find(&is, slot(0), slot(1), SLOT_B) == (int)to
                ? "slot: saved\n"
                : "slot: not saved, the one before counts: the flash is worn or protected\n");
}

static void take(struct exh_scene_calib *k, const uint8_t *image, uint32_t len_B)
{
    if (k == NULL || k->images == EXH_FINGERS) { return; }
    k->image[k->images].byte = image;
    k->image[k->images++].len_B = len_B;
}

static uint32_t u32_at(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

/* What is in an image beyond its end is no length of anything. */
static void unpack(const struct exh_scene *sc, const struct exh_slot *is)
{
    uint32_t at = 0;
    for (unsigned part = 0; at + 4 <= is->len_B; part++) {
        const uint32_t len_B = u32_at(is->image + at);
        at += 4;
        if (len_B > is->len_B - at) { return; }
        if (part == 0) {
            const int err = exh_params_load(sc->params, is->image + at, len_B, NULL);
            stm_say("slot: parameters ");
            stm_say(err < 0 ? exh_error_text(err) : "taken");
            stm_say("\n");
        } else {
            take(sc->calib, is->image + at, len_B);
        }
        at += len_B;
    }
}

static void take_first(struct exh_scene_calib *k)
{
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const uint8_t *const image = (const uint8_t *)(FIRST + i * FIRST_STEP);
        const uint32_t points = image[6] | (uint32_t)image[7] << 8;
        if (memcmp(image, "EXHC", 4) == 0 && points <= EXH_CALIB_POINTS_MAX) {
            take(k, image, EXH_CALIB_IMAGE_B - 16u * (EXH_CALIB_POINTS_MAX - points));
        }
    }
}

void stm_slot_load(const struct exh_scene *sc)
{
    struct exh_slot is;
    if (exh_slots_find(&is, slot(0), slot(1), SLOT_B) >= 0) { unpack(sc, &is); }
    if (sc->calib == NULL) { return; }
    if (sc->calib->images == 0) { take_first(sc->calib); }
    stm_say("calibrations ");
    stm_say_u32(sc->calib->images);
    stm_say("\n");
}

/* --- at rest --- */

static void put_u32(uint8_t *p, uint32_t v)
{
    for (unsigned i = 0; i < 4; i++) { p[i] = (uint8_t)(v >> 8 * i); }
}

/* Length of the whole, 0: it does not fit. */
static uint32_t pack(const struct exh_scene *sc)
{
    uint8_t *const p = bytes() + EXH_SLOT_HEAD_B;
    const int32_t n = exh_params_save(sc->params, p + 4, IMAGE_MAX_B - 4);
    uint32_t at;
    if (n < 0) { return 0; }
    put_u32(p, (uint32_t)n);
    at = 4 + (uint32_t)n;
    for (unsigned i = 0; sc->calib && i < sc->calib->images; i++) {
        const uint32_t len_B = sc->calib->image[i].len_B;
        if (len_B + 4 > IMAGE_MAX_B - at) { return 0; }
        put_u32(p + at, len_B);
        memcpy(p + at + 4, sc->calib->image[i].byte, len_B);
        at += 4 + len_B;
    }
    return at;
}

void stm_slot_save(const struct exh_scene *sc)
{
    exh_board_safe();
    mail.image_B = pack(sc);
    if (mail.image_B == 0) { return; }
    mail.crc = exh_crc32(0, bytes() + EXH_SLOT_HEAD_B, mail.image_B);
    mail.magic = MAGIC;
    stm_log_flush();
    stm_say("slot: to be saved: reset\n");
    __asm__ volatile("dsb" : : : "memory");
    REG(BASE_SCS, SCB_AIRCR) = SCB_AIRCR_KEY | SCB_AIRCR_RESET;
    for (;;) {}
}
