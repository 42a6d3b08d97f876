/* SPDX-License-Identifier: MIT */
/* Rings of descriptors in memory, legacy format. The descriptor states its owner, so a tick reads
 * no register of the card (a microsecond each). It writes one for all received frames and one per
 * sent frame. */
#include "nic.h"

#include "pc104.h"
#include "pci.h"

#include "cards/wait.h"

#include "exhand/error.h"

#define CARD_ID     0x10D38086u
#define CLASS_NET   0x020000u /* Ethernet, in bits 31..8 */
#define IN          64u       /* descriptors: multiples of 8 */
#define OUT         64u
#define BUFFER_B    2048u /* as RCTL says */
#define FRAME_OUT_B 1536u
#define CRC_REMOVED (1u << 26)

/* registers */
enum {
    CTRL = 0x0000,
    STATUS = 0x0008,
    EECD = 0x0010,
    ICR = 0x00C0,
    IMC = 0x00D8,
    RCTL = 0x0100,
    TCTL = 0x0400,
    TIPG = 0x0410,
    EXTCNF_CTRL = 0x0F00,
    RDBAL = 0x2800,
    RDBAH = 0x2804,
    RDLEN = 0x2808,
    RDH = 0x2810,
    RDT = 0x2818,
    TDBAL = 0x3800,
    TDBAH = 0x3804,
    TDLEN = 0x3808,
    TDH = 0x3810,
    TDT = 0x3818,
    TXDCTL = 0x3828,
    CRCERRS = 0x4000,
    MPC = 0x4010,
    RXCSUM = 0x5000,
    RFCTL = 0x5008,
    MTA = 0x5200,
    RAL0 = 0x5400,
    RAH0 = 0x5404
};
#define CTRL_NO_MASTER   (1u << 2)
#define CTRL_LINK_UP     (1u << 6)
#define CTRL_FORCE       (3u << 11) /* speed, duplex: leave both to the negotiation */
#define CTRL_RESET       (1u << 26)
#define STATUS_UP        (1u << 1)
#define STATUS_MASTER    (1u << 19)
#define EECD_READ        (1u << 9) /* its memory has been read */
#define MDIO_OURS        (1u << 5)
#define RCTL_ON          (1u << 1)
#define RCTL_BROADCAST   (1u << 15)
#define RFCTL_EXTENDED   (1u << 15)
#define RAH_VALID        (1u << 31)
#define TXDCTL_WRITEBACK 0x01410000u /* every descriptor as soon as it is done */
#define TIPG_COPPER      (8u | 8u << 10 | 6u << 20)
#define TCTL_ON          (1u << 1 | 1u << 3 | 0xFu << 4 | 0x3Fu << 12 | 1u << 24)

#define COMMAND_MEMORY 0x2u
#define COMMAND_MASTER 0x4u
#define COMMAND_NO_IRQ 0x400u
#define CAP_POWER      0x01u
#define CAP_EXPRESS    0x10u

struct in {
    uint32_t at, at_high;
    uint16_t length_B, sum;
    uint8_t status, errors;
    uint16_t special;
};
#define IN_DONE 1u
#define IN_END  2u
#define IN_BAD  0x97u /* on the wire; our code checks the sums inside */

struct out {
    uint32_t at, at_high;
    uint16_t length_B;
    uint8_t sum_at, command, status, sum_from;
    uint16_t special;
};
#define OUT_DONE 1u
#define OUT_SEND 0xBu /* end of packet; append a CRC; report when done */

static volatile struct in in_ring[IN] __attribute__((aligned(128)));
static volatile struct out out_ring[OUT] __attribute__((aligned(128)));
static uint8_t in_buffer[IN][BUFFER_B] __attribute__((aligned(16)));
static uint8_t out_buffer[OUT][FRAME_OUT_B] __attribute__((aligned(16)));
static struct pc104_pci place;
static uint32_t base;                   /* 0: no card */
static unsigned in_at, in_back, out_at; /* in_back: the first that is not the card's again */
static uint8_t torn;                    /* the rest of a frame in pieces is to come */
static struct pc104_nic_counts counts;

static uint32_t get(unsigned reg) { return *(volatile uint32_t *)(base + reg); }

static void put(unsigned reg, uint32_t value) { *(volatile uint32_t *)(base + reg) = value; }

/* Until (reg & mask) == want: 1, or 0 after so long. */
static int becomes(unsigned reg, uint32_t mask, uint32_t want, uint32_t us)
{
    struct exh_wait w = exh_wait_us(us);
    do {
        if ((get(reg) & mask) == want) { return 1; }
    } while (exh_wait_more(&w));
    return 0;
}

static void pause_us(uint32_t us)
{
    struct exh_wait w = exh_wait_us(us);
    while (exh_wait_more(&w)) {}
}

