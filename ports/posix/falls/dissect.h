/* SPDX-License-Identifier: MIT */
/* Cuts a log into contacts. */
#ifndef BASE_DISSECT_H
#define BASE_DISSECT_H

#include "falls/fall.h"

/* Cuts at the edges of c. A fall's end closes a contact (open = 1), it never runs
 * on into the next fall. Contacts shorter than min_samples are dropped (0 and 1
 * keep all); a gap in c, however short, separates two contacts. */
enum fall_status fall_dissect(
    const struct fall_log *log, size_t min_samples, struct fall_contacts *out);
void fall_contacts_free(struct fall_contacts *contacts);

/* The sample behind the last of a fall, and whether a log can be used. */
size_t fall_end(const struct fall_log *log, size_t fall);
enum fall_status fall_check_log(const struct fall_log *log);

#endif
