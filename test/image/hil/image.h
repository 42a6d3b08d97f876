/* SPDX-License-Identifier: MIT */
/* The ELF file of an image, for whichever processor. */
#ifndef IMAGE_H
#define IMAGE_H

#include <stddef.h>
#include <stdint.h>

/* Where n bytes of the file's address go, or NULL: nowhere. */
typedef uint8_t *image_place_fn(void *ctx, uint32_t at, uint32_t n);
/* 0, or -1: no program for this processor (EM_... of elf.h) that fits. */
int image_load(
    const char *path, unsigned machine, image_place_fn *place, void *ctx, uint32_t *entry);
/* Address of a symbol, or 0. "name*": of the first that begins so; its name replaces that. */
uint32_t hil_symbol_name(const char *path, char *name, size_t cap_B);
uint32_t hil_symbol(const char *path, const char *name);

#endif
