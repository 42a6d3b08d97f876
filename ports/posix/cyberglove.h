/* SPDX-License-Identifier: MIT */
/* CyberGlove: decodes the serial bytes of a stock glove with 22 sensors into frames. A frame is 'S'
 * (streamed) or 'G' (requested), 22 samples 1 .. 255, optionally a status byte, optionally 'e' and
 * a letter, and 0. It has no checksum. So only its form counts, from the 0 before it to its own. A
 * frame with a zero sample or another length is discarded, together with a frame that runs into it.
 * A header among samples starts nothing.
 *
 * A frame with status that lost a byte looks like one without, with shifted samples. So if the unit
 * has confirmed that it sends the status, only such frames are accepted. Otherwise frames of the
 * form not in use are refused until CYBERGLOVE_SURE of them arrive in a row, also at the start. One
 * error is undetectable: bytes lost from the middle of one frame to the same place of another. No
 * IO, no allocation; any bytes, each in bounded time. */
#ifndef CYBERGLOVE_H
#define CYBERGLOVE_H

#include <stdint.h>

#define CYBERGLOVE_SENSORS 22
#define CYBERGLOVE_SURE    8
#define CYBERGLOVE_FRAME_B 25 /* header, samples, status, 0 */

/* Why a frame is discarded. */
enum cyberglove_cause {
    CYBERGLOVE_ZERO,      /* a sample is 0, or it ends early */
    CYBERGLOVE_EIGHTEEN,  /* it ends behind 18 samples: another glove */
    CYBERGLOVE_LENGTH,    /* it does not end where it should */
    CYBERGLOVE_FORM,      /* whole, but with a status byte where the others have none, or without */
    CYBERGLOVE_UNPLUGGED, /* its status or "eg" says: no glove on the unit */
    CYBERGLOVE_FAST,      /* "es": the requested rate is above that of the unit */
    CYBERGLOVE_CAUSES
};

/* All 0 before the first byte. */
struct cyberglove {
    uint8_t sample[CYBERGLOVE_SENSORS];   /* of the newest whole frame */
    uint8_t status;                       /* its; 0: it has none */
    uint8_t told;                         /* the caller's: 1, with status alone */
    uint8_t answer;                       /* to the last command: its letter, or 'e' */
    uint32_t frames;                      /* whole ones */
    uint32_t lost[CYBERGLOVE_CAUSES];     /* discarded */
    uint32_t replies, errors;             /* to commands: taken ("t", 0), refused ("e?", 0) */
    uint32_t strays;                      /* bytes that are none of these */
    uint8_t held[CYBERGLOVE_FRAME_B + 2]; /* since the last 0, */
    uint32_t n;                           /* so many, and those beyond */
    uint8_t form, sure;                   /* in use, 0: not known; frames of the other in a row */
    uint8_t rest;                         /* 1: the next bytes may belong to a discarded frame */
    uint8_t bare;                         /* 1: the last 0 may have been a status */
};

/* The next byte: 1, a whole frame ended with it; 0. */
int cyberglove_take(struct cyberglove *g, uint8_t byte);

/* A sample 1 .. 255 as a code of the paper's card: 1 is -9 V, 255 is 9 V, -29491 .. 29491. A step
 * is 232.2 codes, rounded to nearest. So units, parameters and limits of a calibration are equal
 * for both. */
int16_t cyberglove_raw(uint8_t sample);

/* "zero sample", ...; never NULL. */
const char *cyberglove_cause_text(unsigned cause);

#endif
