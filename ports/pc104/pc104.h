/* SPDX-License-Identifier: MIT */
/* Inside of the PC/104 port: what its files need from each other. */
#ifndef PC104_H
#define PC104_H

#include "exhand/run/scene.h"

#include "exhand/board.h"
#include "exhand/units.h"

#include <stdint.h>

/* --- uart.c: COM1, 115200 8N1, polled; a line that does not take a character in
 * time is given up, so that a missing UART costs a moment and never the program --- */
void pc104_uart_open(void);
void pc104_uart_put(char c);
unsigned pc104_uart_offer(const uint8_t *byte, unsigned n); /* bytes taken: 0 .. n */

/* --- say.c: text for people, over the UART --- */
void pc104_say(const char *text);
void pc104_say_u32(uint32_t value);
void pc104_say_hex(uint32_t value);
void pc104_say_fixed(int64_t raw, unsigned frac); /* raw * 2^-frac, at most 12 decimals */
int pc104_same_text(const char *a, const char *b);

/* --- cmdline.c: the words the loader was given, copied before paging hides nothing of
 * them by accident --- */
void pc104_cmdline_open(void);
/* Sets options, the box's and the scene's parameters by them; halts on what is none. */
void pc104_options(const struct exh_scene *sc);

/* --- number.c: decimal text to raw values and back, without rounding twice --- */
/* "-12.5e-3" times 2^frac, rounded half away from zero. 0, or -EXH_E_UNKNOWN (not a number of
 * at most 18 digits), -EXH_E_RANGE (no int32). */
int pc104_number(const char *text, unsigned frac, int32_t *raw);

/* --- option.c: the command line; halts on an invalid option --- */
/* for commissioning: shows on the real box that a failure ends safe */
enum pc104_provoke {
    PC104_PROVOKE_NONE,
    PC104_PROVOKE_DIVIDE,
    PC104_PROVOKE_OPCODE,
    PC104_PROVOKE_NULL,
    PC104_PROVOKE_WRITE,
    PC104_PROVOKE_STACK,
    PC104_PROVOKE_NMI,
    PC104_PROVOKE_SPURIOUS,
    PC104_PROVOKE_HANG,
    PC104_PROVOKE_SLOW,
    PC104_PROVOKE_TIMER,
    PC104_PROVOKE_ASSERT,
    PC104_PROVOKE_MASK,
    PC104_PROVOKE_IDLE,
    PC104_PROVOKE_TWICE, /* CARDS=none alone: an NMI into what makes safe */
    PC104_PROVOKE_RESET, /* as a watchdog does, if the run before did end */
    PC104_PROVOKE_MCE    /* exception 18, by an instruction */
};
enum pc104_log { PC104_LOG_OFF, PC104_LOG_SERIAL, PC104_LOG_DEBUG, PC104_LOG_UDP };
enum pc104_source { PC104_TIMER_AUTO, PC104_TIMER_HPET, PC104_TIMER_PIT };

/* Rows in option.c, in this order. */
struct pc104_par {
    int32_t rate_Hz;      /* 0: the scene's */
    int32_t ticks;        /* then stop; 0: never */
    int32_t timer;        /* enum pc104_source */
    int32_t log;          /* enum pc104_log */
    int32_t overload_max; /* late ticks tolerated, after the grace; one is forgotten in 10 s */
    int32_t grace_ticks;  /* first ticks in which they do not count */
    int32_t hang_ticks;   /* periods after which a tick counts as hung */
    int32_t budget_us;    /* stated cost of a tick; 0: measured */
    int32_t headroom_pct; /* of the cost, to be left free */
    int32_t provoke;      /* enum pc104_provoke */
    int32_t provoke_tick; /* at this tick */
    int32_t spin;         /* 1: the processor never sleeps */
    int32_t dump;         /* enum pc104_log: where the black box goes after a fault */
    int32_t dump_KiB;     /* of its memory that is used; 0: all */
    int32_t gap_s_q10;    /* so long the longest gap is looked for; 0: not */
};
extern struct pc104_par pc104_par;
extern const struct exh_signal_table pc104_option_table;
/* Rows in box.c, in this order. */
struct pc104_box_par {
    int32_t s526_a, s526_b, mm32xat; /* base addresses */
    int32_t monitor, supply, scan;
    int32_t din_invert_a, din_invert_b, out_invert_a, out_invert_b;
    int32_t ad_settle, ee_nominal;
    int32_t interval, scan_words;
    int32_t full;
    int32_t scan_slice, turns;
    int32_t watchdog;
};
extern struct pc104_box_par pc104_box_par;
extern const struct exh_signal_table pc104_box_table;
int32_t pc104_value_of(const struct exh_signal *row, const char *value); /* halts if it is none */
void pc104_refuse(const char *name, const char *value); /* begins the line that says why */
void pc104_refuse_range(const struct exh_signal *row, const char *value); /* halts */

