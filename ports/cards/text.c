/* SPDX-License-Identifier: MIT */
/* What went wrong, in one line. */
#include "box.h"

#include "exhand/error.h"

static const char *const card_text[EXH_BOX_CARDS + 1] = {
    [EXH_BOX_A] = "S526 A",
    [EXH_BOX_B] = "S526 B",
    [EXH_BOX_GLOVE] = "MM-32X-AT",
    [EXH_BOX_CARDS] = "box",
};

static const char *const row_text[EXH_BOX_ROWS] = {
    [EXH_BOX_ROW_BASE_A] = "base of S526 A",
    [EXH_BOX_ROW_BASE_B] = "base of S526 B",
    [EXH_BOX_ROW_BASE_GLOVE] = "base of MM-32X-AT",
    [EXH_BOX_ROW_OVERLAP] = "base within another card's registers",
    [EXH_BOX_ROW_FINGERS] = "fingers",
    [EXH_BOX_ROW_MONITOR] = "when monitors are converted",
    [EXH_BOX_ROW_GLOVE] = "when the glove is converted",
    [EXH_BOX_ROW_SPAN] = "span of the D/A",
    [EXH_BOX_ROW_WAIT] = "limit of a wait",
    [EXH_BOX_ROW_SCAN] = "channels, interval or lost_limit of the scan",
    [EXH_BOX_ROW_PINS] = "pins to be turned over",
    [EXH_BOX_ROW_FULL] = "full, which is 1 where board B answers",
};

struct text {
    char *at;
    size_t left, len; /* left: with the end */
};

static void put(struct text *t, const char *s)
{
    for (; *s != '\0' && t->left > 1; t->left--, t->len++) { *t->at++ = *s++; }
}

static void put_hex(struct text *t, uint32_t v)
{
    char s[7] = "0x0000";
    for (unsigned i = 0; i < 4; i++) { s[5 - i] = "0123456789ABCDEF"[v >> 4 * i & 15u]; }
    put(t, s);
}

static void put_i32(struct text *t, int32_t v)
{
    char s[12];
    char *p = s + sizeof s - 1;
    uint32_t u = v < 0 ? 0u - (uint32_t)v : (uint32_t)v;
    *p = '\0';
    do {
        *--p = (char)('0' + u % 10);
        u /= 10;
    } while (u);
    if (v < 0) { *--p = '-'; }
    put(t, p);
}

static int has_place(unsigned what)
{
    return what == EXH_CARD_COUNTER || what == EXH_CARD_EE_TIMEOUT || what == EXH_CARD_DA_GAIN ||
           what == EXH_CARD_DA_OFFSET || what == EXH_CARD_QUADRATURE || what == EXH_CARD_REST ||
           what == EXH_CARD_FOLLOW;
}

/* Values of registers are printed in hexadecimal. */
static int is_bits(unsigned what)
{
    return what == EXH_CARD_SIGNATURE || what == EXH_CARD_REGISTER || what == EXH_CARD_LINES;
}

static void put_value(struct text *t, unsigned what, int32_t v)
{
    if (is_bits(what)) {
        put_hex(t, (uint32_t)v);
    } else {
        put_i32(t, v);
    }
}

static void put_fault(struct text *t, const struct exh_card_fault *f)
{
    const int ranged = is_bits(f->what) || f->lo != 0 || f->hi != 0;
    put(t, ": ");
    put(t, exh_card_phase_text(f->phase));
    put(t, ": ");
    if (f->what == EXH_CARD_BAD_VALUE && f->at < EXH_BOX_ROWS) {
        put(t, row_text[f->at]);
        put(t, ": ");
    }
    put(t, exh_card_what_text(f->what));
    if (has_place(f->what) || f->what == EXH_CARD_REGISTER) {
        put(t, f->what == EXH_CARD_REGISTER ? ", offset " : ", number ");
        put_i32(t, f->at);
    }
    if (f->what == EXH_CARD_BAD_VALUE || ranged) {
        put(t, ": ");
        put_value(t, f->what, f->got);
    }
    if (ranged) {
        put(t, " (");
        put_value(t, f->what, f->lo);
        if (f->hi != f->lo) {
            put(t, is_bits(f->what) ? " or " : " .. ");
            put_value(t, f->what, f->hi);
        }
        put(t, ")");
    }
}

const char *exh_box_card_text(unsigned card)
{
    return card <= EXH_BOX_CARDS ? card_text[card] : "?";
}

size_t exh_box_error_text(char *text, size_t cap_B, const struct exh_box_error *e)
{
    struct text t = {text, cap_B, 0};
    if (cap_B == 0) { return 0; }
    put(&t, exh_box_card_text(e->card));
    if (e->card < EXH_BOX_CARDS) {
        put(&t, " at ");
        put_hex(&t, e->base);
    }
    if (e->code == 0) {
        put(&t, ": ");
        put(&t, exh_card_what_text(EXH_CARD_OK));
    } else {
        put_fault(&t, &e->fault);
    }
    *t.at = '\0';
    return t.len;
}
