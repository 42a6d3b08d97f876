/* What is behind the cards: the simulated device, and beside it the POSIX port doing the same run. */
#ifndef HIL_WORLD_H
#define HIL_WORLD_H

#include "hil.h"

/* 1: a card answered. */
int world_in(struct world *w, struct hil *h, uint16_t port, unsigned size, uint32_t *value);
int world_out(struct world *w, struct hil *h, uint16_t port, unsigned size, uint32_t value);
/* The timer was set anew: time begins again. */
void world_rewind(struct world *w);

#endif
