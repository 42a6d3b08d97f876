/* SPDX-License-Identifier: MIT */
#include "hil.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#define INFO_AT    0x9000u /* what a multiboot loader leaves */
#define COMMAND_AT 0x9100u
#define HPET_AT    0xFED00000u
#define HPET_B     0x1000u
#define FLAG_IF    0x200u
#define WATCHED    0x8000u
#define HLT        0xF4
#define STI        0xFB

const struct hil_cost hil_cost_default = {1250, 62500, 1000000, 250000};

uint32_t hil_reg(const struct hil *h, int id)
{
    uint32_t v = 0;
    uc_reg_read(h->uc, id, &v);
    return v;
}

static void set_reg(struct hil *h, int id, uint32_t v) { uc_reg_write(h->uc, id, &v); }

uint32_t hil_word(const struct hil *h, uint32_t address)
{
    uint32_t v = 0;
    if (address <= HIL_RAM_B - sizeof v) { memcpy(&v, &h->ram[address], sizeof v); }
    return v;
}

void hil_broke(struct hil *h, const char *format, ...)
{
    va_list args;
    if (h->end == HIL_BROKEN) { return; }
    h->end = HIL_BROKEN;
    va_start(args, format);
    vsnprintf(h->why, sizeof h->why, format, args);
    va_end(args);
    uc_emu_stop(h->uc);
}

/* --- time and interrupts --- */

static void chips_go_on(struct hil *h)
{
    if (chips_advance(&h->chips, h->now_ps) && h->tick) { h->tick(h); }
    h->wake_ps = pic_wants(&h->chips) ? 0 : chips_next_ps(&h->chips);
}

/* As the processor does it: flags, segment and place onto the stack, interrupts off. */
static void enter_interrupt(struct hil *h)
{
    uc_x86_mmr idt;
    const uint32_t flags = hil_reg(h, UC_X86_REG_EFLAGS);
    const uint32_t frame[3] = {hil_reg(h, UC_X86_REG_EIP), hil_reg(h, UC_X86_REG_CS), flags};
    const uint32_t sp = hil_reg(h, UC_X86_REG_ESP) - (uint32_t)sizeof frame;
    const uint32_t vector = (uint32_t)pic_accept(&h->chips);

    uc_reg_read(h->uc, UC_X86_REG_IDTR, &idt);
    const uint32_t gate = (uint32_t)idt.base + 8 * vector;
    if (8 * vector + 7 > idt.limit || gate > HIL_RAM_B - 8 || sp > HIL_RAM_B - sizeof frame) {
        hil_broke(h, "interrupt vector %u: no gate or no stack", (unsigned)vector);
        return;
    }
    memcpy(&h->ram[sp], frame, sizeof frame);
    set_reg(h, UC_X86_REG_ESP, sp);
    set_reg(h, UC_X86_REG_EFLAGS, flags & ~FLAG_IF);
    set_reg(h, UC_X86_REG_EIP, (hil_word(h, gate) & 0xFFFF) | (hil_word(h, gate + 4) & 0xFFFF0000));
    h->now_ps += h->cost.entry_ps;
    h->irqs++;
    h->late += h->waited && !h->idle;
    h->idle = 0;
    h->last_end = 0;
    chips_go_on(h);
}

static int may_interrupt(const struct hil *h)
{
    return pic_wants(&h->chips) && hil_reg(h, UC_X86_REG_EFLAGS) & FLAG_IF;
}

/* --- callbacks of the processor --- */

/* Instructions of the block here. Asked of Unicorn once: the code does not change. */
static unsigned learn_block(struct hil *h, uint32_t address)
{
    uc_tb tb;
    const unsigned watched = h->block[address] & WATCHED;
    memset(&tb, 0, sizeof tb);
    if (uc_ctl_request_cache(h->uc, address, &tb) != UC_ERR_OK || tb.icount == 0) {
        hil_broke(h, "block at 0x%lx: its instructions cannot be counted", (unsigned long)address);
        return 1;
    }
    h->block[address] = (uint16_t)(tb.icount | watched);
    return tb.icount;
}

static void call_watch(struct hil *h, uint32_t address)
{
    for (unsigned i = 0; i < h->watches; i++) {
        if (h->watch[i].address == address) { h->watch[i].fn(h, address); }
    }
}

/* Before each block. STI lets one more instruction run before any interrupt goes in. */
static void on_block(uc_engine *uc, uint64_t address, uint32_t size, void *user)
{
    struct hil *h = user;
    const uint32_t at = (uint32_t)address;
    const int shadow = h->last_end == at && at > 0 && at < HIL_RAM_B && h->ram[at - 1] == STI;
    unsigned n;

    if (h->aside) {
        if (at == h->aside) { uc_emu_stop(uc); }
        return;
    }
    if (at >= HIL_RAM_B) {
        hil_broke(h, "control went to 0x%lx", (unsigned long)at);
        return;
    }
    if (h->now_ps >= h->wake_ps) {
        chips_go_on(h);
        if (!shadow && may_interrupt(h)) {
            h->wants_stop = 1;
            uc_emu_stop(uc);
            return;
        }
    }
    n = h->block[at];
    if (n & WATCHED) {
        call_watch(h, at);
        n &= WATCHED - 1;
        if (h->end != HIL_RUNS || h->returns || h->call) { return; }
    }
    if (n == 0) { n = learn_block(h, at); }
    if (h->block_fn) { h->block_fn(at, n); }
    h->insns += n;
    h->now_ps += (uint64_t)n * h->cost.insn_ps;
    h->last_end = at + size;
    if (h->max_insns && h->insns > h->max_insns) {
        h->end = HIL_HUNG;
        uc_emu_stop(uc);
    }
}

