/* SPDX-License-Identifier: MIT */
/* Runs LLVMFuzzerTestOneInput() where there is no libFuzzer, and makes its first inputs.
 *
 *   driver --write DIR              the first inputs, one file each
 *   driver --check DIR              whether the files there are these (exit 1 if not)
 *   driver SECONDS [SEED] DIR       every file once, then mutants of them for so long
 *   driver FILE...                  these inputs, once each
 *
 * No coverage guides it: the harness puts right what a mutation would fail at first. A
 * failure leaves its input in ./fuzz-failed. */
#include "exhand/wire.h"

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define INPUT_MAX 4096u
#define FILES_MAX 64

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

struct input {
    char name[64];
    uint8_t byte[INPUT_MAX];
    size_t n;
};
static struct input files[FILES_MAX];
static int files_n;
static struct input running;

/* --- first inputs --- */

static void add(struct input *in, unsigned right, const uint8_t *packet, size_t n)
{
    if (in->n + 3 + n > INPUT_MAX) { return; }
    in->byte[in->n] = (uint8_t)right;
    in->byte[in->n + 1] = (uint8_t)(n & 0xFF);
    in->byte[in->n + 2] = (uint8_t)(n >> 8);
    memcpy(&in->byte[in->n + 3], packet, n);
    in->n += 3 + n;
}

static void add_packet(
    struct input *in, struct exh_wire_tx *tx, unsigned right, struct exh_wire_packet p)
{
    uint8_t buf[EXH_WIRE_MAX_B];
    const int32_t n = exh_wire_encode(tx, &p, 1000, buf, sizeof buf);
    if (n < 0) { exit(2); }
    add(in, right, buf, (size_t)n);
}

static struct exh_wire_packet packet_of(uint8_t type)
{
    struct exh_wire_packet p;
    memset(&p, 0, sizeof p);
    p.type = type;
    if (type == EXH_WIRE_PLANES) {
        p.u.planes.fingers = 3;
        p.u.planes.plane[0].kind = EXH_PLANE_NONE;
        p.u.planes.plane[1] = (struct exh_wire_plane){
            EXH_PLANE_HIT, 1, 7, {0, 0, 1 << 30}, {0, 0, 1 << 26}, {0, 0, 1 << 28}};
    } else if (type == EXH_WIRE_PARAM) {
        p.u.param = (struct exh_wire_param){0x0B01, 0, 5};
    } else if (type == EXH_WIRE_TRACE_ASK) {
        p.u.trace_ask = (struct exh_wire_trace_request){4, {0, 1, 2, 300}};
    } else if (type == EXH_WIRE_TRACE) {
        p.u.trace.first = 0xFFFFFFFDu;
        p.u.trace.frames = EXH_WIRE_FRAMES;
    }
    return p;
}

