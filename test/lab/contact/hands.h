/* SPDX-License-Identifier: MIT */
/* Fingers and hands for the judgement of contacts. They range from the light finger of a child to a
 * heavy one with the exoskeleton, and from a hand that yields to a clenched one. All press with the
 * same force. */
#ifndef LAB_CONTACT_HANDS_H
#define LAB_CONTACT_HANDS_H

#include "box/hand.h"

#define HANDS 80

/* Hand i of HANDS, for all fingers. at: its mass, kg, stiffness, N/m, and damping, Ns/m; or NULL.
 */
void lab_hand(struct bilateral_run_cfg *c, int i, double at[3]);

#endif
