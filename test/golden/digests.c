/* SPDX-License-Identifier: MIT */
/* What the generator found of each module. */
#include "modules.h"

#include "digests.inc"
