/* SPDX-License-Identifier: MIT */
/* An STM32F405 with an unmodified image: Unicorn's Cortex-M4 over the models, in virtual time. */
#ifndef MACHINE_H
#define MACHINE_H

#include "stm.h"

#include "../hil/image.h"

#include <stdio.h>
#include <unicorn/unicorn.h>

/* Cycles by the Cortex-M4's manual and the flash's buffers (cost.c). */
#define LINES      64u /* of 16 bytes: the flash's instruction cache */
#define DATA_LINES 8u
#define BLOCKS     (STM_FLASH_B / 2)
struct lines {
    unsigned n;
    uint32_t line[LINES];
    uint64_t used[LINES], turn;
    int16_t place[STM_FLASH_B / 16]; /* where a line is, or -1 */
};
struct cost {
    struct block {
        uint16_t insns, cycles, least;
        uint8_t lines, conditional; /* its last branch takes longer if it is taken */
        uint32_t tick, most;        /* cycles in this tick and in the dearest */
        uint64_t spent;             /* in all */
    } * block;                      /* by half-word of flash; insns 0: not seen */
    struct lines code, data;
    uint32_t at, since; /* line that runs, and for how many cycles */
    uint32_t end;       /* of the block before this */
    uint8_t conditional;
    uint64_t stalls, data_stalls;
    struct block *run[BLOCKS]; /* of this tick */
    uint32_t runs;
};
/* Cycles, with waits for the flash, and the fewest that the manuals allow. */
struct spent {
    uint32_t most, least;
};
void cost_open(struct cost *c);
/* Of the block at this address; of a word read from flash. */
struct spent cost_of(
    struct cost *c, const uint8_t *flash, uint32_t off, uint32_t size, unsigned wait_states);
uint32_t cost_of_data(struct cost *c, uint32_t off, unsigned wait_states);
/* A tick begins; the tick that ends is the dearest so far. */
void cost_begin(struct cost *c);
void cost_keep(struct cost *c);

enum machine_end { M_RUNS, M_HALTED, M_RESET, M_HUNG, M_BROKEN, M_DONE };

struct machine;
typedef void machine_watch_fn(struct machine *m);
#define WATCHES 10

struct machine {
    uc_engine *uc;
    struct stm s;
    uint8_t *flash, *ram, *ccm;
    struct cost cost;
    struct block *runs;
    uint64_t insns, cycles, least; /* as the processor's clock counts, at most and at least */
    uint64_t slept;                /* units of time asleep */
    uint32_t speed, part;          /* the processor is so many times as fast; cycles left over */
    uint64_t entered;              /* exceptions */
    enum machine_end end;
    char why[160];
    struct {
        uint32_t at;
        machine_watch_fn *fn;
    } watch[WATCHES];
    unsigned watches;
    uint8_t watched[STM_FLASH_B / 2 / 8];
    uint8_t faulted, guarded;
    uint32_t aside; /* where a call of the harness's returns to, while it runs */
    uint32_t call;  /* a function of the image that the harness wants run; 0: none */
    uint32_t store_at, store_was, store_value, store_size; /* a store into flash under way */
    uint64_t stop_at; /* a time at which the run pauses (M_DONE), or 0 */
    void *ctx;
};

/* 0, or -1 after a line on stderr. image: ELF; NULL: an empty flash. */
int machine_open(struct machine *m, const char *image);
void machine_close(struct machine *m);
/* The processor begins at the vectors. */
void machine_boot(struct machine *m);
enum machine_end machine_run(struct machine *m);
void machine_watch(struct machine *m, uint32_t address, machine_watch_fn *fn);
/* From a watch: the function () at fn is run first, then the watch is called again. */
void machine_call(struct machine *m, uint32_t fn);
uint32_t machine_reg(const struct machine *m, int id);
void machine_set_reg(struct machine *m, int id, uint32_t v);
uint32_t machine_word(const struct machine *m, uint32_t address);
/* n bytes of the image's memory, or NULL. */
uint8_t *machine_at(struct machine *m, uint32_t address, uint32_t n);
void machine_broke(struct machine *m, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void machine_stop(struct machine *m, enum machine_end end);

#endif
