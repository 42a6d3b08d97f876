/* SPDX-License-Identifier: MIT */
/* An STM32F405 with an unmodified image: Unicorn's Cortex-M4 over the models, in virtual time. */
#ifndef MACHINE_H
#define MACHINE_H

#include "stm.h"

#include "../hil/image.h"

#include <stdio.h>
#include <unicorn/unicorn.h>

/* Cycles by the Cortex-M4's manual and the flash's buffers (cost.c). */
#define LINES  64u /* of 16 bytes: the flash's instruction cache */
#define BLOCKS (STM_FLASH_B / 2)
struct cost {
    struct block {
        uint16_t insns, cycles;
        uint8_t lines;
        uint64_t spent; /* cycles, in all */
    } * block;          /* by half-word of flash; insns 0: not seen */
    uint32_t line[LINES];
    uint64_t used[LINES], turn;
    int16_t place[STM_FLASH_B / 16]; /* where a line is, or -1 */
    uint64_t misses, stalls;
};
void cost_open(struct cost *c);
/* Cycles of the block at this address, with waits for the flash. */
uint32_t cost_of(struct cost *c, const uint8_t *flash, uint32_t off, uint32_t size, unsigned insns,
    unsigned wait_states);

enum machine_end { M_RUNS, M_HALTED, M_RESET, M_HUNG, M_BROKEN, M_DONE };

struct machine;
typedef void machine_watch_fn(struct machine *m);
#define WATCHES 10

struct machine {
    uc_engine *uc;
    struct stm s;
    uint8_t *flash, *ram, *ccm;
    struct cost cost;
    uint64_t insns, cycles, slept; /* units of time asleep */
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
void machine_broke(struct machine *m, const char *format, ...);
void machine_stop(struct machine *m, enum machine_end end);

#endif