/* --- restart.c: did the run before this boot end? --- */
void pc104_restart_look(void);  /* once, first thing; says if not */
void pc104_restart_begin(void); /* ticks run from here on */
void pc104_restart_end(void);   /* they ended in order */
int pc104_restart_fired(void);  /* 1: the run before did not */

/* --- provoke.c --- */
void pc104_provoke(int32_t what);

/* --- fifo.c: bytes that wait for a line, of log or dump; size_B is a power of two --- */
struct pc104_fifo {
    uint8_t *byte;
    uint32_t size_B, put, got; /* bytes in all, modulo 2^32 */
};
int pc104_fifo_put(struct pc104_fifo *f, const uint8_t *byte, uint32_t len_B); /* all or 0 */
int pc104_fifo_out(struct pc104_fifo *f, int32_t where, int now); /* 1: more can be sent now */
int pc104_fifo_wait(struct pc104_fifo *f, int32_t where);         /* 1: all is out; 0: stuck */
/* All out, or what is stuck is given up: so many bytes. */
uint32_t pc104_fifo_flush(struct pc104_fifo *f, int32_t where);

/* --- scene_full.c, or scene_rom.c for a scene of constants without log --- */
int pc104_scene_option(
    const struct exh_scene *sc, const char *name, const char *value); /* 0: not one of its */
void pc104_scene_check(const struct exh_scene *sc); /* all options are known: halts on bad ones */
void pc104_scene_ready(const struct exh_scene *sc);
void pc104_scene_dry(const struct exh_scene *sc, uint32_t tick, const struct exh_scene_in *in,
    const struct exh_drive_out *out);
void pc104_scene_start(const struct exh_scene *sc, struct exh_scene_board board);
void pc104_scene_before(uint32_t tick, struct exh_scene_in *in);
void pc104_scene_after(
    uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);
void pc104_scene_end(void);
int pc104_idle(void);       /* something to do while waiting: 0 if nothing is left */
void pc104_log_flush(void); /* what waits goes out, or is given up */
int pc104_log_take(const void *rec, size_t len_B); /* as exh_board_log() */

/* --- dump.c: the black box and its way out; dump_none.c: the scene has none --- */
int pc104_dump_open(void); /* 1: an option requests it; halts if it is impossible */
void pc104_dump_start(const struct exh_scene *sc, struct exh_scene_board board);
void pc104_dump_dry(void); /* the next record of a dry tick is followed by a keyframe */
void pc104_dump_before(uint32_t tick, struct exh_scene_in *in);
void pc104_dump_after(
    uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);
int pc104_dump_idle(void);         /* as pc104_idle() */
void pc104_dump_pause(void);       /* words follow: what is half out of a record goes first */
void pc104_dump_flush(int halted); /* all of it, behind the last words */

/* --- hpet.c, pit.c: counters of known frequency that interrupt on IRQ 0 --- */
struct pc104_timer {
    const char *name;
    uint32_t Hz;
    uint32_t counts_max; /* longest period */
};
/* Finds it and sees it count. 0, or -EXH_E_ABSENT or -EXH_E_IO with *why set. */
int pc104_hpet_open(struct pc104_timer *t, const char **why);
uint32_t pc104_hpet_now(void); /* modulo 2^32 */
void pc104_hpet_start(uint32_t first, uint32_t counts);
void pc104_hpet_stop(void);
int pc104_pit_open(struct pc104_timer *t, const char **why);
void pc104_pit_load(uint32_t divisor); /* 1 .. 65536: counts down from it, an interrupt at each 0 */
uint32_t pc104_pit_count(void);        /* present count, divisor .. 1 */
#define PC104_PIT_HZ 1193182u

