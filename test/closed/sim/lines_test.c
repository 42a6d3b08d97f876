/* SPDX-License-Identifier: MIT */
/* What messages quote of a file, a terminal shows and does not obey. */
#include "glove_said.h"

#include "base/cli.h"
#include "base/lines.h"

static struct said s;

TEST(what_a_terminal_obeys_is_escaped)
{
    static const struct {
        const char *from, *to;
    } row[] = {
        {"", ""},
        {"plain, \"text\" ~", "plain, \"text\" ~"},
        {"\x1b[2J", "\\x1b[2J"},
        {"a\tb\r\n\x07\x7f", "a\\x09b\\x0d\\x0a\\x07\\x7f"},
        {"M\xC3\xBCller \xE2\x82\xAC \xF0\x9F\x98\x80",
            "M\xC3\xBCller \xE2\x82\xAC \xF0\x9F\x98\x80"},
        {"\x80\x9b", "\\x80\\x9b"},
        {"\xC2\x9b"
         "2J \xC2\xA0",
            "\\xc2\\x9b2J \xC2\xA0"}, /* the same in UTF-8, and one that is none */
        {"\xC3", "\\xc3"},
        {"\xE2\x82", "\\xe2\\x82"},
        {"\xC0\x9b\xF5\xFF", "\\xc0\\x9b\\xf5\\xff"},
    };
    char to[200];
    for (size_t i = 0; i < LEN(row); i++) {
        lines_plain(to, sizeof to, row[i].from);
        CHECK(strcmp(to, row[i].to) == 0, "%zu: %s", i, to);
    }
    memset(to, 'x', sizeof to);
    lines_plain(to, 6, "\x01\x02"); /* no half of one */
    CHECK(strcmp(to, "\\x01") == 0 && to[5] == 'x', "%.9s", to);
    lines_plain(to, 4, "\xE2\x82\xAC\xE2\x82\xAC");
    CHECK(strcmp(to, "\xE2\x82\xAC") == 0, "%s", to);
}

/* One line for one message: of visible characters and whole ones of UTF-8. */
static void check_words(const char *what, unsigned n)
{
    size_t at = 0;
    CHECK(s.status == 2 || s.status == 3, "%s %u: %d", what, n, s.status);
    for (; s.err[at] != '\0'; at++) {
        const unsigned char c = (unsigned char)s.err[at], next = (unsigned char)s.err[at + 1];
        CHECK(c == '\n' ? next == '\0' || next == 'e' : c >= ' ' && c != 0x7F, "%s %u: byte %zu",
            what, n, at);
        CHECK(c < 0x80 || c > 0xC1 || (at > 0 && (s.err[at - 1] & 0x80)), "%s %u: byte %zu", what,
            n, at);
    }
    CHECK(at > 10, "%s %u: no word", what, n);
}

/* Every reader of files gets a file of any bytes. */
TEST(no_byte_of_a_file_reaches_the_terminal)
{
    char *dir = said_dir();
    char *file = strdup(said_path(dir, "bytes"));
    uint32_t random = 1;
    for (unsigned n = 0; n < 30; n++) {
        FILE *f = fopen(file, "wb");
        CHECK(f != NULL, "%s", file);
        for (int i = 0; i < 3000; i++) {
            random = random * 1664525u + 1013904223u;
            (void)putc(i % 40 == 39 ? ',' : (int)(random >> 24), f);
        }
        CHECK_EQ_I64(fclose(f), 0);
        said(&s, dir, cli_glove, WORDS("glove", "--csv", file, "--rate", "200"));
        check_words("glove --csv", n);
        said(&s, dir, cli_glove,
            WORDS("glove", "--csv", file, "--rate", "200", "--columns", "1-22"));
        check_words("glove --columns", n);
        said(&s, dir, cli_calibrate, WORDS("calibrate", "--glove", "--poses", file, "--out", dir));
        check_words("calibrate --poses", n);
        said(&s, dir, cli_bilateral, WORDS("bilateral", "--record", file));
        check_words("bilateral --record", n);
    }
    free(file);
    said_clean(dir);
}

TEST_MAIN("sim/lines", what_a_terminal_obeys_is_escaped, no_byte_of_a_file_reaches_the_terminal);
