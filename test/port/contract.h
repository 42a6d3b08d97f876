/* SPDX-License-Identifier: MIT */
/* Between the contract test and who runs it. */
#ifndef TEST_CONTRACT_H
#define TEST_CONTRACT_H

#include <stdint.h>

extern uint32_t contract_rate_Hz; /* who runs it says */

/* All checks, printed by test/support.c; 0: they passed. */
int contract_main(void);

#endif