/* --- second.c: the local APIC's timer, which only watches the first --- */
/* 1 if there is one. now: counts of the clock that it watches; Hz of it, and counts of a period. */
int pc104_second_open(uint32_t (*now)(void), uint32_t Hz, uint32_t period);
void pc104_second_arm(void);
void pc104_second_disarm(void);
extern volatile uint32_t pc104_second_fired;

/* --- timer.c: the one of them that makes the ticks --- */
int pc104_timer_choose(int32_t wanted); /* enum pc104_source; 0 or -EXH_E_ABSENT */
/* Refuses as exh_board_init() does. Interrupts stay off. */
int pc104_timer_set(uint32_t rate_Hz, struct exh_period *achieved);
uint32_t pc104_timer_highest_Hz(uint32_t cost_counts); /* whose period is no shorter */
void pc104_timer_start(void);
/* Calls idle() until it returns 0, then sleeps until a tick is due: ticks that were skipped, and
 * those that were due already when it was called. < 0: the timer is dead, by the second clock (-1)
 * or the want of its interrupts (-2). */
int pc104_timer_wait(int (*idle)(void), uint32_t *missed, uint32_t *late);
uint32_t pc104_timer_now(void);    /* counts, modulo 2^32 */
uint32_t pc104_timer_due(void);    /* the instant of the last tick that it waited for */
uint32_t pc104_timer_counts(void); /* in a period */
uint32_t pc104_timer_Hz(void);
void pc104_timer_kill(void); /* stops it behind everybody's back: a test */
void pc104_timer_hang(void); /* what is done between ticks never ends: a test */

/* --- module.c: calibrations of fingers that the loader brought, into the scene --- */
void pc104_modules(const struct exh_scene *sc);

/* --- overload.c: late ticks, of which one is forgotten each leak_ticks --- */
struct pc104_overload {
    uint32_t most, leak_ticks; /* tolerated; leak_ticks below 2^31 */
    uint32_t n, since_ticks;
};
/* passed_ticks: since the last call, those missed with them. 1: more than `most` are late. */
int pc104_overload_step(struct pc104_overload *o, uint32_t passed_ticks, uint32_t late);

/* --- gap.c: how long the processor is not ours --- */
struct pc104_gap {
    uint32_t longest, beyond; /* counts between two reads; how often more than `most` */
};
struct pc104_gap pc104_gap_look(uint32_t (*now)(void), uint64_t counts, uint32_t most);

/* --- load.c: what a tick costs, and too much of it --- */
void pc104_load_stop(void);                        /* no tick runs any more */
void pc104_load_scene(const struct exh_scene *sc); /* times dry ticks of it */
int pc104_load_fits(uint32_t rate_Hz);             /* 0 or -EXH_E_RATE, said */
void pc104_load_begin(void);                       /* a tick has begun, */
void pc104_load_end(void);                         /* and ended */
/* In this tick; halts when there were too many. */
void pc104_load_missed(uint32_t tick, uint32_t missed, uint32_t late);
void pc104_load_report(void);
extern const struct exh_signal_table pc104_load_table;
const int32_t *pc104_load_signals(void); /* values of that table, as they are now */

/* --- guard.c: paging with a guard page below the stack; a separate stack for double faults --- */
void pc104_guard_open(void);
/* The 4 MiB around it are a card's or the mark's (restart.c), not to be cached: 0, or -EXH_E_RANGE
 * where our memory is. */
int pc104_guard_device(uint32_t address);
int pc104_guard_hit(uint32_t address);
uint32_t pc104_guard_eip(void); /* where the double fault came from */

