/* SPDX-License-Identifier: MIT */
/* Start of a Cortex-M under an emulator: vectors, memory, the words of the command line as an
 * environment. Text and exit use semihosting (a breakpoint that the emulator answers). No device of
 * a board is touched. The linker sets the place of memory. */
#include <stddef.h>
#include <stdint.h>

#define SYS_WRITE0        0x04u
#define SYS_GET_CMDLINE   0x15u
#define SYS_EXIT_EXTENDED 0x20u
#define ENDED             0x20026u /* the program ended normally */
#define FAULT             5u

/* cortex_m.ld */
extern uint32_t __stack_top[], __data_start[], __data_end[], __bss_start[], __bss_end[];
extern const uint32_t __data_load[];

int main(void);
void metal_reset(void);
int metal_putchar(int c);
const char *metal_env(const char *name);

static uintptr_t ask(uint32_t what, const void *with)
{
    register uintptr_t operation __asm__("r0") = what;
    register const void *argument __asm__("r1") = with;
    __asm__ volatile("bkpt 0xab" : "+r"(operation) : "r"(argument) : "memory");
    return operation;
}

static void leave(uint32_t status)
{
    const uint32_t block[2] = {ENDED, status};
    (void)ask(SYS_EXIT_EXTENDED, block);
    for (;;) {}
}

/* --- text, a line at a time --- */

static char line[256];
static uint32_t line_B;

static void flush(void)
{
    line[line_B] = '\0';
    (void)ask(SYS_WRITE0, line);
    line_B = 0;
}

int metal_putchar(int c)
{
    line[line_B++] = (char)c;
    if (c == '\n' || line_B == sizeof line - 1) { flush(); }
    return c;
}

/* --- NAME=value words of the command line --- */

static char words[512];

static void read_words(void)
{
    const struct {
        char *at;
        uint32_t B;
    } block = {words, sizeof words};
    if (ask(SYS_GET_CMDLINE, &block) != 0) { words[0] = '\0'; }
    for (uint32_t i = 0; i < sizeof words; i++) {
        if (words[i] == ' ') { words[i] = '\0'; }
    }
}

const char *metal_env(const char *name)
{
    const char *p = words; /* each ends with a zero; behind the last is one more, as memory began */
    while (*p != '\0') {
        const char *n = name;
        while (*n != '\0' && *p == *n) {
            n++;
            p++;
        }
        if (*n == '\0' && *p == '=') { return p + 1; }
        while (*p++ != '\0') {}
    }
    return NULL;
}

/* --- start --- */

void metal_reset(void)
{
    const uint32_t *from = __data_load;
    for (uint32_t *p = __data_start; p < __data_end; p++) { *p = *from++; }
    for (uint32_t *p = __bss_start; p < __bss_end; p++) { *p = 0; }
    read_words();
    leave((uint32_t)main());
}

static void fault(void)
{
    (void)ask(SYS_WRITE0, "processor exception\n");
    leave(FAULT);
}

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*handler[15])(void);
} vectors = {__stack_top, {metal_reset, fault, fault, fault, fault, fault, fault, fault, fault,
                              fault, fault, fault, fault, fault, fault}};

/* --- calls of compilers: clang for this CPU has its own names, with value and length the other way
 * round --- */

void *memcpy(void *restrict dst, const void *restrict src, size_t len_B);
void *memmove(void *dst, const void *src, size_t len_B);
void *memset(void *dst, int value, size_t len_B);

#define AS(name, list, call) \
    void name list; \
    void name list { (void)call; }
AS(__aeabi_memcpy, (void *d, const void *s, size_t n), memcpy(d, s, n))
AS(__aeabi_memcpy4, (void *d, const void *s, size_t n), memcpy(d, s, n))
AS(__aeabi_memcpy8, (void *d, const void *s, size_t n), memcpy(d, s, n))
AS(__aeabi_memmove, (void *d, const void *s, size_t n), memmove(d, s, n))
AS(__aeabi_memmove4, (void *d, const void *s, size_t n), memmove(d, s, n))
AS(__aeabi_memmove8, (void *d, const void *s, size_t n), memmove(d, s, n))
AS(__aeabi_memset, (void *d, size_t n, int v), memset(d, v, n))
AS(__aeabi_memset4, (void *d, size_t n, int v), memset(d, v, n))
AS(__aeabi_memset8, (void *d, size_t n, int v), memset(d, v, n))
AS(__aeabi_memclr, (void *d, size_t n), memset(d, 0, n))
AS(__aeabi_memclr4, (void *d, size_t n), memset(d, 0, n))
AS(__aeabi_memclr8, (void *d, size_t n), memset(d, 0, n))
