/* SPDX-License-Identifier: MIT */
#include "machine.h"

#include <elf.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#define WFE        0xBF20
#define WFI        0xBF30
#define XPSR_T     0x01000000u
#define STKERR     0x1000u
#define XPSR_IT    0x0600FC00u
#define RETURN     0xFFFFFFF0u /* and above: no address, but the way back from a handler */
#define ENTRY_TIME 12u         /* cycles, into a handler; 12 back */
#define STILL      1000u       /* passes of machine_run() in which nothing happens */
/* Exceptions as Unicorn numbers them; from INTERNAL on they are its own. */
enum { U_SVC = 2, U_XN = 3, U_BKPT = 7, U_RETURN = 8, U_INTERNAL = 0x10000 };

uint32_t machine_reg(const struct machine *m, int id)
{
    uint32_t v = 0;
    uc_reg_read(m->uc, id, &v);
    return v;
}

void machine_set_reg(struct machine *m, int id, uint32_t v) { uc_reg_write(m->uc, id, &v); }

uint8_t *machine_at(struct machine *m, uint32_t a, uint32_t n)
{
    if (a >= STM_FLASH && a - STM_FLASH <= STM_FLASH_B - n) { return &m->flash[a - STM_FLASH]; }
    if (a >= STM_RAM && a - STM_RAM <= STM_RAM_B - n) { return &m->ram[a - STM_RAM]; }
    if (a >= STM_CCM && a - STM_CCM <= STM_CCM_B - n) { return &m->ccm[a - STM_CCM]; }
    return NULL;
}

uint32_t machine_word(const struct machine *m, uint32_t a)
{
    union {
        const struct machine *c;
        struct machine *v;
    } u = {m};
    uint32_t w = 0;
    const uint8_t *at = machine_at(u.v, a, 4);
    if (at) { memcpy(&w, at, 4); }
    return w;
}

void machine_stop(struct machine *m, enum machine_end end)
{
    if (m->end == M_RUNS) { m->end = end; }
    uc_emu_stop(m->uc);
}

void machine_broke(struct machine *m, const char *format, ...)
{
    va_list args;
    if (m->end == M_BROKEN) { return; }
    va_start(args, format);
    vsnprintf(m->why, sizeof m->why, format, args);
    va_end(args);
    m->end = M_BROKEN;
    uc_emu_stop(m->uc);
}

static void spend(struct machine *m, struct spent t)
{
    if (m->runs) {
        if (m->runs->tick == 0) { m->cost.run[m->cost.runs++] = m->runs; }
        m->runs->spent += t.most;
        m->runs->tick += t.most;
    }
    m->cycles += t.most;
    m->least += t.least;
    m->part += t.most;
    m->s.now += (uint64_t)(m->part / m->speed) * m->s.clk.cycle;
    m->part %= m->speed;
}

static void spend_both(struct machine *m, uint32_t cycles)
{
    spend(m, (struct spent){cycles, cycles});
}

/* --- exceptions --- */

/* 0: the stack is no memory. Its pointer still moves. */
static int push(struct machine *m, unsigned e)
{
    static const int reg[7] = {UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3,
        UC_ARM_REG_R12, UC_ARM_REG_LR, UC_ARM_REG_PC};
    const uint32_t sp = machine_reg(m, UC_ARM_REG_SP), pad = sp >> 2 & 1;
    const uint32_t psr = machine_reg(m, UC_ARM_REG_XPSR), ipsr = psr & 0x1FF;
    const uint32_t at = sp - 32 - 4 * pad;
    uint32_t frame[8];
    uint8_t *to = machine_at(m, at, 32);
    for (unsigned i = 0; i < 7; i++) { frame[i] = machine_reg(m, reg[i]); }
    frame[7] = (psr & ~0x200u) | XPSR_T | pad << 9;
    if (to) { memcpy(to, frame, sizeof frame); }
    machine_set_reg(m, UC_ARM_REG_SP, at);
    machine_set_reg(m, UC_ARM_REG_LR, ipsr ? 0xFFFFFFF1u : 0xFFFFFFF9u);
    machine_set_reg(m, UC_ARM_REG_XPSR, (psr & 0xF8000000u) | XPSR_T | e);
    return to != NULL;
}

