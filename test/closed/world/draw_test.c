/* SPDX-License-Identifier: MIT */
/* The draw list: what is to be seen, and how high the bars are. */
#include "check.h"

#include "world/draw.h"

static const char text[] =
    "hand at 0 0 0.1\nmaterial m fmax 10\nplane table at 0 0 0.02 material m\n"
    "sphere ball at 0.2 0 0 radius 0.03 material m\n";

static struct world *w;
static struct draw_moment m;
static struct draw_list l;

static void begin(unsigned fingers)
{
    char why[700];
    w = world_load("t", text, why, sizeof why);
    CHECK(w != NULL, "%s", why);
    memset(&m, 0, sizeof m);
    m.in.fingers = (uint8_t)fingers;
    m.hand = world_hand_at(w, 0);
    m.trip_ms = -1;
    world_frame(w, &m.in, NULL, 0, &m.out, NULL);
    for (int f = 0; f < FINGERS; f++) {
        struct finger at;
        finger_at(&at, world_hand(w), (unsigned)f, m.in.joint_turn_q32[f]);
        m.in.tip_m_q30[f][0] = (int32_t)(at.tip.x * 0x1p30);
        m.in.tip_m_q30[f][1] = (int32_t)(at.tip.y * 0x1p30);
        m.in.tip_m_q30[f][2] = (int32_t)(at.tip.z * 0x1p30);
    }
}

static void end(void)
{
    world_free(w);
    draw_free(&l);
}

static const struct draw_item *find(enum draw_what what, int which, int *count)
{
    const struct draw_item *found = NULL;
    *count = 0;
    for (int i = 0; i < l.items; i++) {
        if (l.item[i].what == what && l.item[i].which == which) {
            found = &l.item[i];
            *count += 1;
        }
    }
    return found;
}

static int said(const char *what)
{
    for (int i = 0; i < l.texts; i++) {
        if (strstr(l.text[i].text, what)) { return 1; }
    }
    return 0;
}

TEST(a_bar_is_6_mm_high_for_each_newton_along_the_normal)
{
    int n;
    begin(31);
    for (int f = 0; f < FINGERS; f++) { m.in.force_N_q20[f] = (f * 5 << 20) / 2; }
    world_draw(w, &m, &l);
    CHECK(find(DRAW_BAR, 4, &n) == NULL, "a bar without a contact");
    m.in.touching = 31;
    world_draw(w, &m, &l);
    CHECK(find(DRAW_BAR, 0, &n) == NULL, "a bar without a force");
    for (int f = 1; f < FINGERS; f++) {
        const struct draw_item *bar = find(DRAW_BAR, f, &n), *rest = find(DRAW_BAR_SCALE, f, &n);
        const double force = f * 2.5;
        CHECK(bar != NULL, "no bar");
        CHECK(fabs(2 * bar->size.z - force * DRAW_BAR_M_PER_N) < 1e-12, "%g m for %g N",
            2 * bar->size.z, force);
        CHECK(bar->colour[0] > 0.9F && bar->colour[1] < 0.1F && bar->colour[2] < 0.1F, "not red");
        CHECK(bar->at.turn.z.z > 0.9, "the palm looks down: bars stand up");
        CHECK((rest != NULL) == (force < 10), "the rest up to f_max");
        if (rest) {
            CHECK(fabs(2 * rest->size.z - (10 - force) * DRAW_BAR_M_PER_N) < 1e-12, "%g",
                rest->size.z);
        }
    }
    end();
}

TEST(a_disc_lies_where_the_pad_will_touch_and_tells_the_state)
{
    int n;
    begin(31);
    m.in.frozen = 1 << 2 | 1 << 3;
    m.in.touching = 1 << 3;
    world_draw(w, &m, &l);
    for (int f = 1; f < FINGERS; f++) {
        const struct draw_item *d = find(DRAW_PLANE, f, &n);
        CHECK(d && n == 1 && d->kind == DRAW_DISC, "%d discs", n);
        CHECK(fabs(d->at.at.z - 0.02) < 0.001 && d->at.turn.z.z > 0.999, "not on the table");
        CHECK(d->colour[3] > 0 && d->colour[3] < 1, "not to be seen through");
        CHECK((d->colour[2] > 0.9F) == (f == 1 || f == 4), "blue means near");
        CHECK((d->colour[1] > 0.6F && d->colour[0] > 0.9F) == (f == 2), "amber means frozen");
        CHECK(find(DRAW_WAY, f, &n) && n > 5, "%d dots", n);
    }
    CHECK(said("contact") && said("frozen") && said("near"), "not in words");
    end();
}

TEST(all_objects_and_the_whole_hand_are_there)
{
    int n;
    begin(1 << 1);
    world_draw(w, &m, &l);
    CHECK(find(DRAW_OBJECT, 0, &n)->kind == DRAW_SQUARE && n == 1, "table");
    CHECK(find(DRAW_OBJECT, 1, &n)->kind == DRAW_SPHERE && n == 1, "ball, though out of reach");
    for (int f = 0; f < FINGERS; f++) {
        const struct draw_item *i = find(DRAW_HAND, f, &n);
        CHECK_EQ_I64(n, 6);
        CHECK((i->colour[3] < 1) == (f != 1), "a finger that is off is of glass");
        CHECK((find(DRAW_PLANE, f, &n) != NULL) == (f == 1), "disc of finger %d", f);
    }
    CHECK(find(DRAW_HAND, -1, &n) && n > 5, "palm");
    CHECK(said("off"), "off is not said");
    end();
}

TEST(numbers_are_on_the_screen)
{
    begin(31);
    m.in.d_m_q30[1] = (int32_t)(-0.01234 * 0x1p30);
    m.in.q_lim_m_q30[1] = (int32_t)(0.05678 * 0x1p30);
    m.in.force_N_q20[1] = (int32_t)(7.25 * 0x1p20);
    m.linked = 1;
    m.age_ms = 3.26;
    m.fps = 400;
    m.lost = 17;
    world_draw(w, &m, &l);
    CHECK(said("-12.34") && said("56.78") && said("7.25"), "d, q_lim, F");
    CHECK(
        said("400 frames/s") && said("age 3.3 ms") && said("lost 17") && !said("no link"), "link");
    m.in.d_m_q30[1] = INT32_MIN;
    m.in.q_lim_m_q30[2] = INT32_MAX;
    world_draw(w, &m, &l);
    CHECK(!said("2000.00") && said("56.78"), "what there is none of is a number");
    m.linked = 0;
    m.paused = m.help = 1;
    world_draw(w, &m, &l);
    CHECK(said("no link") && said("paused") && said("turn the view"), "no link, pause, help");
    CHECK(l.texts < (int)(sizeof l.text / sizeof l.text[0]), "no room for all texts");
    CHECK(l.rects < (int)(sizeof l.rect / sizeof l.rect[0]), "no room for all panels");
    end();
}

TEST_MAIN("world: the draw list", a_bar_is_6_mm_high_for_each_newton_along_the_normal,
    a_disc_lies_where_the_pad_will_touch_and_tells_the_state,
    all_objects_and_the_whole_hand_are_there, numbers_are_on_the_screen);
