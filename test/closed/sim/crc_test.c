/* SPDX-License-Identifier: MIT */
/* The host's CRC is the CRC of the bits, at every length, place and first value. */
#include "exhand/bytes.h"

#include "check.h"

#include "sim/random.h"

static uint32_t by_bits(uint32_t crc, const uint8_t *p, size_t len_B)
{
    for (crc = ~crc; len_B > 0; len_B--, p++) {
        crc ^= *p;
        for (int i = 0; i < 8; i++) { crc = crc >> 1 ^ (crc & 1 ? UINT32_C(0xEDB88320) : 0); }
    }
    return ~crc;
}

static struct sim_random fill(uint8_t *buf, size_t len_B)
{
    struct sim_random r = {1};
    for (size_t i = 0; i < len_B; i++) { buf[i] = (uint8_t)sim_random_u64(&r); }
    return r;
}

TEST(crc_is_that_of_the_bits)
{
    uint8_t buf[400];
    struct sim_random r = fill(buf, sizeof buf);
    for (size_t at = 0; at < 16; at++) {
        for (size_t n = 0; n + at <= sizeof buf; n++) {
            const uint32_t first = n % 3 ? (uint32_t)sim_random_u64(&r) : 0;
            CHECK(exh_crc32(first, buf + at, n) == by_bits(first, buf + at, n), "%zu bytes at %zu",
                n, at);
        }
    }
}

TEST(crc_of_parts_is_that_of_the_whole)
{
    uint8_t buf[400];
    (void)fill(buf, sizeof buf);
    for (size_t n = 0; n <= sizeof buf; n++) {
        CHECK(
            exh_crc32(exh_crc32(0, buf, n), buf + n, sizeof buf - n) == by_bits(0, buf, sizeof buf),
            "parted at %zu", n);
    }
}

TEST_MAIN("crc", crc_is_that_of_the_bits, crc_of_parts_is_that_of_the_whole);