/* A handler runs although its frame found no memory (Cortex-M3 TRM 5.12.1); that of the hard fault,
 * where e may wait for it. */
static void enter(struct machine *m, unsigned e)
{
    if (!push(m, e)) {
        m->s.core.scb[10] |= STKERR;
        if (e > STM_HARDFAULT) {
            e = STM_HARDFAULT;
            machine_set_reg(m, UC_ARM_REG_XPSR, (machine_reg(m, UC_ARM_REG_XPSR) & ~0x1FFu) | e);
        }
    }
    const uint32_t vector =
        machine_word(m, (m->s.core.scb[2] ? m->s.core.scb[2] : STM_FLASH) + 4 * e);
    m->s.core.pending[e] = 0;
    m->s.core.active[e] = 1;
    m->s.core.event = 1;
    spend_both(m, ENTRY_TIME);
    m->entered++;
    m->s.wake = 0;
    machine_set_reg(m, UC_ARM_REG_PC, vector);
}

static void leave(struct machine *m)
{
    static const int reg[6] = {
        UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3, UC_ARM_REG_R12, UC_ARM_REG_LR};
    const unsigned e = machine_reg(m, UC_ARM_REG_XPSR) & 0x1FF;
    const uint32_t sp = machine_reg(m, UC_ARM_REG_SP);
    const uint8_t *from = machine_at(m, sp, 32);
    uint32_t frame[8];
    if (e == 0) { /* no handler runs: execution there is a fault */
        m->faulted = STM_MEMMANAGE;
        return;
    }
    if (from == NULL || e >= STM_EXCEPTIONS) {
        machine_broke(m, "back from exception %u: the stack is at 0x%x", e, (unsigned)sp);
        return;
    }
    memcpy(frame, from, sizeof frame);
    m->s.core.active[e] = 0;
    m->s.core.event = 1;
    spend_both(m, ENTRY_TIME);
    m->s.wake = 0;
    for (unsigned i = 0; i < 6; i++) { machine_set_reg(m, reg[i], frame[i]); }
    machine_set_reg(m, UC_ARM_REG_SP, sp + 32 + 4 * (frame[7] >> 9 & 1));
    machine_set_reg(m, UC_ARM_REG_XPSR, frame[7] & ~0x200u);
    machine_set_reg(m, UC_ARM_REG_PC, frame[6] | 1);
}

static unsigned wanted(const struct machine *m)
{
    return stm_wanted(&m->s, (int)(machine_reg(m, UC_ARM_REG_PRIMASK) & 1));
}

/* --- callbacks of the processor --- */

/* A store into flash is what the flash makes of it. */
static void finish_store(struct machine *m)
{
    if (m->store_size == 0) { return; }
    const uint32_t n = m->store_size;
    m->store_size = 0;
    stm_flash_store(&m->s, m->store_at, n, m->store_was, m->store_value);
}

static int on_flash_store(
    uc_engine *uc, uc_mem_type type, uint64_t a, int size, int64_t value, void *user)
{
    struct machine *m = user;
    (void)uc;
    (void)type;
    if (a < STM_FLASH || a - STM_FLASH > STM_FLASH_B - 4) { return 0; }
    finish_store(m);
    m->store_at = (uint32_t)a - STM_FLASH;
    m->store_size = (uint32_t)size;
    m->store_value = (uint32_t)value;
    memcpy(&m->store_was, &m->flash[m->store_at], 4);
    if (m->s.core.mpu[1] & 1) { m->faulted = STM_MEMMANAGE; } /* code is only read */
    return 1;
}

static void on_guard(
    uc_engine *uc, uc_mem_type type, uint64_t a, int size, int64_t value, void *user)
{
    struct machine *m = user;
    (void)type;
    (void)a;
    (void)size;
    (void)value;
    if (!(m->s.core.mpu[1] & 1) || m->faulted) { return; }
    m->faulted = STM_MEMMANAGE;
    uc_emu_stop(uc);
}

