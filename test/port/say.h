/* SPDX-License-Identifier: MIT */
/* Where an image's checks are printed: by the port's PORT_SAY (port.mk) as they come; a port
 * without one keeps what is said for exh_board_halt(). */
#ifndef TEST_BOARD_SAY_H
#define TEST_BOARD_SAY_H

int contract_put(int c);
const char *contract_said(void);

#endif
