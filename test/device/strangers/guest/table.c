/* SPDX-License-Identifier: MIT */
#include "table.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

uint32_t values, wrong;

static char row[40];
static uint32_t row_values, row_wrong;
static int64_t first[3], last[2]; /* pin, got; of the first that differs also wanted */

void table_head(const char *title, const char *pin_unit, const char *linux_unit)
{
    printf(
        "\n%s\n  %-24s %22s %20s %8s %7s\n", title, "", pin_unit, linux_unit, "values", "differ");
}

void table_row(const char *name, ...)
{
    va_list args;
    va_start(args, name);
    vsnprintf(row, sizeof row, name, args);
    va_end(args);
    row_values = row_wrong = 0;
}

/* The row shows its last value, or the first that differs. */
void table_value(int64_t pin, int64_t wanted, int64_t got)
{
    row_values++;
    last[0] = pin;
    last[1] = got;
    if (wanted != got && row_wrong++ == 0) {
        first[0] = pin;
        first[1] = got;
        first[2] = wanted;
    }
}

void table_end_row(void)
{
    const int64_t *show = row_wrong ? first : last;
    printf("  %-24s %22" PRId64 " %20" PRId64 " %8" PRIu32 " %7" PRIu32, row, show[0], show[1],
        row_values, row_wrong);
    if (row_wrong) { printf("   wanted %" PRId64, first[2]); }
    printf("\n");
    values += row_values;
    wrong += row_wrong;
}

void say(int holds, const char *format, ...)
{
    va_list args;
    printf("%s ", holds ? "  yes " : "  NO  ");
    va_start(args, format);
    vprintf(format, args);
    va_end(args);
    printf("\n");
    values++;
    wrong += !holds;
}