static uint64_t on_read(uc_engine *uc, uint64_t off, unsigned size, void *user)
{
    struct machine *m = user;
    const uint32_t base = off >= 0x20000000u ? 0xC0000000u : 0x40000000u; /* see machine_open() */
    (void)uc;
    finish_store(m);
    const uint32_t a = base + (uint32_t)off;
    spend_both(m, stm_wait_cycles(&m->s, a));
    if (m->s.now >= m->s.wake) { stm_go_on(&m->s); }
    return stm_read(&m->s, a, size);
}

static void on_write(uc_engine *uc, uint64_t off, unsigned size, uint64_t v, void *user)
{
    struct machine *m = user;
    const uint32_t base = off >= 0x20000000u ? 0xC0000000u : 0x40000000u;
    (void)uc;
    finish_store(m);
    const uint32_t a = base + (uint32_t)off;
    spend_both(m, stm_wait_cycles(&m->s, a) / 2); /* a buffer takes it */
    if (m->s.now >= m->s.wake) { stm_go_on(&m->s); }
    stm_write(&m->s, a, size, (uint32_t)v);
    m->s.wake = 0;
}

static uint64_t on_core_read(uc_engine *uc, uint64_t off, unsigned size, void *user)
{
    return on_read(uc, off + 0x20000000u, size, user);
}
static void on_core_write(uc_engine *uc, uint64_t off, unsigned size, uint64_t v, void *user)
{
    on_write(uc, off + 0x20000000u, size, v, user);
}

/* 1: the run pauses here, before the block. */
static int go_on(struct machine *m)
{
    finish_store(m);
    if (m->s.now < m->s.flash.busy_until) { m->s.now = m->s.flash.busy_until; } /* code waits */
    stm_go_on(&m->s);
    if (m->s.resets) {
        machine_stop(m, M_RESET);
        return 1;
    }
    if (m->stop_at && m->s.now >= m->stop_at) {
        machine_stop(m, M_DONE);
        return 1;
    }
    if (m->stop_at && m->stop_at < m->s.wake) { m->s.wake = m->stop_at; }
    if (wanted(m)) {
        uc_emu_stop(m->uc);
        return 1;
    }
    return 0;
}

/* Constants and what code keeps beside itself. This hook makes Unicorn set the bits of an IT block
 * from which a load comes, and nothing would clear them behind it. */
static void on_constant(
    uc_engine *uc, uc_mem_type type, uint64_t a, int size, int64_t value, void *user)
{
    struct machine *m = user;
    const uint32_t psr = machine_reg(m, UC_ARM_REG_XPSR);
    struct spent t = {0, 0};
    (void)uc;
    (void)type;
    (void)size;
    (void)value;
    if (psr & XPSR_IT) { machine_set_reg(m, UC_ARM_REG_XPSR, psr & ~XPSR_IT); }
    if (m->aside || !m->runs) { return; }
    t.most = cost_of_data(&m->cost, (uint32_t)a - STM_FLASH, m->s.flash.acr & 7);
    spend(m, t);
}

static void on_block(uc_engine *uc, uint64_t address, uint32_t size, void *user)
{
    struct machine *m = user;
    const uint32_t at = (uint32_t)address & ~1u, off = at - STM_FLASH;
    if (m->aside) {
        if (at == m->aside) { uc_emu_stop(uc); }
        return;
    }
    if (off >= STM_FLASH_B) {
        if (at < RETURN) { machine_broke(m, "control went to 0x%x", (unsigned)at); }
        return;
    }
    if (m->faulted || ((m->s.now >= m->s.wake || m->store_size) && go_on(m))) {
        if (m->faulted) { uc_emu_stop(uc); }
        return;
    }
    if (m->watched[off / 16] >> (off / 2 % 8) & 1) {
        for (unsigned i = 0; i < m->watches; i++) {
            if (m->watch[i].at == at) { m->watch[i].fn(m); }
        }
        if (m->end != M_RUNS || m->faulted || m->call) { return; }
    }
    m->runs = &m->cost.block[off / 2];
    spend(m, cost_of(&m->cost, m->flash, off, size, m->s.flash.acr & 7));
    m->insns += m->runs->insns;
}

