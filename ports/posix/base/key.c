/* SPDX-License-Identifier: MIT */
#include "base/key.h"

#include "base/option.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#define DIGITS (2 * EXH_MAC_KEY_B)

static int digit(char c)
{
    static const char digits[] = "0123456789abcdef0123456789ABCDEF";
    const char *at = c ? strchr(digits, c) : NULL;
    return at ? (int)(at - digits) % 16 : -1;
}

/* Only a line end may follow the digits. */
static int take(const char *text, size_t n, uint8_t byte[EXH_MAC_KEY_B])
{
    while (n > DIGITS && (text[n - 1] == '\n' || text[n - 1] == '\r')) { n--; }
    if (n != DIGITS) { return -1; }
    for (size_t i = 0; i < DIGITS; i += 2) {
        const int high = digit(text[i]), low = digit(text[i + 1]);
        if (high < 0 || low < 0) { return -1; }
        byte[i / 2] = (uint8_t)(high << 4 | low);
    }
    return 0;
}

int key_read(const char *path, struct exh_mac_key *key)
{
    char text[DIGITS + 3];
    uint8_t byte[EXH_MAC_KEY_B];
    struct stat is;
    size_t n;
    int open_to_all;
    FILE *f = fopen(path, "rb");
    if (f == NULL) {
        cli_complain("--key: %s: %s: give a file of 32 hexadecimal digits", path, strerror(errno));
        return 2;
    }
    setbuf(f, NULL); /* no copy of it stays in memory that is freed */
    open_to_all = fstat(fileno(f), &is) == 0 && is.st_mode & (S_IRGRP | S_IROTH);
    n = fread(text, 1, sizeof text, f);
    (void)fclose(f);
    if (take(text, n, byte)) {
        cli_complain("--key: %s: is not a key: give a file of 32 hexadecimal digits and nothing "
                     "else (head -c16 /dev/urandom | od -An -tx1 | tr -d ' ')",
            path);
        return 2;
    }
    if (open_to_all) { cli_complain("--key: %s: others may read it: chmod 600 %s", path, path); }
    *key = exh_mac_key(byte);
    return 0;
}

uint64_t key_start(void)
{
    uint64_t number = 0;
    struct timespec t = {0, 0};
    FILE *f = fopen("/dev/urandom", "rb");
    const int random = f && fread(&number, sizeof number, 1, f) == 1;
    if (f) { (void)fclose(f); }
    (void)clock_gettime(CLOCK_REALTIME, &t);
    /* Of a machine without that file, the clock's: no number comes again but by chance. */
    return random ? number : (uint64_t)t.tv_sec * UINT64_C(1000000000) + (uint64_t)t.tv_nsec;
}