/* Before each instruction, to check the counts of blocks. */
static void on_instruction(uc_engine *uc, uint64_t address, uint32_t size, void *user)
{
    struct hil *h = user;
    (void)uc;
    (void)address;
    (void)size;
    h->singly += !h->aside;
}

static int on_rdtsc(uc_engine *uc, void *user)
{
    struct hil *h = user;
    const uint64_t cycles = h->now_ps * 2 / h->cost.insn_ps;
    const uint32_t low = (uint32_t)cycles, high = (uint32_t)(cycles >> 32);
    uc_reg_write(uc, UC_X86_REG_EAX, &low);
    uc_reg_write(uc, UC_X86_REG_EDX, &high);
    return 1; /* done: the host's clock stays out of it */
}

static void on_exception(uc_engine *uc, uint32_t vector, void *user)
{
    struct hil *h = user;
    (void)uc;
    hil_broke(h, "processor exception, vector %u, at 0x%lx", (unsigned)vector,
        (unsigned long)hil_reg(h, UC_X86_REG_EIP));
}

static uint64_t on_hpet_read(uc_engine *uc, uint64_t offset, unsigned size, void *user)
{
    struct hil *h = user;
    (void)uc;
    (void)size;
    h->hpets++;
    h->now_ps += h->cost.hpet_ps;
    return hpet_read(&h->chips, h->now_ps, (uint32_t)offset);
}

static void on_hpet_write(uc_engine *uc, uint64_t offset, unsigned size, uint64_t value, void *user)
{
    struct hil *h = user;
    (void)uc;
    (void)size;
    h->hpets++;
    h->now_ps += h->cost.hpet_ps;
    hpet_write(&h->chips, h->now_ps, (uint32_t)offset, (uint32_t)value);
    h->wake_ps = 0; /* whatever it was */
    if (h->set) { h->set(h); }
}

/* --- running --- */

void hil_return(struct hil *h, uint32_t value)
{
    h->returns = 1;
    h->returned = value;
    uc_emu_stop(h->uc);
}

void hil_call(struct hil *h, uint32_t fn)
{
    h->call = fn;
    uc_emu_stop(h->uc);
}

/* Below whatever the stack may hold, and back with all registers as they were. */
static void call_aside(struct hil *h)
{
    const uint32_t back = hil_reg(h, UC_X86_REG_EIP), fn = h->call;
    const uint32_t sp = (hil_reg(h, UC_X86_REG_ESP) & ~15u) - 132;
    uc_context *was;
    h->call = 0;
    if (sp > HIL_RAM_B - sizeof back || uc_context_alloc(h->uc, &was) != UC_ERR_OK) {
        hil_broke(h, "a call of 0x%lx: no stack or no memory", (unsigned long)fn);
        return;
    }
    uc_context_save(h->uc, was);
    memcpy(&h->ram[sp], &back, sizeof back);
    set_reg(h, UC_X86_REG_ESP, sp);
    h->aside = back;
    if (uc_emu_start(h->uc, fn, UINT64_MAX, 0, 0) != UC_ERR_OK ||
        hil_reg(h, UC_X86_REG_ESP) != sp + sizeof back) {
        hil_broke(h, "a call of 0x%lx did not return", (unsigned long)fn);
    }
    h->aside = 0;
    uc_context_restore(h->uc, was);
    uc_context_free(was);
}

/* A function was done for the image: back to who called it. */
static void go_back(struct hil *h)
{
    const uint32_t sp = hil_reg(h, UC_X86_REG_ESP);
    h->returns = 0;
    h->last_end = 0;
    set_reg(h, UC_X86_REG_EAX, h->returned);
    set_reg(h, UC_X86_REG_EIP, hil_word(h, sp));
    set_reg(h, UC_X86_REG_ESP, sp + 4);
}

/* The image waits: on to whatever ends that. */
static void wait_for_interrupt(struct hil *h)
{
    if (h->wait) { h->wait(h); }
    h->idle = h->waited = 1;
    while (h->end == HIL_RUNS && !may_interrupt(h)) {
        const uint64_t next_ps = chips_next_ps(&h->chips);
        if (!(hil_reg(h, UC_X86_REG_EFLAGS) & FLAG_IF) || next_ps == CHIP_NEVER) {
            h->end = HIL_HUNG;
            return;
        }
        h->now_ps = next_ps > h->now_ps ? next_ps : h->now_ps;
        chips_go_on(h);
    }
}