static void on_interrupt(uc_engine *uc, uint32_t n, void *user)
{
    struct machine *m = user;
    if (n == U_BKPT) {
        machine_broke(m, "a breakpoint at 0x%x", (unsigned)machine_reg(m, UC_ARM_REG_PC));
    } else if (n == U_SVC) {
        stm_pend(&m->s, STM_SVCALL);
    } else if (n < U_INTERNAL && n != U_RETURN) {
        m->faulted = n == U_XN ? STM_MEMMANAGE : STM_USAGEFAULT;
    }
    uc_emu_stop(uc);
}

/* --- running --- */

static int code_before(const struct machine *m, uint32_t pc)
{
    const uint32_t off = pc - STM_FLASH - 2;
    return off < STM_FLASH_B ? m->flash[off] | m->flash[off + 1] << 8 : 0;
}

/* Until an exception is taken or, of WFE, an event was. */
static void wait_for(struct machine *m, int event)
{
    if (event && m->s.core.event) {
        m->s.core.event = 0;
        return;
    }
    while (m->end == M_RUNS) {
        uint64_t next = stm_next(&m->s);
        if (m->s.resets) { m->end = M_RESET; }
        if (wanted(m) || (!event && stm_wakes(&m->s)) || m->end != M_RUNS) { return; }
        if (m->stop_at && m->stop_at < next) { next = m->stop_at; }
        if (next == STM_NEVER) {
            m->end = M_HUNG;
            return;
        }
        if (next > m->s.now) {
            m->slept += next - m->s.now;
            m->s.now = next;
        }
        if (m->stop_at && m->s.now >= m->stop_at) { m->end = M_DONE; }
        stm_go_on(&m->s);
    }
}

/* No handler may take this fault, because a running one has a higher priority. The processor stops
 * until a reset or, in a hard fault, NMI. */
static void lock_up(struct machine *m, unsigned cause)
{
    snprintf(m->why, sizeof m->why, "locked up: exception %u in a handler, at 0x%x", cause,
        (unsigned)machine_reg(m, UC_ARM_REG_PC));
    m->s.core.event = 0;
    wait_for(m, 1);
}

static void escalate(struct machine *m)
{
    static const uint32_t status[] = {
        [STM_MEMMANAGE] = 1u, [STM_BUSFAULT] = 1u << 8, [STM_USAGEFAULT] = 1u << 16};
    struct stm_core *c = &m->s.core;
    const unsigned cause = m->faulted;
    m->faulted = 0;
    c->scb[10] |= status[cause]; /* CFSR */
    if (c->active[STM_HARDFAULT] || c->active[STM_NMI]) {
        lock_up(m, cause);
    } else {
        enter(m, c->scb[9] >> (cause + 12) & 1 && !c->active[cause] ? cause : STM_HARDFAULT);
    }
}

/* What Unicorn ends a run with. Memory is not to hold code, though on the chip it could. */
static void take_error(struct machine *m, uc_err err, uint32_t pc)
{
    const int read = err == UC_ERR_READ_UNMAPPED, write = err == UC_ERR_WRITE_UNMAPPED;
    const int bus = read || write || err == UC_ERR_FETCH_UNMAPPED;
    m->faulted = bus ? STM_BUSFAULT : STM_USAGEFAULT;
    if (err == UC_ERR_FETCH_PROT) { machine_broke(m, "control went to 0x%x", (unsigned)pc); }
}

