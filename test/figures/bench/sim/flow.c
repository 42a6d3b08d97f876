/* SPDX-License-Identifier: MIT */
/* The exact flow in doubles. */
#define REAL         double
#define FLOW_ADVANCE flow_advance
#include "flow_body.h"
