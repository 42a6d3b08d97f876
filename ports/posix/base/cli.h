/* SPDX-License-Identifier: MIT */
/* The subcommands of the host program: one file each. Each returns the exit status:
 * 0 ok, 1 a check failed, 2 bad usage, 3 a tool or device is missing, 130 interrupted. */
#ifndef CLI_CLI_H
#define CLI_CLI_H

int cli_advise(int argc, char **argv);
int cli_bilateral(int argc, char **argv);
int cli_bringup(int argc, char **argv);
int cli_identify(int argc, char **argv);
int cli_calibrate(int argc, char **argv);
int cli_calibrate_glove(int argc, char **argv); /* `exhand calibrate --glove` */
int cli_drop(int argc, char **argv);
int cli_glove(int argc, char **argv);
int cli_listen(int argc, char **argv);
int cli_csv(int argc, char **argv);
int cli_run(int argc, char **argv);
int cli_regs(int argc, char **argv);
int cli_watch(int argc, char **argv);
int cli_replay(int argc, char **argv);
int cli_quad(int argc, char **argv);

#endif
