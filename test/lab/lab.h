/* SPDX-License-Identifier: MIT */
/* The subcommands of exhand-lab, the program that proves and studies: exit status as in cli.h. */
#ifndef LAB_LAB_H
#define LAB_LAB_H

int lab_advise(int argc, char **argv);
int lab_bilateral(int argc, char **argv);
int lab_drop(int argc, char **argv);
int lab_glove(int argc, char **argv);
int cli_budget(int argc, char **argv);
int cli_cards(int argc, char **argv);
int cli_certificate(int argc, char **argv);
int cli_diagram(int argc, char **argv);
int cli_faults(int argc, char **argv);
int cli_fit(int argc, char **argv);

#endif
