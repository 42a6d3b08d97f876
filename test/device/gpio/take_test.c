/* SPDX-License-Identifier: MIT */
/* The text after --gpio: every way to write it, every way to get it wrong. */
#include "check.h"

#include "gpio.h"

#include <string.h>

TEST(all_fields)
{
    struct gpio_spec s;
    char said[GPIO_SAID_B] = "";
    CHECK_EQ_I64(gpio_take(&s, "gpiochip0:estop=4+8,deadman=5,enable=6,alive=1023", said), 0);
    CHECK(strcmp(s.path, "/dev/gpiochip0") == 0, "%s", s.path);
    CHECK_EQ_I64(s.contacts[GPIO_ESTOP], 2);
    CHECK_EQ_I64(s.contact[GPIO_ESTOP][0], 4);
    CHECK_EQ_I64(s.contact[GPIO_ESTOP][1], 8);
    CHECK_EQ_I64(s.contacts[GPIO_DEADMAN], 1);
    CHECK_EQ_I64(s.contact[GPIO_DEADMAN][0], 5);
    CHECK(s.wired[GPIO_ENABLE] && s.wired[GPIO_ALIVE], "outputs");
    CHECK_EQ_I64(s.output[GPIO_ENABLE], 6);
    CHECK_EQ_I64(s.output[GPIO_ALIVE], 1023);
}

TEST(one_field_and_a_path)
{
    struct gpio_spec s;
    char said[GPIO_SAID_B] = "";
    CHECK_EQ_I64(gpio_take(&s, "/dev/by-name/box:alive=0", said), 0);
    CHECK(strcmp(s.path, "/dev/by-name/box") == 0, "%s", s.path);
    CHECK_EQ_I64(s.contacts[GPIO_ESTOP] + s.contacts[GPIO_DEADMAN], 0);
    CHECK(!s.wired[GPIO_ENABLE] && s.wired[GPIO_ALIVE], "outputs");
    CHECK_EQ_I64(s.output[GPIO_ALIVE], 0);
}

/* Each is refused, and the words have what is wrong in them and an example. */
TEST(what_is_refused)
{
    static const struct {
        const char *text, *says;
    } row[] = {
        {"", "which chip"},
        {":estop=4", "which chip"},
        {"gpiochip0", "no line"},
        {"gpiochip0:", "no line"},
        {"gpiochip0:estop=4,", "an empty field"},
        {"gpiochip0:,estop=4", "an empty field"},
        {"gpiochip0:estopp=4", "estopp=4: there are estop, deadman, enable and alive"},
        {"gpiochip0:esto=4", "esto=4: there are"},
        {"gpiochip0:Estop=4", "there are"},
        {"gpiochip0:estop", "estop: which line"},
        {"gpiochip0:estop=", "a number 0..1023"},
        {"gpiochip0:estop=x", "estop=x: a line is a number 0..1023"},
        {"gpiochip0:estop=-1", "a number"},
        {"gpiochip0:estop=4x", "a number"},
        {"gpiochip0:estop= 4", "a number"},
        {"gpiochip0:estop=1024", "a number 0..1023"},
        {"gpiochip0:estop=99999999999999999999", "a number 0..1023"},
        {"gpiochip0:estop=4+", "estop=4+: a line is a number"},
        {"gpiochip0:estop=+4", "a number"},
        {"gpiochip0:estop=4+4", "line 4 is estop's already"},
        {"gpiochip0:estop=4+5+6", "one contact or two"},
        {"gpiochip0:estop=4,estop=5",
            "estop=5: given twice: two contacts are written as estop=4+8"},
        {"gpiochip0:alive=4,alive=5", "given twice"},
        {"gpiochip0:estop=4,deadman=4", "deadman=4: line 4 is estop's already: every line once"},
        {"gpiochip0:enable=6,alive=6", "alive=6: line 6 is enable's already"},
        {"gpiochip0:deadman=1+7,alive=7", "line 7 is deadman's already"},
        {"gpiochip0:enable=4+5", "only estop and deadman have two contacts"},
        {"a-chip-with-a-name-that-is-longer-than-any-of-a-device-there-can-be:estop=4", "shorter"},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct gpio_spec s;
        char said[GPIO_SAID_B] = "";
        CHECK(gpio_take(&s, row[i].text, said) < 0, "%s: taken", row[i].text);
        CHECK(strstr(said, row[i].says) != NULL, "%s: %s", row[i].text, said);
        CHECK(strstr(said, "e.g. gpiochip0:estop=4,deadman=5,enable=6,alive=7") != NULL, "%s: %s",
            row[i].text, said);
    }
}

/* Bytes of all kinds: taken or refused, never beyond its ends, and what is taken is in range. */
TEST(any_text)
{
    static const char letter[] = "gpiochip0:estop=,deadman+enable=alive0123456789/ \xff";
    while (check_case(1)) {
        struct gpio_spec s;
        char text[120], said[GPIO_SAID_B];
        const size_t len = (size_t)check_i32_in(0, (int32_t)sizeof text - 1);
        for (size_t i = 0; i < len; i++) {
            text[i] = letter[check_i32_in(0, (int32_t)sizeof letter - 2)];
        }
        text[len] = '\0';
        if (check_u64() % 2) { memcpy(text, "c:estop=1+", len < 10 ? len : 10); }
        if (gpio_take(&s, text, said) < 0) {
            CHECK(memchr(said, '\0', sizeof said) != NULL, "words without an end");
            continue;
        }
        for (unsigned c = 0; c < GPIO_CHANNELS; c++) {
            CHECK(s.contacts[c] <= 2, "%s: %u contacts", text, s.contacts[c]);
            for (unsigned k = 0; k < s.contacts[c]; k++) {
                CHECK(s.contact[c][k] <= GPIO_LINE_TOP, "%s", text);
            }
        }
    }
}

TEST_MAIN("gpio-take", all_fields, one_field_and_a_path, what_is_refused, any_text);
