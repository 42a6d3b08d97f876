/* SPDX-License-Identifier: MIT */
/* Real-time operation. The exchange has a separate thread, so that a slow picture delays no plane.
 * Each picture shows the newest exchange and skips the others. */
#include "run.h"

#include "link.h"
#include "picture.h"
#include "solo.h"
#include "view.h"

#include "bilateral/bilateral.h"
#include "base/ends.h"
#include "base/key.h"
#include "base/option.h"
#include "base/outfile.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define LINK_LOST_US 1000000

struct live {
    struct run *run;
    struct link link;
    int has_link;
    pthread_mutex_t lock; /* of all below */
    struct draw_moment newest;
    unsigned long exchanges;
    struct solo keys; /* where they want the fingers */
    struct v3 carried;
    int paused, restart, carry, ended, left;
    struct world_stats stats;
};

static volatile sig_atomic_t stopped;

static void stop(int signal)
{
    ends_note(signal);
    stopped = 1;
}

static int64_t now_us(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000 + t.tv_nsec / 1000;
}

static void sleep_till(int64_t us)
{
    const struct timespec t = {(time_t)(us / 1000000), (long)(us % 1000000) * 1000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL) != 0 && !stopped) {}
}

/* --- the exchange --- */

/* State from frame to frame that only the exchange uses. */
struct exchange {
    struct draw_moment m;
    struct solo solo;
    struct pace pace;
    int64_t state_us, began_us, frame_us;
    unsigned long done;
};

static void take_wishes(struct live *l, struct exchange *x)
{
    pthread_mutex_lock(&l->lock);
    memcpy(x->solo.want, l->keys.want, sizeof x->solo.want);
    x->m.paused = l->paused;
    if (l->restart) { x->m.t_s = 0; }
    l->restart = 0;
    if (l->carry) { world_carry(l->run->world, l->carried); }
    l->carry = 0;
    pthread_mutex_unlock(&l->lock);
}

static void one_exchange(struct live *l, struct exchange *x, double dt_s)
{
    const int64_t now = now_us();
    take_wishes(l, x);
    if (!x->m.paused) { x->m.t_s += dt_s; }
    if (l->has_link && link_receive(&l->link, &x->m.in, now)) {
        x->state_us = now;
        pace_pull(&x->pace, &l->link.theirs);
        pace_take(&x->pace, &x->m.in, l->link.echo_stamp_us);
    }
    x->m.linked = x->state_us && now - x->state_us < LINK_LOST_US;
    x->m.age_ms = x->state_us ? (double)(now - x->state_us) / 1000 : -1;
    x->m.lost = l->link.rx.missing;
    if (!x->m.linked) {
        if (l->run->script) { solo_script(&x->solo, x->m.t_s); }
        solo_step(&x->solo, l->run->world, &x->m.out, dt_s, &x->m.in);
        pace_take(&x->pace, &x->m.in, (uint32_t)now);
    }
    x->m.hand = world_hand_at(l->run->world, x->m.t_s);
    world_frame(l->run->world, &x->m.in, &x->pace, x->m.t_s, &x->m.out, &l->stats);
    /* The world's own hand is not the controller's: its planes would be felt where nothing is. */
    if (l->has_link) { link_answer(&l->link, x->m.linked ? &x->m.out : NULL, now_us()); }
    x->done++;
    if (now - x->began_us >= 500000) {
        x->m.fps = (double)x->done * 1e6 / (double)(now - x->began_us);
        x->began_us = now;
        x->done = 0;
    }
    pthread_mutex_lock(&l->lock);
    l->newest = x->m;
    l->exchanges++;
    pthread_mutex_unlock(&l->lock);
}

static int over(struct live *l, unsigned long n, int64_t since_us)
{
    const struct run *r = l->run;
    int left;
    pthread_mutex_lock(&l->lock);
    left = l->left;
    pthread_mutex_unlock(&l->lock);
    return stopped || left || (r->frames && n >= (unsigned long)r->frames) ||
           (r->seconds > 0 && (double)(now_us() - since_us) >= 1e6 * r->seconds);
}

static void *exchanges(void *arg)
{
    struct live *l = arg;
    struct exchange x;
    const int64_t start = now_us();
    const double period_us = 1e6 / l->run->fps;
    int64_t origin = start;
    memset(&x, 0, sizeof x);
    x.began_us = start;
    x.m.trip_ms = -1;
    for (unsigned long n = 0, k = 0; !over(l, n, start); n++) {
        one_exchange(l, &x, 1 / l->run->fps);
        k++;
        if (now_us() > origin + (int64_t)((double)(k + 4) * period_us)) {
            origin = now_us(); /* far behind: those frames are not made up for */
            k = 0;
        }
        sleep_till(origin + (int64_t)((double)k * period_us));
    }
    pthread_mutex_lock(&l->lock);
    l->ended = 1;
    pthread_mutex_unlock(&l->lock);
    return NULL;
}

