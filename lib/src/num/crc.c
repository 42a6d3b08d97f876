/* SPDX-License-Identifier: MIT */
/* CRC-32 for small memories. An image with 4 KiB to spare links lib/src/run/crc_table.c instead,
 * with the same results. */
#include "exhand/bytes.h"

#include "word.h"

uint32_t exh_crc32(uint32_t crc, const void *buf, size_t len_B)
{
    /* Steps of 4 bits: a table of 64 bytes instead of 1 KiB. Four bytes need one load. */
    static const uint32_t nibble[16] = {0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu,
        0x76DC4190u, 0x6B6B51F4u, 0x4DB26158u, 0x5005713Cu, 0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u,
        0xCB61B38Cu, 0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu};
    const uint8_t *p = (const uint8_t *)buf;
    crc = ~crc;
    for (; len_B >= 4; len_B -= 4, p += 4) {
        crc ^= word_at(p);
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
    }
    for (; len_B > 0; len_B--, p++) {
        crc ^= *p;
        crc = crc >> 4 ^ nibble[crc & 15];
        crc = crc >> 4 ^ nibble[crc & 15];
    }
    return ~crc;
}