/* One per type behind a HELLO, and what a link does: twice, late, anew, short, nothing. */
static void make_files(void)
{
    static const char *const name[] = {
        "hello", "state", "planes", "param", "ack", "trace-ask", "trace"};
    for (uint8_t t = EXH_WIRE_HELLO; t <= EXH_WIRE_TRACE; t++) {
        for (unsigned right = 0; right < 2; right++) {
            struct input *in = &files[files_n++];
            struct exh_wire_tx tx = {9, 1};
            snprintf(in->name, sizeof in->name, "%s%s", name[t - 1], right ? "-right" : "");
            add_packet(in, &tx, 0, packet_of(EXH_WIRE_HELLO));
            add_packet(in, &tx, right ? 31 : 0, packet_of(t));
        }
    }
    {
        struct input *in = &files[files_n++];
        struct exh_wire_tx tx = {9, 5}, anew = {10, 0};
        strcpy(in->name, "restart");
        add_packet(in, &tx, 0, packet_of(EXH_WIRE_HELLO));
        add_packet(in, &anew, 0, packet_of(EXH_WIRE_PARAM));
        add_packet(in, &anew, 0, packet_of(EXH_WIRE_HELLO));
        add_packet(in, &tx, 0, packet_of(EXH_WIRE_PARAM));
    }
    {
        struct input *in = &files[files_n++];
        struct exh_wire_tx tx = {9, 5};
        strcpy(in->name, "order");
        add_packet(in, &tx, 0, packet_of(EXH_WIRE_HELLO));
        for (int i = 0; i < 4; i++) {
            static const uint32_t seq[] = {9, 9, 7, 0x80000009u};
            tx.seq = seq[i];
            add_packet(in, &tx, 0, packet_of(EXH_WIRE_PARAM));
        }
    }
    {
        struct input *in = &files[files_n++];
        struct exh_wire_tx tx = {9, 5};
        strcpy(in->name, "window");
        add_packet(in, &tx, 0, packet_of(EXH_WIRE_HELLO));
        for (int i = 0; i < 3; i++) { /* as far behind as is remembered, and one more */
            static const uint32_t seq[] = {71, 8, 7};
            tx.seq = seq[i];
            add_packet(in, &tx, 0, packet_of(EXH_WIRE_PARAM));
        }
    }
    {
        struct input *in = &files[files_n++];
        struct exh_wire_tx tx = {9, 100}, gone = {7, 3};
        strcpy(in->name, "silence"); /* one that is long gone is heard once more */
        add_packet(in, &tx, 0, packet_of(EXH_WIRE_HELLO));
        add_packet(in, &gone, 0, packet_of(EXH_WIRE_HELLO));
        add_packet(in, &tx, 32, packet_of(EXH_WIRE_HELLO));
        add_packet(in, &tx, 64, packet_of(EXH_WIRE_PARAM));
        add_packet(in, &tx, 128, packet_of(EXH_WIRE_HELLO));
    }
    {
        struct input *in = &files[files_n++];
        struct exh_wire_tx tx = {9, 100};
        strcpy(in->name, "far");
        add_packet(in, &tx, 0, packet_of(EXH_WIRE_HELLO));
        for (unsigned i = 0; i < 3; i++) {
            static const uint32_t seq[] = {100 + EXH_WIRE_AHEAD, 101 + 2 * EXH_WIRE_AHEAD, 101};
            tx.seq = seq[i];
            add_packet(
                in, &tx, i == 2 ? 64 : 0, packet_of(i == 2 ? EXH_WIRE_HELLO : EXH_WIRE_PARAM));
        }
    }
    {
        static const uint8_t few[] = {0x58, 0x57, 1, 3, 0xFF, 0xFF};
        struct input *in = &files[files_n++];
        strcpy(in->name, "short");
        add(in, 0, few, sizeof few);
        add(in, 31, few, 0);
        add(in, 31, few, 4);
    }
    for (int i = 0; i < files_n; i++) {
        if (files[i].n >= 400) {
            fprintf(stderr, "%s: %zu bytes\n", files[i].name, files[i].n);
            exit(1);
        }
    }
}

static FILE *open_in(const char *dir, const char *name, const char *mode)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    return fopen(path, mode);
}

static int write_or_check(const char *dir, int check)
{
    int bad = 0;
    make_files();
    for (int i = 0; i < files_n; i++) {
        static uint8_t got[INPUT_MAX + 1];
        FILE *f = open_in(dir, files[i].name, check ? "rb" : "wb");
        if (f == NULL) {
            perror(files[i].name);
            return 1;
        }
        if (!check) {
            bad |= fwrite(files[i].byte, 1, files[i].n, f) != files[i].n;
        } else if (fread(got, 1, sizeof got, f) != files[i].n ||
                   memcmp(got, files[i].byte, files[i].n) != 0) {
            fprintf(
                stderr, "%s/%s: not what the code makes: make fuzz-corpus\n", dir, files[i].name);
            bad = 1;
        }
        fclose(f);
    }
    return bad;
}

/* --- mutants --- */

static uint64_t state;

