/* SPDX-License-Identifier: MIT */
/* What the files that use libmodbus share. */
#ifndef CLI_MODBUS_LIBMODBUS_H
#define CLI_MODBUS_LIBMODBUS_H

#include <modbus/modbus.h>

#include <stdint.h>

/* Of "tcp:ADDRESS:PORT" and the like: the number behind the last colon, 0..most; -1: none. The text
 * is cut off at that colon. */
long modbus_cut_number(char *text, long most);

/* A connection, which a new one may replace. */
struct place {
    uint32_t address; /* its source, in network order */
    int asked;        /* 1: a whole request has come */
    double heard_s;   /* when the last came, or the connection */
};
/* Of n, the one that makes room for one more from `address`; -1: none, that one is turned away. */
int place_to_clear(const struct place *p, int n, uint32_t address, double now_s);

struct request {
    modbus_t *ctx;
    uint8_t *adu; /* MODBUS_MAX_ADU_LENGTH bytes */
    int head_B;   /* in front of its PDU */
    int len_B;    /* of both, */
    int tail_B;   /* and behind them */
    int silent;   /* to all: carried out, not answered */
};

int request_open(void); /* 0, or -1: no memory */
void request_close(void);

/* Function, length, counts of len bytes: 0 or an exception. What passes, libmodbus measures right.
 */
int request_shape(const uint8_t *pdu, unsigned len);

/* Carries it out and answers. 0, or -1: the answer could not be sent. */
int request_answer(struct request *q);

unsigned request_be16(const uint8_t *p);

#endif
