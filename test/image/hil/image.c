/* SPDX-License-Identifier: MIT */
/* The ELF file: what is loaded where, and where its functions are. */
#include "image.h"

#include "hil.h"

#include <elf.h>
#include <stdlib.h>
#include <string.h>

struct file {
    uint8_t *at;
    size_t size;
};

static struct file read_file(const char *path)
{
    struct file f = {NULL, 0};
    FILE *in = fopen(path, "rb");
    long end;
    if (in && fseek(in, 0, SEEK_END) == 0 && (end = ftell(in)) > 0) {
        rewind(in);
        f.at = malloc((size_t)end);
        if (f.at) { f.size = fread(f.at, 1, (size_t)end, in); }
    }
    if (in) { fclose(in); }
    return f;
}

static int inside(const struct file *f, uint64_t from, uint64_t n)
{
    return from <= f->size && n <= f->size - from;
}

/* The header, if it is a 32-bit program for one of our processors. */
static int header_of(const struct file *f, Elf32_Ehdr *e)
{
    if (!inside(f, 0, sizeof *e)) { return -1; }
    memcpy(e, f->at, sizeof *e);
    if (memcmp(e->e_ident, ELFMAG, SELFMAG) != 0 || e->e_ident[EI_CLASS] != ELFCLASS32 ||
        (e->e_machine != EM_386 && e->e_machine != EM_ARM) ||
        e->e_phentsize != sizeof(Elf32_Phdr) ||
        !inside(f, e->e_phoff, (uint64_t)e->e_phnum * sizeof(Elf32_Phdr))) {
        return -1;
    }
    return 0;
}

/* clears: bytes that the file does not have are 0. In flash they stay unchanged. */
static int load_segments(
    const struct file *f, const Elf32_Ehdr *e, image_place_fn *place, void *ctx, int clears)
{
    for (unsigned i = 0; i < e->e_phnum; i++) {
        Elf32_Phdr p;
        uint8_t *to;
        memcpy(&p, f->at + e->e_phoff + i * sizeof p, sizeof p);
        if (p.p_type != PT_LOAD) { continue; }
        to = place(ctx, p.p_paddr, clears ? p.p_memsz : p.p_filesz);
        if (!inside(f, p.p_offset, p.p_filesz) || p.p_filesz > p.p_memsz || to == NULL) {
            return -1;
        }
        memcpy(to, f->at + p.p_offset, p.p_filesz);
        if (clears) { memset(to + p.p_filesz, 0, p.p_memsz - p.p_filesz); }
    }
    return 0;
}

int image_load(
    const char *path, unsigned machine, image_place_fn *place, void *ctx, uint32_t *entry)
{
    struct file f = read_file(path);
    Elf32_Ehdr e;
    int err = f.at == NULL ? -1 : header_of(&f, &e);
    if (err == 0 && e.e_machine != machine) { err = -1; }
    if (err == 0) { err = load_segments(&f, &e, place, ctx, machine == EM_386); }
    if (err == 0) { *entry = e.e_entry; }
    free(f.at);
    return err;
}

static uint8_t *in_ram(void *ctx, uint32_t at, uint32_t n)
{
    const struct hil *h = ctx;
    return (uint64_t)at + n > HIL_RAM_B ? NULL : &h->ram[at];
}

int hil_load(struct hil *h, const char *path)
{
    const int err = image_load(path, EM_386, in_ram, h, &h->entry);
    if (err < 0) { fprintf(stderr, "hil: %s: not a 32-bit x86 image that fits\n", path); }
    return err;
}

/* "name*" is the beginning of it. */
static int is_called(const char *symbol, const char *name)
{
    const size_t n = strcspn(name, "*");
    return name[n] ? strncmp(symbol, name, n) == 0 : strcmp(symbol, name) == 0;
}

/* In the symbol table that section s is. */
static uint32_t find(const struct file *f, const Elf32_Shdr *s, const Elf32_Shdr *names,
    const char *name, char *found, size_t cap_B)
{
    for (uint32_t at = 0; at + sizeof(Elf32_Sym) <= s->sh_size; at += (uint32_t)sizeof(Elf32_Sym)) {
        Elf32_Sym sym;
        memcpy(&sym, f->at + s->sh_offset + at, sizeof sym);
        if (sym.st_name < names->sh_size &&
            is_called((const char *)f->at + names->sh_offset + sym.st_name, name)) {
            snprintf(found, cap_B, "%s", (const char *)f->at + names->sh_offset + sym.st_name);
            return sym.st_value;
        }
    }
    return 0;
}

static int section(const struct file *f, const Elf32_Ehdr *e, uint32_t i, Elf32_Shdr *s)
{
    const uint64_t at = e->e_shoff + (uint64_t)i * sizeof *s;
    if (i >= e->e_shnum || e->e_shentsize != sizeof *s || !inside(f, at, sizeof *s)) { return -1; }
    memcpy(s, f->at + at, sizeof *s);
    if (!inside(f, s->sh_offset, s->sh_type == SHT_NOBITS ? 0 : s->sh_size)) { return -1; }
    return s->sh_type == SHT_STRTAB && f->at[s->sh_offset + s->sh_size - 1] != 0 ? -1 : 0;
}

uint32_t hil_symbol_name(const char *path, char *name, size_t cap_B)
{
    char wanted[64];
    struct file f = read_file(path);
    Elf32_Ehdr e;
    Elf32_Shdr s, names;
    uint32_t value = 0;
    snprintf(wanted, sizeof wanted, "%s", name);
    if (f.at && header_of(&f, &e) == 0) {
        for (uint32_t i = 0; i < e.e_shnum && value == 0; i++) {
            if (section(&f, &e, i, &s) == 0 && s.sh_type == SHT_SYMTAB &&
                section(&f, &e, s.sh_link, &names) == 0) {
                value = find(&f, &s, &names, wanted, name, cap_B);
            }
        }
    }
    free(f.at);
    return value;
}

uint32_t hil_symbol(const char *path, const char *name)
{
    char text[64];
    snprintf(text, sizeof text, "%s", name);
    return hil_symbol_name(path, text, sizeof text);
}