enum hil_end hil_run(struct hil *h)
{
    h->end = HIL_RUNS;
    while (h->end == HIL_RUNS) {
        const uc_err err = uc_emu_start(h->uc, hil_reg(h, UC_X86_REG_EIP), UINT64_MAX, 0, 0);
        if (h->end != HIL_RUNS) { break; }
        const uint32_t at = hil_reg(h, UC_X86_REG_EIP);
        if (err != UC_ERR_OK) {
            hil_broke(h, "%s at 0x%lx", uc_strerror(err), (unsigned long)at);
        } else if (h->returns) {
            go_back(h);
        } else if (h->call) {
            call_aside(h);
        } else if (h->wants_stop) {
            h->wants_stop = 0;
            enter_interrupt(h);
        } else if (at > 0 && at < HIL_RAM_B && h->ram[at - 1] == HLT) {
            wait_for_interrupt(h);
            if (h->end == HIL_RUNS) { enter_interrupt(h); }
        } else {
            hil_broke(h, "the processor stood still at 0x%lx", (unsigned long)at);
        }
    }
    return h->end;
}

void hil_watch_at(struct hil *h, uint32_t address, hil_watch_fn *fn)
{
    for (unsigned i = 0; i < h->watches; i++) {
        if (h->watch[i].address == address && h->watch[i].fn == fn) { return; }
    }
    if (h->watches == HIL_WATCHES || address >= HIL_RAM_B) {
        hil_broke(h, "0x%lx: cannot be watched", (unsigned long)address);
        return;
    }
    h->watch[h->watches++] = (struct hil_watch){address, fn};
    h->block[address] |= WATCHED;
}

/* --- opening --- */

/* Hooks are stored as objects in Unicorn's interface. */
static void *hook_of(void (*fn)(void))
{
    void *p;
    memcpy(&p, &fn, sizeof p);
    return p;
}
#define HOOK(fn) hook_of((void (*)(void))(fn))

static int open_processor(struct hil *h)
{
    uc_hook hook;
    uc_err err = uc_open(UC_ARCH_X86, UC_MODE_32, &h->uc);
    if (err == UC_ERR_OK) { err = uc_mem_map_ptr(h->uc, 0, HIL_RAM_B, UC_PROT_ALL, h->ram); }
    if (err == UC_ERR_OK) {
        err = uc_mmio_map(h->uc, HPET_AT, HPET_B, on_hpet_read, h, on_hpet_write, h);
    }
    if (err == UC_ERR_OK) {
        err = uc_hook_add(h->uc, &hook, UC_HOOK_BLOCK, HOOK(on_block), h, 1, 0);
    }
    if (err == UC_ERR_OK) {
        err = uc_hook_add(h->uc, &hook, UC_HOOK_INTR, HOOK(on_exception), h, 1, 0);
    }
    if (err == UC_ERR_OK) {
        err = uc_hook_add(h->uc, &hook, UC_HOOK_INSN, HOOK(on_rdtsc), h, 1, 0, UC_X86_INS_RDTSC);
    }
    if (err == UC_ERR_OK && h->count_singly) {
        err = uc_hook_add(h->uc, &hook, UC_HOOK_CODE, HOOK(on_instruction), h, 1, 0);
    }
    if (err == UC_ERR_OK && hil_ports_open(h) < 0) { err = UC_ERR_HOOK; }
    if (err != UC_ERR_OK) { fprintf(stderr, "hil: unicorn: %s\n", uc_strerror(err)); }
    return err == UC_ERR_OK ? 0 : -1;
}

/* What a multiboot loader leaves: flags 4: there is a command line. */
void hil_command(struct hil *h, const char *image, const char *options)
{
    const uint32_t info[5] = {4, 640, HIL_RAM_B / 1024 - 1024, 0, COMMAND_AT};
    memcpy(&h->ram[INFO_AT], info, sizeof info);
    snprintf((char *)&h->ram[COMMAND_AT], HIL_COMMAND_B, "%s %s", image, options);
    set_reg(h, UC_X86_REG_EAX, 0x2BADB002u);
    set_reg(h, UC_X86_REG_EBX, INFO_AT);
    set_reg(h, UC_X86_REG_EIP, h->entry);
}

int hil_open(struct hil *h, const char *image)
{
    void *ram = NULL;
    const int none = posix_memalign(&ram, 4096, HIL_RAM_B);
    h->ram = ram;
    h->block = calloc(HIL_RAM_B, sizeof *h->block);
    if (none || h->block == NULL) {
        fprintf(stderr, "hil: out of memory\n");
        return -1;
    }
    memset(h->ram, 0xA5, HIL_RAM_B); /* memory is not cleared for an image */
    return hil_load(h, image) < 0 || open_processor(h) < 0 ? -1 : 0;
}

void hil_close(struct hil *h)
{
    if (h->uc) { uc_close(h->uc); }
    free(h->ram);
    free(h->block);
    h->uc = NULL;
    h->ram = NULL;
    h->block = NULL;
}
