#include "pc104.h"

#include "exhand/board.h"
#include "exhand/exhand.h"

/* The build names the scene of an image as the C name of its descriptor. */
#define TEXT_OF(x) #x
#define TEXT(x)    TEXT_OF(x)
#ifdef EXH_SCENE
#define SCENE_NAME (&TEXT(EXH_SCENE)[sizeof "exh_scene_" - 1])
#else
#define SCENE_NAME "none"
#endif

void pc104_say(const char *text)
{
    for (; *text; text++) {
        if (*text == '\n') { pc104_uart_put('\r'); }
        pc104_uart_put(*text);
    }
}

void pc104_say_u32(uint32_t value)
{
    char digits[11]; /* 2^32-1 has ten */
    unsigned at = sizeof digits - 1;

    digits[at] = 0;
    do {
        digits[--at] = (char)('0' + value % 10);
        value /= 10;
    } while (value);
    pc104_say(&digits[at]);
}

void pc104_say_hex(uint32_t value)
{
    pc104_say("0x");
    for (int shift = 28; shift >= 0; shift -= 4) {
        pc104_uart_put("0123456789abcdef"[value >> shift & 15]);
    }
}

int pc104_same_text(const char *a, const char *b)
{
    while (*a && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

void pc104_say_banner(uint32_t rate_Hz, struct exh_period T)
{
    const uint32_t version[] = {EXH_VERSION_MAJOR, EXH_VERSION_MINOR, EXH_VERSION_PATCH};

    pc104_say("exhand ");
    for (unsigned i = 0; i < 3; i++) {
        pc104_say(i ? "." : "");
        pc104_say_u32(version[i]);
    }
    pc104_say(", board ");
    pc104_say(exh_board_info.name);
    pc104_say(" version ");
    pc104_say_u32(exh_board_info.version);
    pc104_say(", scene ");
    pc104_say(SCENE_NAME);
    pc104_say("\nrate ");
    pc104_say_u32(rate_Hz);
    pc104_say(" Hz asked, period ");
    pc104_say_u32(T.num);
    pc104_say("/");
    pc104_say_u32(T.den);
    pc104_say(" s, ");
    /* at most 1193 of them: the product stays below 2^32 */
    pc104_say_u32(pc104_timer_off_Hz(rate_Hz, T.num) * 1000000u / PC104_PIT_HZ);
    pc104_say(" ppm off\n");
}