/* A function () of the image, at no cost and in no time; all registers are as they were. */
static void call_aside(struct machine *m)
{
    const uint32_t back = machine_reg(m, UC_ARM_REG_PC), fn = m->call;
    uc_context *was;
    m->call = 0;
    if (uc_context_alloc(m->uc, &was) != UC_ERR_OK) {
        machine_broke(m, "out of memory");
        return;
    }
    uc_context_save(m->uc, was);
    machine_set_reg(m, UC_ARM_REG_SP, (machine_reg(m, UC_ARM_REG_SP) & ~7u) - 64);
    machine_set_reg(m, UC_ARM_REG_LR, back | 1);
    m->aside = back & ~1u;
    const uc_err err = uc_emu_start(m->uc, fn | 1, UINT64_MAX, 0, 0);
    const uint32_t pc = machine_reg(m, UC_ARM_REG_PC);
    if (err != UC_ERR_OK || (pc & ~1u) != (back & ~1u)) {
        machine_broke(m, "a call of 0x%x did not return: %s at 0x%x", (unsigned)fn,
            uc_strerror(err), (unsigned)pc);
    }
    m->aside = 0;
    uc_context_restore(m->uc, was);
    uc_context_free(was);
}

void machine_call(struct machine *m, uint32_t fn)
{
    m->call = fn;
    uc_emu_stop(m->uc);
}

/* What ended a stretch of code. An error behind WFE is Unicorn's way to wait; what an interrupt
 * goes before comes again. */
static void take(struct machine *m, uc_err err, uint32_t pc)
{
    const int before = code_before(m, pc);
    unsigned e = 0;
    if (m->call) {
        call_aside(m);
    } else if (!m->faulted && pc >= RETURN) {
        leave(m);
    } else if (!m->faulted && (e = wanted(m)) == 0) {
        if (before == WFE || before == WFI) {
            wait_for(m, before == WFE);
            e = wanted(m);
        } else if (err != UC_ERR_OK) {
            take_error(m, err, pc);
        }
    }
    if (m->end != M_RUNS) { return; }
    if (m->faulted) {
        escalate(m);
    } else if (e) {
        enter(m, e);
    }
}

enum machine_end machine_run(struct machine *m)
{
    unsigned still = 0;
    m->end = M_RUNS;
    while (m->end == M_RUNS) {
        const uint64_t was = m->s.now, insns = m->insns;
        const uint32_t from = machine_reg(m, UC_ARM_REG_PC) | 1;
        const uc_err err = uc_emu_start(m->uc, from, UINT64_MAX, 0, 0);
        const uint32_t pc = machine_reg(m, UC_ARM_REG_PC);
        finish_store(m);
        if (m->end != M_RUNS) { break; }
        take(m, err, pc);
        still = m->s.now != was || m->insns != insns ? 0 : still + 1;
        if (still == STILL) { machine_broke(m, "it stands still at 0x%x", (unsigned)pc); }
    }
    return m->end;
}

void machine_watch(struct machine *m, uint32_t address, machine_watch_fn *fn)
{
    const uint32_t off = (address & ~1u) - STM_FLASH;
    if (address == 0 || off >= STM_FLASH_B || m->watches == WATCHES) {
        machine_broke(m, "0x%x: cannot be watched", (unsigned)address);
        return;
    }
    m->watch[m->watches].at = address & ~1u;
    m->watch[m->watches++].fn = fn;
    m->watched[off / 16] = (uint8_t)(m->watched[off / 16] | 1u << (off / 2 % 8));
}

void machine_boot(struct machine *m)
{
    m->faulted = 0;
    machine_set_reg(m, UC_ARM_REG_XPSR, XPSR_T);
    machine_set_reg(m, UC_ARM_REG_PRIMASK, 0);
    machine_set_reg(m, UC_ARM_REG_SP, machine_word(m, STM_FLASH));
    machine_set_reg(m, UC_ARM_REG_LR, UINT32_MAX);
    machine_set_reg(m, UC_ARM_REG_PC, machine_word(m, STM_FLASH + 4));
}

/* --- opening --- */

static void *hook_of(void (*fn)(void))
{
    void *p;
    memcpy(&p, &fn, sizeof p);
    return p;
}
#define HOOK(fn) hook_of((void (*)(void))(fn))

