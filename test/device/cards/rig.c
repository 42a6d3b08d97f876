/* SPDX-License-Identifier: MIT */
#include "rig.h"

#include "check.h"

#include "exhand/error.h"

struct exh_box_report report;
struct exh_drive_in in;
struct exh_glove_in glove;
static uint8_t alive;

struct exh_box_config five(void) { return exh_box_default; }

struct exh_box_config one(void)
{
    struct exh_box_config c = exh_box_default;
    c.fingers = 1;
    return c;
}

void opened(struct exh_box_config c)
{
    bus_reset();
    if (c.fingers == 1 && !c.full) { bus.s526[1].base = 0; } /* such a box has A alone */
    alive = 0;
    CHECK_EQ_I64(exh_box_open(&c, &report), 0);
    bus_clear();
}

int put(int sign)
{
    struct exh_drive_out out = {{0}, 0x1F, ++alive};
    for (int i = 0; i < EXH_FINGERS; i++) {
        out.dac_raw[i] = (uint16_t)(32768 + sign * 100 * (i + 1));
    }
    return exh_box_write_drive(&out);
}

void fails(int err, unsigned card_no, unsigned what)
{
    const struct exh_box_error *e = exh_box_error();
    CHECK_EQ_I64(err, -EXH_E_IO);
    CHECK(e->code == -EXH_E_IO && e->card == card_no && e->fault.what == what, "%d: %s: %s",
        e->code, exh_box_card_text(e->card), exh_card_what_text(e->fault.what));
    CHECK(bus_safe(), "outputs left on");
    CHECK_EQ_I64(put(1), -EXH_E_IO);
    CHECK_EQ_I64(exh_box_read_drive(&in), -EXH_E_IO);
    CHECK(bus_safe(), "outputs on again");
}

struct exh_box_config gloved(unsigned when)
{
    struct exh_box_config c = five();
    c.glove = (uint8_t)when;
    return c;
}

void says(const struct exh_box_error *e, const char *want)
{
    char text[160];
    const size_t n = exh_box_error_text(text, sizeof text, e);
    CHECK(check_same_text(text, want), "\"%s\", want \"%s\"", text, want);
    CHECK_EQ_I64(text[n], 0);
    for (size_t cap = 1; cap <= n + 1; cap++) { /* cut, but terminated */
        char part[160];
        memset(part, 'x', sizeof part);
        CHECK(exh_box_error_text(part, cap, e) == cap - 1, "of %u", (unsigned)cap);
        CHECK(part[cap - 1] == '\0' && part[cap] == 'x' && memcmp(part, text, cap - 1) == 0, "%u",
            (unsigned)cap);
    }
    CHECK(exh_box_error_text(text, 0, e) == 0, "nowhere to write");
}