/* --- finding it --- */

static void say_place(struct pc104_pci at)
{
    pc104_say(" at PCI ");
    pc104_say_u32(at.bus);
    pc104_say(":");
    pc104_say_u32(at.dev);
    pc104_say(".");
    pc104_say_u32(at.fn);
}

/* It may be found with its rings where the firmware left them: it writes to memory only between
 * its reset and the first failure. */
static void command(uint32_t set)
{
    const uint32_t is = pc104_pci_get(place, PC104_PCI_COMMAND) & 0xFFFFu;
    pc104_pci_put(place, PC104_PCI_COMMAND, (is & ~COMMAND_MASTER) | COMMAND_NO_IRQ | set);
}

/* Of a card that was found. */
static int fails(const char *why)
{
    command(0);
    pc104_say("nic: ");
    pc104_say(why);
    pc104_say("\n");
    base = 0;
    return -EXH_E_IO;
}

/* Prints the names of other network cards for diagnosis. */
static int find(struct pc104_pci *at)
{
    struct pc104_pci none = {0, 0, 0, 0};
    *at = none;
    if (!pc104_pci_there()) {
        pc104_say("nic: no PCI bus\n");
        return -EXH_E_ABSENT;
    }
    while (pc104_pci_next(at)) {
        const uint32_t id = pc104_pci_get(*at, PC104_PCI_ID);
        if (id == CARD_ID) { return 0; }
        if (pc104_pci_get(*at, PC104_PCI_CLASS) >> 8 == CLASS_NET) {
            pc104_say("nic: ");
            pc104_say_hex(id << 16 | id >> 16);
            say_place(*at);
            pc104_say(": not one this port drives\n");
        }
    }
    pc104_say("nic: no Intel 82574L (8086:10D3)\n");
    return -EXH_E_ABSENT;
}

/* Awake, its memory answering, not yet allowed to reach ours, without interrupts. Its link to the
 * chip set is kept from sleeping: the 82574L is known to hang where it may. */
static int wake(struct pc104_pci at)
{
    const unsigned power = pc104_pci_capability(at, CAP_POWER);
    const unsigned express = pc104_pci_capability(at, CAP_EXPRESS);
    const uint32_t bar = pc104_pci_get(at, PC104_PCI_BAR0);
    const int wide = (bar & 6u) == 4u;
    place = at;
    if ((bar & 1u) || (wide && pc104_pci_get(at, PC104_PCI_BAR1) != 0) || (bar & ~0x1FFFFu) == 0) {
        return fails("firmware gave it no memory below 4 GiB");
    }
    if (power) {
        pc104_pci_put(at, power + 4, pc104_pci_get(at, power + 4) & ~3u);
        pause_us(10000);
    }
    if (express) {
        pc104_pci_put(at, express + 0x10, pc104_pci_get(at, express + 0x10) & 0xFFFFu & ~3u);
    }
    command(COMMAND_MEMORY);
    base = bar & ~0x1FFFFu;
    if (pc104_guard_device(base) < 0) { return fails("its memory lies where the image is"); }
    return get(STATUS) == UINT32_MAX ? fails("does not answer") : 0;
}

/* --- starting it --- */

static void quiet(void)
{
    put(IMC, UINT32_MAX);
    (void)get(ICR);
}

static int reset(void)
{
    quiet();
    put(RCTL, 0);
    put(TCTL, 0);
    put(CTRL, get(CTRL) | CTRL_NO_MASTER);
    if (!becomes(STATUS, STATUS_MASTER, 0, 100000)) { return fails("does not let go of the bus"); }
    put(EXTCNF_CTRL, get(EXTCNF_CTRL) | MDIO_OURS);
    (void)becomes(
        EXTCNF_CTRL, MDIO_OURS, MDIO_OURS, 10000); /* the card's own firmware, if there is any */
    put(CTRL, get(CTRL) | CTRL_RESET);
    pause_us(1000);
    if (!becomes(CTRL, CTRL_RESET, 0, 10000)) { return fails("does not come back from its reset"); }
    (void)becomes(EECD, EECD_READ, EECD_READ, 20000); /* judged by the address that it gives */
    pause_us(25000); /* the other half, towards the cable, is set up */
    quiet();
    return 0;
}

static int read_mac(uint8_t mac[6])
{
    const uint32_t low = get(RAL0), high = get(RAH0);
    for (unsigned i = 0; i < 6; i++) {
        mac[i] = (uint8_t)(i < 4 ? low >> 8 * i : high >> 8 * (i - 4));
    }
    if (!(high & RAH_VALID) || (mac[0] & 1) || (low == 0 && (high & 0xFFFFu) == 0)) {
        return fails("has no address of its own");
    }
    return 0;
}

