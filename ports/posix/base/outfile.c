/* SPDX-License-Identifier: MIT */
#include "base/outfile.h"

#include "base/option.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#define PATH_B 512

static int path_of(char to[PATH_B], const char *dir, const char *name)
{
    const int n = snprintf(to, PATH_B, "%s/%s", dir, name);
    if (n >= 0 && n < PATH_B) { return 0; }
    cli_complain("--out: %s: too long a path: give a shorter one", dir);
    return 1;
}

int outfile_dir(const char *dir, const char *name)
{
    char path[PATH_B];
    struct stat st;
    if (path_of(path, dir, name)) { return 2; }
    if (mkdir(dir, 0777) != 0 && errno != EEXIST) {
        cli_complain("--out: %s: %s: give a directory that can be made", dir, strerror(errno));
        return 2;
    }
    if (stat(dir, &st) != 0 || !S_ISDIR(st.st_mode)) {
        cli_complain("--out: %s: %s: give a directory", dir, strerror(ENOTDIR));
        return 2;
    }
    return 0;
}

int outfile_write(
    const char *dir, const char *name, void (*write)(FILE *f, const void *ctx), const void *ctx)
{
    char path[PATH_B];
    FILE *f;
    int failed;
    if (path_of(path, dir, name)) { return 1; }
    errno = 0;
    f = fopen(path, "wb");
    if (f != NULL) { write(f, ctx); }
    failed = f == NULL || fflush(f) != 0 || ferror(f);
    if (failed) {
        cli_complain(
            "%s: can't be written: %s: make room or give another --out, and calibrate again", path,
            strerror(errno ? errno : EIO));
    }
    if (f != NULL && fclose(f) != 0 && !failed) {
        cli_complain("%s: can't be closed: %s: give another --out, and calibrate again", path,
            strerror(errno));
        failed = 1;
    }
    return failed;
}

long outfile_read(
    const char *option, const char *path, const char *expected, void *to, size_t cap_B)
{
    FILE *f = fopen(path, "rb");
    long len;
    if (f == NULL) {
        cli_complain("--%s: %s: %s: give the %s", option, path, strerror(errno), expected);
        return -3;
    }
    len = (long)fread(to, 1, cap_B, f);
    if (ferror(f)) { /* a directory, as a rule */
        cli_complain(
            "--%s: %s: can't be read: %s: give the %s", option, path, strerror(errno), expected);
        len = -2;
    }
    fclose(f);
    return len;
}