/* --- the picture --- */

struct looking {
    struct picture *picture;
    struct view view;
    struct draw_list list;
    int help;
    int64_t began_us;
    unsigned long drawn, seen;
    double fps;
};

static void bend(struct live *l, int key)
{
    const int shifted = key & KEY_SHIFT, k = key & 127;
    for (int f = 0; f < FINGERS; f++) {
        if (k == '0' || k == '1' + f) {
            l->keys.want[f] = fmin(fmax(l->keys.want[f] + (shifted ? -0.08 : 0.08), 0), 1);
        }
    }
}

static void carry(struct live *l, struct v3 by)
{
    l->carried = v3_add(l->carried, by);
    l->carry = 1;
}

/* 1: leave. Holds the lock. */
static int pressed(struct live *l, struct looking *v, int key)
{
    const double step = 0.004;
    switch (key) {
    case KEY_QUIT:
    case 'q': return 1;
    case KEY_LEFT: view_turn(&v->view, -0.06, 0); break;
    case KEY_RIGHT: view_turn(&v->view, 0.06, 0); break;
    case KEY_UP: view_turn(&v->view, 0, 0.06); break;
    case KEY_DOWN: view_turn(&v->view, 0, -0.06); break;
    case '+':
    case '=':
    case '=' | KEY_SHIFT: view_nearer(&v->view, 1); break;
    case '-': view_nearer(&v->view, -1); break;
    case 'h': v->help = !v->help; break;
    case ' ': l->paused = !l->paused; break;
    case 'b':
        l->restart = l->carry = 1;
        l->carried = v3(0, 0, 0);
        memset(l->keys.want, 0, sizeof l->keys.want);
        break;
    case 'w': carry(l, v3(0, step, 0)); break;
    case 's': carry(l, v3(0, -step, 0)); break;
    case 'a': carry(l, v3(-step, 0, 0)); break;
    case 'd': carry(l, v3(step, 0, 0)); break;
    case 'r': carry(l, v3(0, 0, step)); break;
    case 'f': carry(l, v3(0, 0, -step)); break;
    default: bend(l, key);
    }
    return 0;
}

static int take_keys(struct live *l, struct looking *v)
{
    struct picture_drag drag = {0, 0, 0};
    int key, leave = 0;
    pthread_mutex_lock(&l->lock);
    while ((key = picture_key(v->picture, &drag)) != 0) { leave |= pressed(l, v, key); }
    pthread_mutex_unlock(&l->lock);
    view_turn(&v->view, -0.006 * drag.turn, 0.006 * drag.tilt);
    view_nearer(&v->view, drag.nearer);
    return leave;
}

/* Draws the newest exchange if there is one that was not drawn; 1 when all is over. */
static int look(struct live *l, struct looking *v)
{
    struct draw_moment m;
    int ended, news;
    const int64_t now = now_us();
    pthread_mutex_lock(&l->lock);
    m = l->newest;
    m.skipped = l->exchanges - v->seen;
    news = m.skipped > 0;
    v->seen = l->exchanges;
    ended = l->ended;
    m.help = v->help;
    m.picture_fps = v->fps;
    m.eye = view_eye(&v->view);
    m.look = v->view.look;
    pthread_mutex_unlock(&l->lock);
    if (news) {
        world_draw(l->run->world, &m, &v->list);
        picture_paint(v->picture, &v->list);
        picture_show(v->picture);
        v->drawn++;
    } else if (!ended) {
        sleep_till(now + 500);
    }
    if (now - v->began_us >= 500000) {
        v->fps = (double)v->drawn * 1e6 / (double)(now - v->began_us);
        v->began_us = now;
        v->drawn = 0;
    }
    return ended;
}

static void leave(struct live *l)
{
    pthread_mutex_lock(&l->lock);
    l->left = 1;
    pthread_mutex_unlock(&l->lock);
}

static int leave_list(const struct draw_list *list, const char *path)
{
    FILE *f = outfile_open("list", path);
    if (f == NULL) { return 1; }
    draw_write(f, list);
    return outfile_close(f);
}

