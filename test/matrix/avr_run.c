/* SPDX-License-Identifier: MIT */
/* avr_run IMAGE...: each image of avr.c on an emulated ATmega1284P, with the rates of
 * EXH_RATES=lo..hi:step. Prints their output. Exit status 1: an image did not end. The chip has 16
 * KiB of memory. An image whose data need more than 15 KiB gets 63, and a line says so.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

#define GPIOR0 0x3E  /* in data memory */
#define BEGIN  0x100 /* of memory, behind registers */
#define MUCH_B 15360

static const char mark[8] = {'E', 'X', 'H', 'R', 'A', 'T', 'E', 'S'};

static void say(struct avr_t *avr, avr_io_addr_t at, uint8_t c, void *param)
{
    (void)param;
    avr->data[at] = c;
    (void)putchar(c);
    if (c == '\n') { (void)fflush(stdout); }
}

static void ask(uint8_t *flash, uint32_t flash_B, const unsigned rate[3])
{
    for (uint32_t i = 0; i + sizeof mark + 12 <= flash_B; i++) {
        if (memcmp(flash + i, mark, sizeof mark) != 0) { continue; }
        for (unsigned k = 0; k < 12; k++) {
            flash[i + sizeof mark + k] = (uint8_t)(rate[k / 4] >> 8 * (k % 4));
        }
    }
}

/* How much of memory the stack has written, down from the top: it began as this. */
#define NEVER 0xA5

static uint32_t stack_B(const struct avr_t *avr, uint32_t data_B)
{
    uint32_t first = BEGIN + data_B;
    while (first < avr->ramend && avr->data[first] == NEVER) { first++; }
    return avr->ramend - first;
}

static int run(const char *image, const unsigned rate[3])
{
    elf_firmware_t fw;
    avr_t *avr = avr_make_mcu_by_name("atmega1284p");
    int state = cpu_Running;
    uint32_t data_B;
    memset(&fw, 0, sizeof fw);
    if (avr == NULL || elf_read_firmware(image, &fw) != 0) {
        fprintf(stderr, "%s: no image of this machine\n", image);
        return 1;
    }
    data_B = fw.datasize + fw.bsssize;
    if (data_B > MUCH_B) { avr->ramend = 0xFFFF; }
    avr_init(avr);
    avr->log = LOG_NONE;
    avr->frequency = 16000000;
    avr_load_firmware(avr, &fw);
    ask(avr->flash, avr->flashend + 1, rate);
    memset(avr->data + BEGIN, NEVER, avr->ramend + 1 - BEGIN);
    avr_register_io_write(avr, GPIOR0, say, NULL);
    while (state != cpu_Done && state != cpu_Crashed) { state = avr_run(avr); }
    printf("avr: %s: code %u B, data %u B, stack %u B of %u B, %llu cycles\n", image,
        (unsigned)fw.flashsize, (unsigned)data_B, (unsigned)stack_B(avr, data_B),
        (unsigned)(avr->ramend + 1 - BEGIN), (unsigned long long)avr->cycle);
    return state != cpu_Done;
}

int main(int argc, char **argv)
{
    unsigned rate[3] = {1, 2000, 1};
    const char *text = getenv("EXH_RATES");
    int bad = 0;
    if (text != NULL && sscanf(text, "%u..%u:%u", &rate[0], &rate[1], &rate[2]) < 2) { return 2; }
    for (int i = 1; i < argc; i++) { bad |= run(argv[i], rate); }
    return bad;
}
