/* SPDX-License-Identifier: MIT */
/* Scans of the MM-32X-AT, as Linux does them: the FIFO, an interrupt for each scan, the card's own
 * timer. The glove is read by such scans. */
#include "check.h"
#include "linux.h"
#include "pin.h"
#include "table.h"

#include <stdio.h>
#include <string.h>

#define SCANS_MAX 50u
#define TEN_V     2u /* range of +-10 V, in the driver's order */

static uint16_t sample[SCANS_MAX * 32];

/* Channels 0 .. n - 1, every period_ns; one scan alone starts immediately. */
static int scan(unsigned channels, unsigned scans, unsigned period_ns, unsigned interval_ns)
{
    unsigned list[32];
    struct comedi_cmd c;
    memset(&c, 0, sizeof c);
    for (unsigned i = 0; i < channels; i++) { list[i] = CR_PACK(i, TEN_V, AREF_GROUND); }
    c.subdev = MM_AI;
    c.start_src = TRIG_NOW;
    c.scan_begin_src = TRIG_TIMER;
    c.scan_begin_arg = period_ns;
    c.convert_src = TRIG_TIMER;
    c.convert_arg = interval_ns;
    c.scan_end_src = TRIG_COUNT;
    c.scan_end_arg = channels;
    c.stop_src = TRIG_COUNT;
    c.stop_arg = scans;
    c.chanlist = list;
    c.chanlist_len = channels;
    memset(sample, 0x55, sizeof sample);
    return command(MM, &c, sample, channels * scans);
}

int mm_scan(unsigned scans) { return scan(22, scans, 40000000, 20000); }

static int64_t code(int32_t v_uV)
{
    return ((int64_t)(v_uV + 10000000) * 65536 * 2 + 20000000) / 40000000;
}

static void set_pins(unsigned n)
{
    for (unsigned ch = 0; ch < 32; ch++) {
        set_pin(PIN_GLOVE + ch, (int32_t)((n * 7919u + ch * 104729u) * 2654435761u >> 8) - 8388608);
    }
}

static void check(unsigned channels, unsigned scans)
{
    for (unsigned i = 0; i < channels * scans; i++) {
        const int32_t v_uV = pin(PIN_GLOVE + i % channels);
        table_value(v_uV, code(v_uV), sample[i]);
    }
}

static void check_single(unsigned channels, unsigned interval_ns)
{
    table_row("%u channels, %u us, at once", channels, interval_ns / 1000);
    for (unsigned n = 0; n < 20; n++) {
        set_pins(n);
        table_value(channels, channels, scan(channels, 1, 1000000, interval_ns));
        check(channels, 1);
    }
    table_end_row();
}

static void check_paced(unsigned channels, unsigned period_ns)
{
    table_row("%u channels, every %u ms", channels, period_ns / 1000000);
    set_pins(channels);
    table_value(
        channels * SCANS_MAX, channels * SCANS_MAX, scan(channels, SCANS_MAX, period_ns, 20000));
    check(channels, SCANS_MAX);
    table_end_row();
}

void check_mm_scans(void)
{
    table_head("Scans: driver dmm32at, commands, +-10 V, an interrupt each", "input, uV",
        "comedi, 0..65535");
    check_single(22, 20000);
    check_single(22, 10000);
    check_single(32, 5000);
    check_single(1, 20000);
    check_paced(22, 20000000);
    check_paced(32, 30000000);
}
