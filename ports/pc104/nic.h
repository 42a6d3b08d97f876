/* SPDX-License-Identifier: MIT */
/* Intel 82574L (8086:10D3): frames in and out, polled. It never interrupts. */
#ifndef PC104_NIC_H
#define PC104_NIC_H

#include <stddef.h>
#include <stdint.h>

/* Finds it on the PCI bus, resets it, starts it; says what it found. 0, -EXH_E_ABSENT or
 * -EXH_E_IO. Needs a clock (exh_io_time_us). Takes 40 ms and, where it does not answer, 200. */
int pc104_nic_open(uint8_t mac[6]);

/* The frame that has waited longest, without its CRC: bytes; 0: none waits; < 0: one that came
 * damaged or in pieces, which is counted. After either, *frame is ours until pc104_nic_done(). */
int pc104_nic_next(const uint8_t **frame);
void pc104_nic_done(void);
void pc104_nic_back(void); /* after some frames: the card may refill them */

/* Where the next frame to be sent is to be put, 1514 bytes; NULL: all are under way. */
uint8_t *pc104_nic_room(void);
void pc104_nic_send(size_t len_B);

struct pc104_nic_counts {
    uint32_t sent, damaged; /* damaged: not whole, or with errors */
    uint32_t missed;        /* dropped by the card for lack of room */
    uint32_t crc;           /* by the card: damaged on the wire */
    uint8_t gone, up;       /* the card does not answer any more; the cable is up */
};
void pc104_nic_counts(struct pc104_nic_counts *c);

#endif