/* --- link.c: the network card and its traffic; link_none.c: no card --- */
int pc104_link_option(
    const char *name, const char *value); /* 0: not one of its; halts on bad ones */
void pc104_link_open(
    const struct exh_scene *sc); /* finds and prints the card, if an option names one */
void pc104_link_poll(void);      /* packets since the last tick: bounded work */
void pc104_link_dry(void);       /* the work of the worst tick, to be timed */
void pc104_link_report(void);
int pc104_link_up(void); /* 1: there is a card */
/* Of the log: bytes taken, 0: not now. now 0: may wait for more, 1: do not, 2: the last. */
unsigned pc104_link_log(const uint8_t *byte, unsigned n, int now);
void pc104_link_log_new(void); /* the next bytes are another stream */

/* --- modbus.c: the scene's registers on COM2, if an option says so --- */
int pc104_modbus_option(const char *name, const char *value); /* 0: not its; halts on bad ones */
void pc104_modbus_check(const struct exh_scene *sc);   /* halts where a card has COM2's ports */
void pc104_modbus_open(const struct exh_scene *sc);    /* finds the UART; says so */
void pc104_modbus_start(struct exh_scene_board board); /* halts where the rate does not hold it */
void pc104_modbus_poll(const struct exh_scene_in *in); /* behind a tick's outputs: bounded work */
uint8_t pc104_modbus_command(void); /* enum exh_command of the last request; then none */
/* The work of a tick, to be timed: part 0 the dearest request, 1 APPLY, else characters. 1: what
 * was staged may be applied in it */
int pc104_modbus_dry(unsigned part);
void pc104_modbus_report(void);

/* --- trap.c: interrupts, and processor exceptions that say their name. Opened, as
 * the UART, before main() --- */
void pc104_trap_open(void);

/* --- mce.c: machine checks --- */
void pc104_mce_open(void);            /* they come as an exception from here on */
void pc104_mce_taken(void);           /* another may come */
void pc104_mce_say(const char *what); /* a line of each bank that has a cause */

/* For a scene in floats: the FPU, or a halt without one that can; for all others nothing. */
void pc104_fpu_open(void);
struct pc104_frame {
    uint32_t vector, error, eip, cs, eflags;
};
void pc104_fault(struct pc104_frame frame);
void pc104_fault_again(void);
void pc104_double_fault(void);
void pc104_hung(uint32_t eip);
#define PC104_VECTOR_SECOND   48u
#define PC104_VECTOR_SPURIOUS 63u

/* --- halt.c --- */
/* exit codes for emulators: status 2 * value + 1 */
enum pc104_exit {
    PC104_EXIT_DONE = 0x10,
    PC104_EXIT_FAILED = 0x11, /* none may look like a failure of the emulator itself, 1 */
    PC104_EXIT_ABSENT = 0x12,
    PC104_EXIT_OPTION = 0x13,
    PC104_EXIT_FAULT = 0x14,
    PC104_EXIT_RATE = 0x15,
    PC104_EXIT_OVERLOAD = 0x16,
    PC104_EXIT_TIMER = 0x17
};
extern uint8_t pc104_exit_code; /* exit code of a run that did not end in order; 0: FAILED */
void pc104_halt(uint8_t code, const char *why);

/* --- board.c --- */
uint32_t pc104_tick(void);                        /* run so far */
void pc104_board_for(const struct exh_scene *sc); /* before exh_loop() */
void pc104_board_still(void); /* outputs to zero before exh_board_init(); says nothing */
int pc104_board_clock(void);  /* finds the timer; by exh_board_init() if not before */

/* --- crt0.S, vectors.S --- */
extern const uint32_t pc104_boot_magic;    /* what the loader left in EAX */
extern const uint32_t pc104_boot_info;     /* and in EBX: physical address */
extern volatile uint32_t pc104_ticks;      /* interrupts of the timer */
extern volatile uint32_t pc104_tick_began; /* their number when the tick began */
extern volatile uint32_t pc104_hang_ticks; /* 0: no check */
extern volatile uint32_t pc104_spurious;   /* spurious interrupts */

#endif