static uint64_t u64(void)
{
    uint64_t z = state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

static size_t below(size_t n) { return n ? (size_t)(u64() % n) : 0; }

static void mutate(struct input *in)
{
    static const uint8_t odd[] = {0, 1, 2, 0x7F, 0x80, 0xFF, 0x40, 31};
    const size_t at = below(in->n), n = 1 + below(16);
    switch (below(7)) {
    case 0: in->byte[at] = (uint8_t)(in->byte[at] ^ 1u << below(8)); break;
    case 1: in->byte[at] = odd[below(sizeof odd)]; break;
    case 2: in->byte[at] = (uint8_t)u64(); break;
    case 3: /* four bytes of another number */
        for (size_t i = at; i < at + 4 && i < in->n; i++) { in->byte[i] = odd[below(8)]; }
        break;
    case 4: /* some go */
        if (at + n <= in->n) {
            memmove(&in->byte[at], &in->byte[at + n], in->n - at - n);
            in->n -= n;
        }
        break;
    case 5: /* some come */
        if (in->n + n <= INPUT_MAX) {
            memmove(&in->byte[at + n], &in->byte[at], in->n - at);
            for (size_t i = 0; i < n; i++) { in->byte[at + i] = (uint8_t)u64(); }
            in->n += n;
        }
        break;
    default: { /* another input behind it */
        const struct input *other = &files[below((size_t)files_n)];
        if (in->n + other->n <= INPUT_MAX) {
            memcpy(&in->byte[in->n], other->byte, other->n);
            in->n += other->n;
        }
    }
    }
}

static void keep(int sig)
{
    FILE *f = fopen("fuzz-failed", "wb");
    if (f != NULL) {
        fwrite(running.byte, 1, running.n, f);
        fclose(f);
    }
    signal(sig, SIG_DFL);
    raise(sig);
}

static int read_file(const char *path, struct input *in)
{
    FILE *f = fopen(path, "rb");
    if (f == NULL) { return -1; }
    in->n = fread(in->byte, 1, sizeof in->byte, f);
    fclose(f);
    return 0;
}

static int read_dir(const char *dir)
{
    DIR *d = opendir(dir);
    struct dirent *e;
    if (d == NULL) { return -1; }
    while ((e = readdir(d)) != NULL && files_n < FILES_MAX) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", dir, e->d_name);
        if (e->d_name[0] != '.' && read_file(path, &files[files_n]) == 0) { files_n++; }
    }
    closedir(d);
    return files_n;
}

static void run(void) { LLVMFuzzerTestOneInput(running.byte, running.n); }

static int fuzz(long seconds, uint64_t seed, const char *dir)
{
    const time_t end = time(NULL) + seconds;
    unsigned long n = 0;
    if (read_dir(dir) <= 0) {
        fprintf(stderr, "%s: no inputs\n", dir);
        return 3;
    }
    signal(SIGABRT, keep);
    for (int i = 0; i < files_n; i++) {
        running = files[i];
        run();
    }
    for (; n % 256 || time(NULL) < end; n++) {
        state = seed + n; /* the n-th mutant can be made again alone */
        running = files[below((size_t)files_n)];
        for (size_t k = 1 + below(8); k > 0; k--) { mutate(&running); }
        run();
    }
    printf("%d inputs, %lu mutants from seed %llu: nothing found\n", files_n, n,
        (unsigned long long)seed);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc == 3 && strncmp(argv[1], "--", 2) == 0) {
        return write_or_check(argv[2], strcmp(argv[1], "--check") == 0);
    }
    if (argc >= 3 && atol(argv[1]) > 0) {
        return fuzz(atol(argv[1]), argc > 3 ? strtoull(argv[2], NULL, 10) : 1, argv[argc - 1]);
    }
    for (int i = 1; i < argc; i++) {
        if (read_file(argv[i], &running) != 0) {
            perror(argv[i]);
            return 3;
        }
        run();
    }
    return argc < 2 ? 2 : 0;
}
