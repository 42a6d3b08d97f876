/* SPDX-License-Identifier: MIT */
/* What is studied of the contact experiment: exit status. */
#ifndef LAB_CONTACT_STUDIES_H
#define LAB_CONTACT_STUDIES_H

#include "contact/bilateral.h"

int bilateral_sweep(const struct bilateral_options *o);
/* So many random approaches. */
int bilateral_check(const struct bilateral_options *o, int64_t approaches);
/* Over fingers and hands; over k and b. */
int bilateral_hands(const struct bilateral_options *o);
int bilateral_crisp(const struct bilateral_options *o);
/* What makes a contact settle and be silent: one of the table, from 1, or 0: all. */
int bilateral_remedies(const struct bilateral_options *o, int64_t which);
/* Every scene, finger, speed and link, so many seeds; networks: recorded ones, commas between, or
 * NULL. */
int bilateral_contacts(const struct bilateral_options *o, int64_t seeds, const char *networks);
/* A hand in the system before, and in this box. */
int bilateral_original(const struct bilateral_options *o);

#endif