static void open_in(void)
{
    for (unsigned i = 0; i < IN; i++) {
        in_ring[i].at = (uint32_t)in_buffer[i];
        in_ring[i].at_high = 0;
        in_ring[i].status = 0;
    }
    in_at = in_back = torn = 0;
    for (unsigned i = 0; i < 128; i++) { put(MTA + 4 * i, 0); }
    put(RXCSUM, 0);
    put(RFCTL, get(RFCTL) & ~RFCTL_EXTENDED);
    put(RDBAL, (uint32_t)in_ring);
    put(RDBAH, 0);
    put(RDLEN, sizeof in_ring);
    put(RDH, 0);
    put(RDT, 0);
    put(RCTL, RCTL_ON | RCTL_BROADCAST | CRC_REMOVED);
    put(RDT, IN - 1);
}

static void open_out(void)
{
    for (unsigned i = 0; i < OUT; i++) {
        out_ring[i].at = (uint32_t)out_buffer[i];
        out_ring[i].at_high = 0;
        out_ring[i].status = OUT_DONE;
    }
    out_at = 0;
    put(TDBAL, (uint32_t)out_ring);
    put(TDBAH, 0);
    put(TDLEN, sizeof out_ring);
    put(TDH, 0);
    put(TDT, 0);
    put(TXDCTL, TXDCTL_WRITEBACK);
    put(TIPG, TIPG_COPPER);
    put(TCTL, TCTL_ON);
}

static void say_open(struct pc104_pci at, const uint8_t mac[6])
{
    static const char digit[] = "0123456789abcdef";
    char text[] = "00:00:00:00:00:00";
    for (unsigned i = 0; i < 6; i++) {
        text[3 * i] = digit[mac[i] >> 4];
        text[3 * i + 1] = digit[mac[i] & 15];
    }
    pc104_say("nic 82574L");
    say_place(at);
    pc104_say(", address ");
    pc104_say(text);
    pc104_say("\n");
}

int pc104_nic_open(uint8_t mac[6])
{
    struct pc104_pci at;
    int err = find(&at);
    if (err == 0) { err = wake(at); }
    if (err == 0) { err = reset(); }
    if (err == 0) { err = read_mac(mac); }
    if (err < 0) { return err; }
    command(COMMAND_MEMORY | COMMAND_MASTER);
    put(CTRL, (get(CTRL) & ~(CTRL_FORCE | CTRL_NO_MASTER)) | CTRL_LINK_UP);
    open_in();
    open_out();
    say_open(at, mac);
    return 0;
}

/* --- frames --- */

int pc104_nic_next(const uint8_t **frame)
{
    const volatile struct in *d = &in_ring[in_at];
    const uint8_t status = d->status, tail = torn;
    if (base == 0 || !(status & IN_DONE)) { return 0; }
    __asm__ volatile("" : : : "memory"); /* the buffer is read after its mark */
    *frame = in_buffer[in_at];
    torn = !(status & IN_END);
    if (torn || tail || (d->errors & IN_BAD) || d->length_B == 0 || d->length_B > BUFFER_B) {
        counts.damaged++;
        return -EXH_E_IO;
    }
    return d->length_B;
}

void pc104_nic_done(void)
{
    in_ring[in_at].status = 0;
    in_at = (in_at + 1) % IN;
}

void pc104_nic_back(void)
{
    if (in_back == in_at) { return; }
    __asm__ volatile("" : : : "memory");
    put(RDT, (in_at + IN - 1) % IN); /* the card's: all but the one before the next */
    in_back = in_at;
}

uint8_t *pc104_nic_room(void)
{
    return base && (out_ring[out_at].status & OUT_DONE) ? out_buffer[out_at] : NULL;
}

void pc104_nic_send(size_t len_B)
{
    volatile struct out *d = &out_ring[out_at];
    d->length_B = (uint16_t)len_B;
    d->sum_at = d->sum_from = 0;
    d->special = 0;
    d->command = OUT_SEND;
    __asm__ volatile("" : : : "memory");
    out_at = (out_at + 1) % OUT; /* first: a fault in between leaves room for the last records */
    __asm__ volatile("" : : : "memory");
    d->status = 0;
    __asm__ volatile("" : : : "memory");
    put(TDT, out_at);
    counts.sent++;
}

void pc104_nic_counts(struct pc104_nic_counts *c)
{
    if (base) {
        const uint32_t status = get(STATUS);
        counts.gone = status == UINT32_MAX;
        counts.up = !counts.gone && (status & STATUS_UP);
        if (!counts.gone) {
            counts.missed += get(MPC); /* both clear when read */
            counts.crc += get(CRCERRS);
        }
    }
    *c = counts;
}
