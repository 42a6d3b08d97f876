/* SPDX-License-Identifier: MIT */
/* Main: the first process of the machine. Loads Debian's drivers, attaches the cards, compares. */
#include "check.h"
#include "linux.h"
#include "pin.h"
#include "table.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

/* enum emu_kind, enum emu_card */
enum { WELL = 0, BUSY = 2 };

static void start(void)
{
    struct utsname u;
    struct timespec t;
    int tty;
    mount("dev", "/dev", "devtmpfs", 0, NULL);
    mount("proc", "/proc", "proc", 0, NULL);
    tty = open("/dev/ttyS0", O_RDWR);
    for (int i = 0; i < 3; i++) { dup2(tty, i); }
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (iopl(3)) { fail("iopl", -errno); }
    uname(&u);
    clock_gettime(CLOCK_MONOTONIC, &t);
    printf("Linux %s %s, up after %ld s of its time\n", u.release, u.machine, (long)t.tv_sec);
}

/* The kernel's own remark: a module without its maker's signature would set bit 13. */
static long tainted(void)
{
    char text[32] = "";
    const int f = open("/proc/sys/kernel/tainted", O_RDONLY);
    if (f < 0 || read(f, text, sizeof text - 1) < 1) { return -1; }
    close(f);
    return strtol(text, NULL, 10);
}

static void load_all(void)
{
    static const char *const module[] = {"comedi", "comedi_8255", "s526", "dmm32at"};
    for (unsigned i = 0; i < 4; i++) {
        char path[32];
        snprintf(path, sizeof path, "/%s.ko", module[i]);
        const int e = load(path, i ? "" : "comedi_num_legacy_minors=4");
        if (e) { fail(path, e); }
    }
    say(tainted() == 0,
        "modules loaded, and all bear Debian's signature (the kernel is not tainted)");
}

static void power(uint32_t fault, uint32_t card) { outl(fault | card << 8, POWER_PORT); }

static void check_attach(void)
{
    printf("\nAttaching\n");
    say(attach(SPARE, "dmm32at", BASE_EMPTY, 0) == -EIO, "dmm32at at 0x%X, where no card is: EIO",
        BASE_EMPTY);
    mark(1);
    say(attach(A, "s526", BASE_A, 0) == 0, "s526 at 0x%X", BASE_A);
    mark(0);
    say(attach(B, "s526", BASE_B, 0) == 0, "s526 at 0x%X", BASE_B);
    mark(2);
    say(attach(MM, "dmm32at", BASE_MM, IRQ_MM) == 0, "dmm32at at 0x%X", BASE_MM);
    mark(0);
}

/* What is not there, or does not end. */
static void check_faults(void)
{
    unsigned v = 0;
    printf("\nFaults\n");
    (void)detach(SPARE);
    say(attach(SPARE, "s526", BASE_EMPTY_526, 0) == 0,
        "s526 at 0x%X, where no card is, attaches unseen:", BASE_EMPTY_526);
    v = get(SPARE, GPCT, 0, 0);
    say(v == 0xFFFFFF, "its counter reads 0x%X", v);
    v = get(SPARE, S526_AI, 0, 0);
    say(v == 0x7FFF, "its A/D reads 0x%X", v);
    (void)detach(SPARE);
    (void)detach(A);
    (void)detach(MM);
    power(BUSY, MM);
    say(attach(MM, "dmm32at", BASE_MM, 0) == -EIO,
        "dmm32at refuses a card that is always busy: EIO");
    power(BUSY, A);
    say(attach(A, "s526", BASE_A, 0) == 0, "s526 attaches to a card whose operations never end:");
    say(insn(A, S526_AI, 0, 0, INSN_READ, 1, &v) == -ETIMEDOUT, "A/D: ETIMEDOUT after 1 s");
    v = 0;
    say(insn(A, S526_AO, 0, 0, INSN_WRITE, 1, &v) == -ETIMEDOUT, "D/A: ETIMEDOUT after 1 s");
    (void)detach(A);
    power(WELL, 0);
}

int main(void)
{
    const char *bug = getenv("mask");
    start();
    load_all();
    check_attach();
    traces();
    check_counters();
    check_s526_ad();
    check_s526_da();
    check_s526_lines();
    check_mm_ad();
    check_mm_scans();
    check_mm_da();
    check_mm_lines();
    printf("\nThe paper's first experiment through Linux, one finger\n");
    check_loop(1, "drop --rate 2000 --falls 1", "/out/drop_2000Hz.exh");
    check_mask(bug && strcmp(bug, "9") == 0);
    printf("\nThe second, five fingers and the glove, with that mask\n");
    check_loop(2, "bilateral --fingers all --speed fast --approaches 1", "/out/bilateral_fast.exh");
    check_faults();
    printf("\n%u values and statements, %u wrong\n", values, wrong);
    fflush(stdout);
    usleep(300000);
    outl(wrong ? 1 : 0, EXIT_PORT);
    for (;;) { pause(); }
}
