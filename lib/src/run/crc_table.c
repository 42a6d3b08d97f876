/* SPDX-License-Identifier: MIT */
/* CRC-32 in steps of four bytes with a table of 4 KiB; on a 64-bit host of eight, with 8 KiB. Link
 * this object to replace the library's CRC (lib/src/num/crc.c). */
#include "exhand/bytes.h"

#include "../num/word.h"

/* The contribution of a byte is the sum, modulo 2, of those of its bits. */
#define BIT(n, b, adds) ((1u << (b) & (n)) != 0 ? UINT32_C(adds) : 0)
#define OF_0(n) \
    (BIT(n, 0, 0x77073096) ^ BIT(n, 1, 0xEE0E612C) ^ BIT(n, 2, 0x076DC419) ^ \
        BIT(n, 3, 0x0EDB8832) ^ BIT(n, 4, 0x1DB71064) ^ BIT(n, 5, 0x3B6E20C8) ^ \
        BIT(n, 6, 0x76DC4190) ^ BIT(n, 7, 0xEDB88320))
#define OF_1(n) \
    (BIT(n, 0, 0x191B3141) ^ BIT(n, 1, 0x32366282) ^ BIT(n, 2, 0x646CC504) ^ \
        BIT(n, 3, 0xC8D98A08) ^ BIT(n, 4, 0x4AC21251) ^ BIT(n, 5, 0x958424A2) ^ \
        BIT(n, 6, 0xF0794F05) ^ BIT(n, 7, 0x3B83984B))
#define OF_2(n) \
    (BIT(n, 0, 0x01C26A37) ^ BIT(n, 1, 0x0384D46E) ^ BIT(n, 2, 0x0709A8DC) ^ \
        BIT(n, 3, 0x0E1351B8) ^ BIT(n, 4, 0x1C26A370) ^ BIT(n, 5, 0x384D46E0) ^ \
        BIT(n, 6, 0x709A8DC0) ^ BIT(n, 7, 0xE1351B80))
#define OF_3(n) \
    (BIT(n, 0, 0xB8BC6765) ^ BIT(n, 1, 0xAA09C88B) ^ BIT(n, 2, 0x8F629757) ^ \
        BIT(n, 3, 0xC5B428EF) ^ BIT(n, 4, 0x5019579F) ^ BIT(n, 5, 0xA032AF3E) ^ \
        BIT(n, 6, 0x9B14583D) ^ BIT(n, 7, 0xED59B63B))
#define WIDE (UINTPTR_MAX > UINT32_MAX)
#if WIDE
#define OF_4(n) \
    (BIT(n, 0, 0x3D6029B0) ^ BIT(n, 1, 0x7AC05360) ^ BIT(n, 2, 0xF580A6C0) ^ \
        BIT(n, 3, 0x30704BC1) ^ BIT(n, 4, 0x60E09782) ^ BIT(n, 5, 0xC1C12F04) ^ \
        BIT(n, 6, 0x58F35849) ^ BIT(n, 7, 0xB1E6B092))
#define OF_5(n) \
    (BIT(n, 0, 0xCB5CD3A5) ^ BIT(n, 1, 0x4DC8A10B) ^ BIT(n, 2, 0x9B914216) ^ \
        BIT(n, 3, 0xEC53826D) ^ BIT(n, 4, 0x03D6029B) ^ BIT(n, 5, 0x07AC0536) ^ \
        BIT(n, 6, 0x0F580A6C) ^ BIT(n, 7, 0x1EB014D8))
#define OF_6(n) \
    (BIT(n, 0, 0xA6770BB4) ^ BIT(n, 1, 0x979F1129) ^ BIT(n, 2, 0xF44F2413) ^ \
        BIT(n, 3, 0x33EF4E67) ^ BIT(n, 4, 0x67DE9CCE) ^ BIT(n, 5, 0xCFBD399C) ^ \
        BIT(n, 6, 0x440B7579) ^ BIT(n, 7, 0x8816EAF2))
#define OF_7(n) \
    (BIT(n, 0, 0xCCAA009E) ^ BIT(n, 1, 0x4225077D) ^ BIT(n, 2, 0x844A0EFA) ^ \
        BIT(n, 3, 0xD3E51BB5) ^ BIT(n, 4, 0x7CBB312B) ^ BIT(n, 5, 0xF9766256) ^ \
        BIT(n, 6, 0x299DC2ED) ^ BIT(n, 7, 0x533B85DA))
#endif
#define FOUR(of, n)    of(n), of(n + 1), of(n + 2), of(n + 3)
#define SIXTEEN(of, n) FOUR(of, n), FOUR(of, n + 4), FOUR(of, n + 8), FOUR(of, n + 12)
#define SIXTY_FOUR(of, n) \
    SIXTEEN(of, n), SIXTEEN(of, n + 16), SIXTEEN(of, n + 32), SIXTEEN(of, n + 48)
#define ALL(of) SIXTY_FOUR(of, 0u), SIXTY_FOUR(of, 64u), SIXTY_FOUR(of, 128u), SIXTY_FOUR(of, 192u)

/* [k][b]: byte b, followed by k zero bytes. */
static const uint32_t table[WIDE ? 8 : 4][256] = {
    {ALL(OF_0)}, {ALL(OF_1)}, {ALL(OF_2)}, {ALL(OF_3)},
#if WIDE
    {ALL(OF_4)}, {ALL(OF_5)}, {ALL(OF_6)}, {ALL(OF_7)}
#endif
};

uint32_t exh_crc32(uint32_t crc, const void *buf, size_t len_B)
{
    const uint8_t *p = buf;
    crc = ~crc;
#if WIDE
    for (; len_B >= 8; len_B -= 8, p += 8) {
        const uint32_t next = word_at(p + 4);
        crc ^= word_at(p);
        crc = table[7][crc & 255] ^ table[6][crc >> 8 & 255] ^ table[5][crc >> 16 & 255] ^
              table[4][crc >> 24] ^ table[3][next & 255] ^ table[2][next >> 8 & 255] ^
              table[1][next >> 16 & 255] ^ table[0][next >> 24];
    }
#endif
    for (; len_B >= 4; len_B -= 4, p += 4) {
        crc ^= word_at(p);
        crc = table[3][crc & 255] ^ table[2][crc >> 8 & 255] ^ table[1][crc >> 16 & 255] ^
              table[0][crc >> 24];
    }
    for (; len_B > 0; len_B--, p++) { crc = crc >> 8 ^ table[0][(crc ^ *p) & 255]; }
    return ~crc;
}
