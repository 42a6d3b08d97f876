/* SPDX-License-Identifier: MIT */
/* From the log of a falling-mass run to a stiffness and to "came to rest or not".
 *
 * The paper's steps, each one function: cut the log by the collision signal, pool
 * the (position, monitored force) pairs, keep 0.8 .. 4.5 N, sort by force, average
 * ten positions, fit a line. fall_stiffness() runs them all; fall_rest() is the
 * stability rule.
 *
 * Only + - * / on doubles, no libm, no global state: built without contraction
 * and without x87, every machine prints the same digits. Lists are allocated
 * here and owned by the caller; after any return, also a failed one, they may be
 * released with their _free().
 */
#ifndef BASE_ANALYSIS_H
#define BASE_ANALYSIS_H

#include "falls/dissect.h"
#include "falls/pairs.h"
#include "falls/rest.h"
#include "falls/scope.h"
#include "falls/stiffness.h"

#endif