static int open_processor(struct machine *m)
{
    uc_hook hook;
    uc_err err = uc_open(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS, &m->uc);
    if (err == UC_ERR_OK) { err = uc_ctl_set_cpu_model(m->uc, UC_CPU_ARM_CORTEX_M4); }
    if (err == UC_ERR_OK) {
        err = uc_mem_map_ptr(m->uc, STM_FLASH, STM_FLASH_B, UC_PROT_READ | UC_PROT_EXEC, m->flash);
    }
    if (err == UC_ERR_OK) {
        err = uc_mem_map_ptr(m->uc, STM_RAM, STM_RAM_B, UC_PROT_READ | UC_PROT_WRITE, m->ram);
    }
    if (err == UC_ERR_OK) {
        err = uc_mem_map_ptr(m->uc, STM_CCM, STM_CCM_B, UC_PROT_READ | UC_PROT_WRITE, m->ccm);
    }
    if (err == UC_ERR_OK) {
        err = uc_mmio_map(m->uc, 0x40000000, 0x00080000, on_read, m, on_write, m);
    }
    if (err == UC_ERR_OK) {
        err = uc_mmio_map(m->uc, 0xE0000000, 0x00100000, on_core_read, m, on_core_write, m);
    }
    if (err == UC_ERR_OK) {
        err = uc_hook_add(m->uc, &hook, UC_HOOK_BLOCK, HOOK(on_block), m, 1, 0);
    }
    if (err == UC_ERR_OK) {
        err = uc_hook_add(m->uc, &hook, UC_HOOK_INTR, HOOK(on_interrupt), m, 1, 0);
    }
    if (err == UC_ERR_OK) {
        err = uc_hook_add(m->uc, &hook, UC_HOOK_MEM_WRITE_PROT, HOOK(on_flash_store), m, 1, 0);
    }
    if (err == UC_ERR_OK) {
        err = uc_hook_add(m->uc, &hook, UC_HOOK_MEM_READ, HOOK(on_constant), m, STM_FLASH,
            STM_FLASH + STM_FLASH_B - 1);
    }
    if (err == UC_ERR_OK && m->guarded) {
        err =
            uc_hook_add(m->uc, &hook, UC_HOOK_MEM_WRITE, HOOK(on_guard), m, STM_RAM, STM_RAM + 255);
    }
    if (err != UC_ERR_OK) { fprintf(stderr, "stm32f405: unicorn: %s\n", uc_strerror(err)); }
    return err == UC_ERR_OK ? 0 : -1;
}

static uint8_t *place(void *ctx, uint32_t at, uint32_t n) { return machine_at(ctx, at, n); }

int machine_open(struct machine *m, const char *image)
{
    void *flash = NULL, *ram = NULL, *ccm = NULL;
    uint32_t entry;
    if (posix_memalign(&flash, 4096, STM_FLASH_B) || posix_memalign(&ram, 4096, STM_RAM_B) ||
        posix_memalign(&ccm, 4096, STM_CCM_B)) {
        return -1;
    }
    m->flash = flash;
    m->ram = ram;
    m->ccm = ccm;
    m->cost.block = calloc(BLOCKS, sizeof *m->cost.block);
    cost_open(&m->cost);
    if (m->speed == 0) { m->speed = 1; }
    memset(m->flash, 0xFF, STM_FLASH_B);
    memset(m->ram, 0xA5, STM_RAM_B); /* memory is not cleared for an image */
    memset(m->ccm, 0xA5, STM_CCM_B);
    if (image && image_load(image, EM_ARM, place, m, &entry) < 0) {
        fprintf(stderr, "stm32f405: %s: not an Arm image that fits\n", image);
        return -1;
    }
    stm_outside.flash = m->flash;
    stm_outside.ram = m->ram;
    stm_outside.ccm = m->ccm;
    return open_processor(m);
}

void machine_close(struct machine *m)
{
    if (m->uc) { uc_close(m->uc); }
    free(m->flash);
    free(m->ram);
    free(m->ccm);
    free(m->cost.block);
}
