/* SPDX-License-Identifier: MIT */
/* What answers at which port. */
#include "hil.h"

#include "box.h"

enum { EXIT_PORT = 0xF4, POST_PORT = 0x80, PCI_ADDRESS = 0xCF8, PCI_DATA = 0xCFC, LOG_PORT = 0xE9 };

static void send_line(struct hil *h)
{
    h->text[h->text_n] = 0;
    if (h->line) { h->line(h, h->text); }
    h->text_n = 0;
}

static void take_character(struct hil *h, int c)
{
    if (c == '\n') {
        send_line(h);
    } else if (c != '\r' && h->text_n + 1 < sizeof h->text) {
        h->text[h->text_n++] = (char)c;
    }
}

static void charge(struct hil *h)
{
    h->ports++;
    h->now_ps += h->cost.port_ps;
    /* a chip's doing in the meantime is seen at the next block, or by the chip itself */
    if (h->now_ps >= h->wake_ps) { h->wake_ps = 0; }
}

static uint32_t on_in(uc_engine *uc, uint32_t port, int size, void *user)
{
    struct hil *h = user;
    uint32_t value = size == 4 ? UINT32_MAX : (1u << 8 * size) - 1; /* no card drives the bus */
    uint8_t byte;
    (void)uc;
    if (h->box && box_in(h->box, h, (uint16_t)port, (unsigned)size, &value)) { return value; }
    charge(h);
    if (size == 1 && chips_in8(&h->chips, h->now_ps, (uint16_t)port, &byte)) { return byte; }
    return value;
}

static void on_out(uc_engine *uc, uint32_t port, int size, uint32_t value, void *user)
{
    struct hil *h = user;
    int sent = -1;
    if (h->box && box_out(h->box, h, (uint16_t)port, (unsigned)size, value)) { return; }
    if (port == LOG_PORT) { /* no bus: an emulator's own */
        if (h->records) { fputc((int)(value & 0xFF), h->records); }
        return;
    }
    charge(h);
    if (port == EXIT_PORT) {
        if (h->end == HIL_RUNS) {
            h->end = HIL_EXIT;
            h->status = value;
        }
        uc_emu_stop(uc);
    } else if (size == 1) {
        const uint64_t loads = chips_timer_loads(&h->chips);
        (void)chips_out8(&h->chips, h->now_ps, (uint16_t)port, (uint8_t)value, &sent);
        h->wake_ps = 0;
        if (chips_timer_loads(&h->chips) != loads && h->set) { h->set(h); }
        if (sent >= 0) { take_character(h, sent); }
    }
}

int hil_ports_open(struct hil *h)
{
    /* hooks are stored as objects in Unicorn's interface */
    union {
        uint32_t (*in)(uc_engine *, uint32_t, int, void *);
        void (*out)(uc_engine *, uint32_t, int, uint32_t, void *);
        void *hook;
    } in = {.in = on_in}, out = {.out = on_out};
    uc_hook hook;
    if (uc_hook_add(h->uc, &hook, UC_HOOK_INSN, in.hook, h, 1, 0, UC_X86_INS_IN) != UC_ERR_OK) {
        return -1;
    }
    return uc_hook_add(h->uc, &hook, UC_HOOK_INSN, out.hook, h, 1, 0, UC_X86_INS_OUT) == UC_ERR_OK
               ? 0
               : -1;
}
