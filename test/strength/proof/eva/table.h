/* SPDX-License-Identifier: MIT */
/* A table of four groups, one of no rows and one of no instances among them, with anything in its rows; what it holds. */
#ifndef PROOF_TABLE_H
#define PROOF_TABLE_H

#include "any.h"

#include "exhand/signal.h"

#define TABLE_ROWS   3
#define TABLE_VALUES (TABLE_ROWS * 2 + 2)

static struct exh_signal table_row[TABLE_ROWS];
static const struct exh_signal_group table_group[] = {
    {table_row, TABLE_ROWS, 2}, {table_row, 0, 1}, {table_row, 1, 0}, {table_row, 2, 1}};
static const struct exh_signal_table table = {table_group, 4};

/* The same values, no group without. */
static const struct exh_signal_group full_group[] = {{table_row, TABLE_ROWS, 2}, {table_row, 2, 1}};
static const struct exh_signal_table full_table = {full_group, 2};

static void any_rows(void)
{
    ANY(table_row);
    for (unsigned i = 0; i < TABLE_ROWS; i++) {
        table_row[i].name = table_row[i].unit = table_row[i].help = "x";
    }
}

#endif
