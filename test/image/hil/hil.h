/* SPDX-License-Identifier: MIT */
/* Hardware in the loop: an unmodified PC/104 image on an emulated processor, in virtual time.
 *
 * Time is made of what the image does and of nothing else: HIL_CPI cycles an instruction, so much
 * a port access, so much a conversion of a card. README.md states every model.
 */
#ifndef HIL_H
#define HIL_H

#include "chips.h"
#include "image.h"

#include <stdint.h>
#include <stdio.h>
#include <unicorn/unicorn.h>

#define HIL_RAM_B (16u << 20)

struct hil_cost {
    uint32_t insn_ps;  /* 2 cycles of a 1.6 GHz in-order Atom */
    uint32_t entry_ps; /* into an interrupt handler */
    uint32_t port_ps;  /* an access to a port behind the ISA or LPC bridge */
    uint32_t hpet_ps;  /* an access to the HPET */
};
extern const struct hil_cost hil_cost_default;

/* A function at an address that the harness watches. It is called before the block there runs. */
struct hil;
typedef void hil_watch_fn(struct hil *h, uint32_t address);
#define HIL_WATCHES 8

enum hil_end { HIL_RUNS, HIL_EXIT, HIL_HUNG, HIL_BROKEN };

struct hil {
    uc_engine *uc;
    uint8_t *ram;
    uint32_t entry;
    uint16_t *block; /* by address: instructions of the block that begins there; 0: not seen */
    struct hil_cost cost;
    struct chips chips;
    struct box *box; /* the cards; NULL: there are none */

    uint64_t now_ps;
    uint64_t wake_ps; /* the next thing that a chip does alone, or 0: an interrupt waits */
    uint64_t insns;   /* executed */
    uint64_t singly;  /* the same, counted one by one, slowly, if */
    int count_singly; /* that was set before hil_open() */
    uint64_t ports;   /* accesses, all of them */
    uint64_t cards;   /* those to the cards */
    uint64_t hpets;
    uint64_t irqs;     /* timer interrupts that went in */
    uint64_t late;     /* of them, those that found the image not waiting, since the first tick */
    int idle;          /* it waits in HLT */
    int waited;        /* and has before */
    uint32_t last_end; /* where the block before this one ended */
    int wants_stop;    /* the harness requested it, at the start of a block */
    int returns;       /* the harness did what a function should */
    uint32_t returned;
    uint32_t call;      /* a function of the image that the harness wants run; 0: none */
    uint32_t aside;     /* where it returns to, while it runs: nothing of it is counted */
    uint64_t max_insns; /* from here on it is taken to hang; 0: never */
    enum hil_end end;
    uint32_t status; /* of HIL_EXIT: what was written to the debug port */
    char why[160];   /* of HIL_BROKEN */
    FILE *records;   /* output of port 0xE9, or NULL */
    void (*line)(struct hil *h, const char *text); /* called with each line of it, or NULL */
    char text[256];
    unsigned text_n;

    struct hil_watch {
        uint32_t address;
        hil_watch_fn *fn;
    } watch[HIL_WATCHES];
    unsigned watches;
    void (*set)(struct hil *h);                     /* the timer was set, or NULL */
    void (*tick)(struct hil *h);                    /* at each timer interrupt, before it goes in */
    void (*wait)(struct hil *h);                    /* at each HLT: what was to be done is done */
    void (*block_fn)(uint32_t address, unsigned n); /* before each block, or NULL */
};

/* --- machine.c: processor, memory, interrupts --- */

/* Loaded. 0, or -1 after a line on stderr. */
int hil_open(struct hil *h, const char *image);
/* Ready to boot with this command line. */
void hil_command(struct hil *h, const char *image, const char *options);
#define HIL_COMMAND_B 1024u
void hil_close(struct hil *h);
/* Until the image exits, hangs or breaks. */
enum hil_end hil_run(struct hil *h);
/* Calls fn whenever control comes to that address, which must be a function or a return address. */
void hil_watch_at(struct hil *h, uint32_t address, hil_watch_fn *fn);
/* From a watch at a function: it is not run, the harness has done it, and gives this back. */
void hil_return(struct hil *h, uint32_t value);
/* From a watch: the function () at fn is run first, at no cost and in no time; then the watch is
 * called again. */
void hil_call(struct hil *h, uint32_t fn);
uint32_t hil_word(const struct hil *h, uint32_t address);
uint32_t hil_reg(const struct hil *h, int id);
void hil_broke(struct hil *h, const char *format, ...);

/* --- image.c: the ELF file --- */
int hil_load(struct hil *h, const char *path);

/* --- ports.c: what answers at which port --- */
int hil_ports_open(struct hil *h);

#endif
