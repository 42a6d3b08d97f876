/* SPDX-License-Identifier: MIT */
/* The scene's registers on UART4 by the library's slave (docs/MODBUS.md): address 1, 19200 8E1.
 * Reading is open; MODBUS=write at build lets clients stage, APPLY, SAVE and command OFF. */
#include "stm.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/modbus_rtu.h"

#include <string.h>

#ifndef STM_MODBUS_WRITE
#define STM_MODBUS_WRITE 0
#endif
#define ADDRESS 1u
#define BAUD    19200u
#define VALUES  512u /* parameters of a scene */
#define FRAMES  32u  /* of a trace */

static struct exh_regs regs;
static struct exh_modbus_rtu line;
static struct exh_trace trace;
static struct exh_trace_frame frame[FRAMES];
static const struct exh_scene *scene;
static int32_t staged[VALUES], was[VALUES];
static uint32_t touched[EXH_REGS_WORDS(VALUES)];
static uint8_t answer[EXH_MODBUS_ADU_B];
static uint32_t tick_us;
static uint8_t open, command, save;

static int trace_fits(void)
{
    return scene->safety && exh_trace_setup(&trace, frame, FRAMES, regs.signals_n) == 0;
}

void stm_modbus_open(const struct exh_scene *sc)
{
    scene = sc;
    memset(&regs, 0, sizeof regs);
    regs.name = sc->name;
    regs.signals = sc->values ? sc->signals : NULL;
    regs.signal = sc->values;
    regs.fingers = sc->fingers;
    regs.may = STM_MODBUS_WRITE ? EXH_REGS_MAY | 1u << EXH_COIL_SAVE : 0u;
    regs.params = sc->params->table;
    regs.active = sc->params->active;
    regs.wanted = sc->params->staged;
    regs.staged = staged;
    regs.touched = touched;
    open = exh_signal_count(regs.params) <= VALUES && exh_regs_setup(&regs) == 0 &&
           exh_modbus_rtu_setup(&line, ADDRESS, BAUD) == 0;
    if (open && trace_fits()) { regs.trace = &trace; }
    stm_say(
        open ? "modbus: address 1, 19200 8E1\n" : "modbus: none, the scene's tables are larger\n");
}

void stm_modbus_start(struct exh_scene_board board)
{
    regs.T = board.T;
    tick_us = (uint32_t)exh_udiv64(UINT64_C(1000000) * board.T.num, board.T.den, NULL);
}

uint8_t stm_modbus_command(void)
{
    const uint8_t now = command;
    command = EXH_CMD_NONE;
    return now;
}

int stm_modbus_save(void) { return save && !stm_uart_busy(STM_MODBUS); }

/* All that is staged or nothing: a scene's rule judges the values together. */
static int apply(void)
{
    struct exh_params *const p = scene->params;
    const uint8_t pending = p->pending;
    int err;
    memcpy(was, p->staged, 4 * (size_t)p->count);
    if (scene->safety) { regs.box.state = scene->safety->state; } /* it may run by now */
    err = exh_regs_apply(&regs, p);
    if (err == 0 && scene->allowed) { err = scene->allowed(); }
    if (err < 0) { exh_params_rollback(p, was, pending); }
    return err;
}

/* Only in OFF, with fingers at rest: a save restarts the box. */
static int may_save(void)
{
    const uint8_t state = scene->safety ? scene->safety->state : (uint8_t)EXH_STATE_RUN;
    save = state == EXH_STATE_OFF;
    return save ? 0 : -EXH_E_STATE;
}

static void carry_out(void)
{
    const uint32_t asked = exh_regs_poll(&regs);
    const uint8_t wanted = exh_regs_command(asked);
    if (asked >> EXH_COIL_APPLY & 1u) { exh_regs_complete(&regs, apply()); }
    if (asked >> EXH_COIL_SAVE & 1u) { exh_regs_complete(&regs, may_save()); }
    if (wanted == EXH_CMD_NONE) { return; }
    command = wanted;
    exh_regs_complete(&regs, 0);
}

static uint32_t hear(void)
{
    const uint8_t *from;
    uint32_t n;
    if (stm_uart_damaged(STM_MODBUS)) { exh_modbus_rtu_discard(&line); }
    n = stm_uart_look(STM_MODBUS, &from);
    if (n > EXH_MODBUS_ADU_B) { n = EXH_MODBUS_ADU_B; }
    for (uint32_t i = 0; i < n; i++) { exh_modbus_rtu_receive(&line, from[i]); }
    stm_uart_skip(STM_MODBUS, n);
    return n;
}

void stm_modbus_poll(const struct exh_scene_in *in)
{
    int n;
    if (!open) { return; }
    if (exh_trace_reads(&trace)) { (void)exh_scene_signals(scene); }
    if (regs.trace) { exh_trace_step(&trace, scene->safety->tick, regs.signal); }
    if (stm_uart_busy(STM_MODBUS) || hear() > 0 ||
        !exh_modbus_rtu_poll(&line, tick_us * (1u + in->missed))) {
        return;
    }
    if (scene->safety) { exh_regs_update(&regs, scene->safety, in->drive.din); }
    regs.locked = scene->params->locked;
    (void)exh_scene_signals(scene); /* for a reader */
    n = exh_modbus_rtu_answer(&line, &regs, answer, sizeof answer);
    if (n > 0) { (void)stm_uart_send(STM_MODBUS, answer, (uint32_t)n); }
    carry_out();
}
