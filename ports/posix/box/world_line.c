/* SPDX-License-Identifier: MIT */
#include "box/world_line.h"

#include "base/key.h"
#include "base/option.h"
#include "box/hand.h"

#include <arpa/inet.h>
#include <inttypes.h>
#include <netdb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

#define SILENT_S 2.0 /* nothing came for so long: it is not there */
#define AGAIN_S  1.0 /* another session is said no sooner: a forger fills no terminal */
#define HOST_B   256

enum presence { AWAITED, ABSENT, THERE, SILENT };

static const char *given; /* by --udp */
static char address[INET_ADDRSTRLEN + 8];
static struct exh_mac_key secret;

static struct {
    enum presence is;
    double since_s; /* the last packet, or the start */
    double anew_s;  /* when another session was said */
    int32_t accepted;
    uint32_t session;
    unsigned long sessions;
    int strangers; /* were said */
} world;

/* --- where it is --- */

static int refuse(const char *text, const char *why)
{
    cli_complain("--udp: %s: %s: give HOST:PORT, such as 127.0.0.1:5758", text, why);
    return 2;
}

/* The first address of a name; numbers are their own. 0, or what stood in the way. */
static int resolve(const char *host, struct in_addr *to)
{
    const struct addrinfo want = {.ai_family = AF_INET, .ai_socktype = SOCK_DGRAM};
    struct addrinfo *found = NULL;
    int err;
    if (inet_pton(AF_INET, host, to) == 1) { return 0; }
    err = getaddrinfo(host, NULL, &want, &found);
    if (err) { return err; }
    *to = ((const struct sockaddr_in *)(const void *)found->ai_addr)->sin_addr;
    freeaddrinfo(found);
    return 0;
}

static int use_key(const char *path, struct posix_line *line)
{
    const int err = path ? key_read(path, &secret) : 0;
    if (path == NULL || err) { return err; }
    line->key = &secret;
    line->key_start = key_start();
    return 0;
}

static int use_address(const char *text, struct posix_line *line)
{
    const char *colon = strrchr(text, ':');
    const size_t len = colon ? (size_t)(colon - text) : 0;
    char host[HOST_B], numbers[INET_ADDRSTRLEN];
    struct in_addr at;
    unsigned long port;
    char *end;
    int err;
    if (len == 0) { return refuse(text, "no host and port"); }
    if (len >= sizeof host) { return refuse(text, "the name is too long"); }
    port = strtoul(colon + 1, &end, 10);
    if (colon[1] < '0' || colon[1] > '9' || *end != '\0' || port < 1 || port > 65535) {
        return refuse(text, "no port from 1 to 65535");
    }
    memcpy(host, text, len);
    host[len] = '\0';
    err = resolve(host, &at);
    if (err) { return refuse(text, gai_strerror(err)); }
    (void)inet_ntop(AF_INET, &at, numbers, sizeof numbers);
    (void)snprintf(address, sizeof address, "%s:%lu", numbers, port);
    given = text;
    line->on = 1;
    line->udp_local = "0.0.0.0:0";
    line->udp_peer = address;
    return 0;
}

int world_line_use(const char *text, const char *key, struct posix_line *line)
{
    int err;
    if (text == NULL && key == NULL) { return 0; }
    if (text == NULL) {
        cli_complain("--key: %s: goes with --udp: a world in this process needs none", key);
        return 2;
    }
    err = use_address(text, line);
    return err ? err : use_key(key, line);
}

/* --- whether it is there --- */

void world_line_start(void)
{
    memset(&world, 0, sizeof world);
    world.anew_s = -AGAIN_S;
}

/* Packets come, and the keys do not fit. */
static const char *misfit(const struct bilateral_box *box)
{
    const struct exh_keyed *k = posix_line_keyed();
    if (k == NULL) { return box->version ? "of another version, or with a key: give --key" : NULL; }
    if (k->other_key) { return "with another key: give both the same file"; }
    if (k->no_key) { return "without a key: start it with --key, or leave --key out here"; }
    return NULL;
}

static void absent(const struct bilateral_box *box)
{
    const int odd = box->corrupt + box->version + box->unknown;
    const char *const keys = misfit(box);
    world.is = ABSENT;
    if (keys) {
        cli_complain("--udp %s: no world answers: packets come %s", given, keys);
        return;
    }
    if (odd) {
        cli_complain("--udp %s: no world answers: %d packets came that no world of this version "
                     "sends: build both of one source",
            given, odd);
        return;
    }
    cli_complain(
        "--udp %s: no world answers: start `world --scene FILE --listen %s` there", given, given);
}

static void came(const struct bilateral_box *box, double now_s)
{
    if (world.is == ABSENT) {
        cli_complain("--udp %s: a world answers, after %.1f s", given, now_s);
    } else if (world.is == SILENT) {
        cli_complain(
            "--udp %s: the world answers again, after %.1f s", given, now_s - world.since_s);
    }
    world.is = THERE;
    world.accepted = box->accepted;
    world.since_s = now_s;
}

static void went(const struct bilateral_box *box, double now_s)
{
    if (world.is == AWAITED) {
        absent(box);
    } else if (world.is == THERE) {
        world.is = SILENT;
        cli_complain("--udp %s: the world has been silent for %.1f s, after %" PRId32
                     " packets: the box goes on",
            given, now_s - world.since_s, box->accepted);
    }
}

/* Detects another process at the same address. */
static void look_who(const struct bilateral_box *box, double now_s)
{
    struct bilateral_cfg *cfg;
    const struct bilateral *s = bilateral_memory(&cfg);
    if (s->wire.rx.session == world.session) { return; }
    world.session = s->wire.rx.session;
    if (world.session == 0) { return; }
    world.sessions++;
    if (world.sessions > 1 && now_s - world.anew_s >= AGAIN_S) {
        cli_complain("--udp %s: the world began anew: its session %lu, after %" PRId32 " packets",
            given, world.sessions, box->accepted);
        world.anew_s = now_s;
    }
}

void world_line_after(const struct bilateral_box *box)
{
    const double now_s = posix_time_s();
    if (given == NULL) { return; }
    if (box->accepted != world.accepted) {
        came(box, now_s);
    } else if (now_s - world.since_s >= SILENT_S) {
        went(box, now_s);
    }
    look_who(box, now_s);
    if (!world.strangers && posix_line_drops().strangers) {
        world.strangers = 1;
        cli_complain(
            "--udp %s: packets of another sender come, too: they are dropped and counted", given);
    }
}

/* --- messages --- */

int world_line_heard(void) { return world.accepted != 0; }

const char *world_line_word(void)
{
    static const char *const word[] = {"", "no world", "", "world silent"};
    return word[world.is];
}

void world_line_print(FILE *f, const struct bilateral_box *box)
{
    const struct exh_keyed *const k = posix_line_keyed();
    const struct posix_line_drops drops = posix_line_drops();
    fprintf(f,
        "world %s: %" PRId32 " packets came, %" PRId32 " missing, %" PRId32
        " refused; %lu sessions; %" PRIu64 " packets of other senders, %" PRIu64
        " of the world's too long or empty\n",
        given, box->accepted, box->missing,
        box->corrupt + box->version + box->unknown + box->stranger + box->far, world.sessions,
        drops.strangers, drops.bad_length);
    if (k == NULL) { return; }
    fprintf(f,
        "key: %" PRIu32 " packets taken; %" PRIu32 " without a key, %" PRIu32
        " of another key, %" PRIu32 " not proved, %" PRIu32 " again, %" PRIu32 " damaged\n",
        k->taken, k->no_key, k->other_key, k->unproved, k->again, k->damaged);
}
