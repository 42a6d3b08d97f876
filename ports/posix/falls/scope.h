/* SPDX-License-Identifier: MIT */
/* Contacts cut to what counts as a contact situation. */
#ifndef BASE_SCOPE_H
#define BASE_SCOPE_H

#include "falls/fall.h"

/* fall_dissect(), then cut to a scope. The motor "has stopped" where from there to the
 * end of its fall the encoder stays within one count, of step_m. */
enum fall_status fall_dissect_scope(
    const struct fall_log *log, const struct fall_opt *opt, struct fall_contacts *out);

#endif
