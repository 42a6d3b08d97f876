/* SPDX-License-Identifier: MIT */
/* Of libgpiod 1.6's names those that gpio_v1.c uses, for a machine without the package. */
#ifndef TEST_GPIO_V1_GPIOD_H
#define TEST_GPIO_V1_GPIOD_H

#include <stdbool.h>

struct gpiod_chip;
struct gpiod_line;
struct gpiod_line_bulk {
    struct gpiod_line *lines[64];
    unsigned int num_lines;
};
struct gpiod_line_request_config {
    const char *consumer;
    int request_type;
    int flags;
};
enum { GPIOD_LINE_REQUEST_DIRECTION_INPUT = 1, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT = 2 };
enum { GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN = 1 << 4 };

struct gpiod_chip *gpiod_chip_open(const char *path);
void gpiod_chip_close(struct gpiod_chip *chip);
unsigned int gpiod_chip_num_lines(struct gpiod_chip *chip);
struct gpiod_line *gpiod_chip_get_line(struct gpiod_chip *chip, unsigned int offset);
int gpiod_line_update(struct gpiod_line *line);
bool gpiod_line_is_used(struct gpiod_line *line);
const char *gpiod_line_consumer(struct gpiod_line *line);
unsigned int gpiod_line_offset(struct gpiod_line *line);
void gpiod_line_bulk_init(struct gpiod_line_bulk *bulk);
void gpiod_line_bulk_add(struct gpiod_line_bulk *bulk, struct gpiod_line *line);
int gpiod_line_request_bulk(struct gpiod_line_bulk *bulk,
    const struct gpiod_line_request_config *config, const int *default_vals);
void gpiod_line_release_bulk(struct gpiod_line_bulk *bulk);
int gpiod_line_get_value_bulk(struct gpiod_line_bulk *bulk, int *values);
int gpiod_line_set_value_bulk(struct gpiod_line_bulk *bulk, const int *values);

#endif