static int watch(struct live *l)
{
    const struct run *r = l->run;
    const struct picture_want want = {
        world_scene(r->world)->title, (int)r->width, (int)r->height, r->headless, (int)r->samples};
    struct looking v;
    char why[600];
    int bad = 0;
    memset(&v, 0, sizeof v);
    v.help = 0;
    v.began_us = now_us();
    view_start(&v.view, world_scene(r->world));
    v.picture = picture_open(&want, why, sizeof why);
    if (v.picture == NULL) {
        cli_complain("%s", why);
        return 3;
    }
    while (!look(l, &v)) {
        if (take_keys(l, &v)) { leave(l); }
    }
    if (r->png) { bad = picture_save(v.picture, &v.list, "png", r->png); }
    bad |= r->list && leave_list(&v.list, r->list);
    picture_close(v.picture);
    draw_free(&v.list);
    return bad;
}

static void report(const struct live *l)
{
    const struct world_stats *s = &l->stats;
    const struct exh_wire_rx *rx = &l->link.rx;
    printf("frames %lu  looks %lu  hits %lu", s->frames, s->looks, s->hits);
    if (l->has_link) {
        printf("  sent %lu  taken %lu  lost %lu  late %lu  twice %lu  bad %lu  refused %lu",
            l->link.sent, (unsigned long)rx->accepted, (unsigned long)rx->missing,
            (unsigned long)rx->reordered + rx->old, (unsigned long)rx->duplicate,
            (unsigned long)rx->corrupt + rx->version + rx->unknown + rx->stranger + rx->far,
            l->link.refused);
    }
    if (l->link.has_key) {
        const struct exh_keyed *const k = &l->link.keyed;
        printf("  no key %lu  another key %lu  not proved %lu  again %lu  damaged %lu",
            (unsigned long)k->no_key, (unsigned long)k->other_key, (unsigned long)k->unproved,
            (unsigned long)k->again, (unsigned long)k->damaged);
    }
    putchar('\n');
}

static int go(struct live *l)
{
    pthread_t thread;
    int status = 0;
    if (pthread_create(&thread, NULL, exchanges, l) != 0) {
        cli_complain("no thread can be made: end some other programs");
        return 3;
    }
    if (!l->run->headless || l->run->png) { status = watch(l); }
    if (status) { leave(l); }
    pthread_join(thread, NULL);
    report(l);
    return status;
}

static void complain(const char *text) { cli_complain("%s", text); }

static int use_key(const struct run *r, struct link *l)
{
    struct exh_mac_key key;
    const int err = r->key ? key_read(r->key, &key) : 0;
    if (err) { link_close(l); }
    if (r->key && !err) { link_key(l, &key, key_start()); }
    return err;
}

static int open_trace(const struct run *r, struct link *l)
{
    const struct link_trace_want want = {
        &bilateral_outputs, r->trace, r->trace_signals, (uint32_t)r->trace_every};
    char why[300];
    const int bad = r->trace ? link_trace_open(l, &want, why, sizeof why) : 0;
    if (bad && why[0]) { cli_complain("%s", why); }
    if (bad) { link_close(l); }
    return bad;
}

int run_live(struct run *r)
{
    const struct outfile_option leaves[] = {
        {"trace", r->trace}, {"png", r->png}, {"list", r->list}};
    static struct live l;
    struct sigaction on;
    char why[300];
    int status;
    memset(&on, 0, sizeof on);
    on.sa_handler = stop;
    sigaction(SIGINT, &on, NULL);
    sigaction(SIGTERM, &on, NULL);
    l.run = r;
    status = outfile_try(leaves, sizeof leaves / sizeof leaves[0]);
    if (status) { return status; }
    if (r->listen || r->peer) {
        const uint32_t session = (uint32_t)now_us() ^ (uint32_t)getpid() << 20;
        if (link_open(&l.link, r->listen, r->peer, session, why, sizeof why)) {
            cli_complain("%s", why);
            return 2;
        }
        l.has_link = 1;
        l.link.say = complain;
        l.link.table_crc = exh_signal_crc(&bilateral_params);
        link_materials(&l.link, world_scene(r->world));
        status = use_key(r, &l.link);
        if (status == 0) { status = open_trace(r, &l.link); }
        if (status) { return status; }
    }
    pthread_mutex_init(&l.lock, NULL);
    status = go(&l);
    if (link_trace_close(&l.link) && status == 0) { status = 1; }
    pthread_mutex_destroy(&l.lock);
    if (l.has_link) { link_close(&l.link); }
    return status == 0 && stopped ? 130 : status;
}
