/* SPDX-License-Identifier: MIT */
/* The key of a link, from a file: 32 hexadecimal digits. It is in no log, no parameter and no line
 * that is said. */
#ifndef BASE_KEY_H
#define BASE_KEY_H

#include "exhand/mac.h"

/* --key. 0, or 2 after a line on stderr, which never shows what the file holds. A file that others
 * may read is taken, and said. */
int key_read(const char *path, struct exh_mac_key *key);

/* Where this run's numbers begin: random, so that none comes again. */
uint64_t key_start(void);

#endif
