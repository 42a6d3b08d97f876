/* SPDX-License-Identifier: MIT */
/* exhand run --modbus: where it serves, also over a serial line, and what it says where it cannot.
 */
#define _XOPEN_SOURCE 700

#include "modbus_rig.h"

#ifdef EXH_MODBUS

#include <fcntl.h>

/* A serial line is a pseudo-terminal: the box has one end, a libmodbus client the other. */
TEST(over_a_serial_line)
{
    char *dir = said_dir();
    char where[128];
    const int fd = posix_openpt(O_RDWR | O_NOCTTY);
    modbus_t *c = modbus_new_rtu("/dev/null", 115200, 'E', 8, 1);
    uint16_t word[6] = {0};
    struct said s;
    pid_t pid;
    if (fd < 0 || grantpt(fd) != 0 || unlockpt(fd) != 0) {
        check_note("no pseudo-terminal here (%s): not tried over a serial line", strerror(errno));
        if (fd >= 0) { close(fd); }
        modbus_free(c);
        said_clean(dir);
        return;
    }
    snprintf(where, sizeof where, "rtu:%s:115200", ptsname(fd));
    pid = said_start(dir, cli_run, WORDS("run", "--pace", "--modbus", where, "--modbus-write"));
    for (int i = 0; i < 100 * RIG_PATIENCE_S && said_size(said_path(dir, "said.out")) <= 0; i++) {
        rig_sleep(0.01);
    }
    modbus_set_slave(c, 1);
    modbus_set_socket(c, fd);
    modbus_set_response_timeout(c, RIG_PATIENCE_S, 0);
    for (int i = 0; i < 50; i++) {
        CHECK(modbus_read_input_registers(c, 0, 6, word) == 6, "%s", modbus_strerror(errno));
        CHECK_EQ_I64(rig_value(word, 2), 0x12345678);
    }
    CHECK(modbus_read_input_registers(c, 0x0FFF, 2, word) == -1 && errno == EMBXILADD,
        "no exception 2");
    CHECK(modbus_write_register(c, 0x5001, 1) == -1 && errno == EMBXILVAL,
        "no exception 3: step is of the set-up");
    for (int i = 0; i < 2; i++) { /* functions without data: the shortest requests there are */
        const uint8_t shortest[2] = {1, i == 0 ? 7 : 17};
        uint8_t answer[MODBUS_RTU_MAX_ADU_LENGTH] = {0};
        CHECK(modbus_send_raw_request(c, shortest, 2) == 4, "%s", modbus_strerror(errno));
        CHECK(modbus_receive_confirmation(c, answer) == 5 && answer[1] == (shortest[1] | 0x80) &&
                  answer[2] == EXH_MODBUS_FUNCTION,
            "function %d: %d %d %s", shortest[1], answer[1], answer[2], modbus_strerror(errno));
    }
    modbus_set_slave(c, 2); /* another slave */
    modbus_set_response_timeout(c, 0, 100000);
    CHECK(modbus_read_input_registers(c, 0, 6, word) == -1 && errno == ETIMEDOUT,
        "answered for another");
    rig_sleep(
        0.6); /* libmodbus waits so long for the other's answer, and takes any answer for it */
    modbus_set_slave(c, 0); /* all: done, not answered */
    CHECK(modbus_write_bit(c, EXH_COIL_OFF, 1) == -1 && errno == ETIMEDOUT, "answered to all");
    modbus_set_slave(c, 1);
    modbus_set_response_timeout(c, RIG_PATIENCE_S, 0);
    CHECK(modbus_read_input_registers(c, (int)RIG_HEAD(EXH_HEAD_DONE), 2, word) == 2, "%s",
        modbus_strerror(errno));
    CHECK_EQ_I64(rig_value(word, 0), 1);
    kill(pid, SIGINT);
    said_end(&s, dir, pid);
    CHECK(s.status == 130, "%d %s", s.status, s.err);
    modbus_free(c);
    close(fd);
    said_clean(dir);
}

TEST(what_cannot_be_served_is_named)
{
    static const struct {
        const char *where, *said;
        int status;
    } row[] = {{"udp:1.2.3.4:5", "give tcp:ADDRESS:PORT", 2},
        {"tcp:here:1502", "give tcp:ADDRESS:PORT", 2},
        {"tcp:127.0.0.1:65536", "give tcp:ADDRESS:PORT", 2},
        {"tcp:192.0.2.1:1502", "an address of this machine", 3},
        {"rtu:/dev/nowhere:115200", "a serial line that is here", 3},
        {"rtu:/dev/null:12", "give tcp:ADDRESS:PORT", 2}};
    char *dir = said_dir();
    char where[64];
    struct said s;
    struct rig r;
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        said(&s, dir, cli_run, WORDS("run", "--seconds", "1", "--modbus", row[i].where));
        CHECK(s.status == row[i].status && strstr(s.err, row[i].said), "%s: %d %s", row[i].where,
            s.status, s.err);
    }
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    snprintf(where, sizeof where, "tcp:127.0.0.1:%d", r.port);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "1", "--modbus", where));
    CHECK(s.status == 3 && strstr(s.err, "another program serves there"), "%d %s", s.status, s.err);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "1", "--save", "x"));
    CHECK_EQ_I64(s.status, 2);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "1", "--modbus-write"));
    CHECK(s.status == 2 && strstr(s.err, "only with --modbus"), "%d %s", s.status, s.err);
    said(&s, dir, cli_run,
        WORDS("run", "--seconds", "1", "--modbus", "tcp:127.0.0.1:0", "--save", "x"));
    CHECK(s.status == 2 && strstr(s.err, "give --modbus-write"), "%d %s", s.status, s.err);
    rig_end(&r, 130);
    said_clean(r.dir);
    said_clean(dir);
}

TEST_MAIN("modbus", over_a_serial_line, what_cannot_be_served_is_named);
#else
TEST(without_the_package_it_says_so)
{
    char *dir = said_dir();
    struct said s;
    said(&s, dir, cli_run, WORDS("run", "--modbus", "tcp:127.0.0.1:0"));
    CHECK_EQ_I64(s.status, 3);
    CHECK(strstr(s.err, "install libmodbus-dev") != NULL, "%s", s.err);
    check_note("libmodbus is not here: nothing else was tested");
    said_clean(dir);
}

TEST_MAIN("modbus", without_the_package_it_says_so);
#endif
