/* SPDX-License-Identifier: MIT */
/* Scene files: what is wrong is said with file, line, what, and what to do. */
#include "check.h"

#include "world/rpy.h"
#include "world/world.h"

#include <stdio.h>

#define M "material m\n"

static const struct {
    const char *text, *error;
} wrong[] = {
    {"sfere a",
        "t:1: sfere: no such statement: use world, fingers, look, hand, camera, material, plane, "
        "sphere, box, capsule, mesh, motion or key"},
    {"\n\n# x\nmaterial", "t:4: material: its name is missing: add one word"},
    {M "material m", "t:2: material m: defined twice: use another name"},
    {"material m k -1", "t:1: material m: k -1 (allowed 0..1e+06): give a number in that range"},
    {"material m k 1 b 1001",
        "t:1: material m: b 1001 (allowed 0..1000): give a number in that range"},
    {"material m fmax 101",
        "t:1: material m: fmax 101 (allowed 0..100): give a number in that range"},
    {"material m k nan", "t:1: material m: k nan (allowed 0..1e+06): give a number in that range"},
    {"material m k 1e",
        "t:1: material m: k: 1 number must follow, not \"1e\": add what is missing"},
    {"material m colour 1 0",
        "t:1: material m: colour: 3 numbers must follow, not \"\": add what is missing"},
    {"material m mass 3", "t:1: material m: mass: no such word here: use one of k b fmax colour"},
    {"material m k 1 k 2", "t:1: material m: k: given twice: leave one out"},
    {M "sphere a at 0 0 0 radius 1 material wood",
        "t:2: sphere a: material wood: not defined so far: add `material wood` above"},
    {M "sphere a at 0 0 0 material m",
        "t:2: sphere a: radius is missing: add `radius` and its number"},
    {M "sphere a radius 1 material m", "t:2: sphere a: at is missing: add `at` and its numbers"},
    {M "sphere a at 0 0 0 radius 1 material",
        "t:2: sphere a: material: a word must follow: add it"},
    {M "sphere a at 0 0 0 radius 1 material m\nsphere a at 0 0 0 radius 1 material m",
        "t:3: sphere a: the name is taken: use another one"},
    {M "box hand at 0 0 0 size 1 1 1 material m",
        "t:2: box hand: the name is taken: use another one"},
    {M "plane p at 0 0 0 normal 0 0 0 material m",
        "t:2: plane p: normal has no length: let it point out of the solid"},
    {M "mesh a at 0 0 0 file none.obj material m",
        "t:2: mesh a: none.obj: No such file or directory: name a file beside the scene"},
    {"hand at 0 0 0 palm 0 0 1 point 0 0 2", "t:1: hand: palm and point are parallel or zero: the "
                                             "palm looks to the side of where the fingers point"},
    {"fingers index toe",
        "t:1: fingers: toe: no such finger: use thumb index middle ring little, or all"},
    {"fingers", "t:1: fingers: none: name those in use, or all"},
    {"camera eye 1 1 1 look 1 1 1", "t:1: camera: eye and look are the same point: part them"},
    {"motion a linear", "t:1: motion a: no such object so far: define it above"},
    {"motion hand jump",
        "t:1: motion hand: jump: no such motion: use linear, sine, keys or keys loop"},
    {"motion hand keys once",
        "t:1: motion hand: once: no such motion: use linear, sine, keys or keys loop"},
    {"motion hand linear\nmotion hand linear", "t:2: motion hand: given twice: leave one out"},
    {"motion hand linear hz 1", "t:1: motion hand: hz: no such word here: use one of move turn"},
    {"key hand t 0", "t:1: key hand: it has no motion by keys: add `motion hand keys` above"},
    {"motion hand keys\nkey hand t 1\nkey hand t 1",
        "t:3: key hand: t 1 is not after the one before: let times rise"},
    {"motion hand keys\nkey hand t 1\n",
        "t:2: motion hand keys: fewer than two keys: add `key hand t ...` lines"},
    {"motion hand keys loop\nkey hand t 1\nkey hand t 2 move 1 0 0",
        "t:3: motion hand keys loop: the last key is not where the first is: it would jump; add "
        "one "
        "that "
        "closes the loop"},
};

TEST(each_fault_is_named_with_its_line_and_remedy)
{
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        char why[700] = "";
        struct world *w = world_load("t", wrong[i].text, why, sizeof why);
        CHECK(w == NULL, "taken: %s", wrong[i].text);
        CHECK(strcmp(why, wrong[i].error) == 0, "\n%s\nnot\n%s", why, wrong[i].error);
        world_free(w);
    }
}

TEST(a_short_buffer_is_not_overrun)
{
    for (size_t n = 1; n < 60; n++) {
        char why[64];
        memset(why, '#', sizeof why);
        CHECK(world_load("t", "sfere", why, n) == NULL, "taken");
        CHECK(memchr(why, '\0', n) != NULL && why[n] == '#', "%d", (int)n);
    }
}

/* Any bytes: a world or an error, and nothing else. */
TEST(damaged_scenes_do_no_harm)
{
    static const char whole[] = "world a b\nfingers index\nlook ahead 0.1 graze 10\nhand "
                                "at 0 0 0 palm 1 0 0 point 0 0 1\n"
                                "camera eye 1 1 1 look 0 0 0\nmaterial m k 1 b 2 fmax 3 colour 1 1 "
                                "1\nplane p at 0 0 0 normal 0 1 0 "
                                "material m draw 1\nsphere s at 0 0 0 radius 1 material m\nbox b "
                                "at 0 0 0 rpy 1 2 3 size 1 1 1 "
                                "material m\ncapsule c at 0 0 0 radius 1 length 1 material "
                                "m\nmotion s sine move 1 1 1 hz 2 phase "
                                "90\nmotion b keys loop\nkey b t 0\nkey b t 1 move 1 0 0 turn 1 1 "
                                "1\nkey b t 2\nmotion hand linear "
                                "move 0 0 1 turn 0 0 3\n";
    char why[700];
    struct world *w = world_load("t", whole, why, sizeof why);
    CHECK(w != NULL, "%s", why);
    world_free(w);
    while (check_case(1000)) {
        char text[sizeof whole];
        memcpy(text, whole, sizeof whole);
        for (int k = (int)(check_u64() % 4); k >= 0; k--) {
            text[check_u64() % (sizeof whole - 1)] = (char)(check_u64() % 255 + 1);
        }
        text[check_u64() % 3 ? sizeof whole - 1 : check_u64() % sizeof whole] = '\0';
        w = world_load("t", text, why, sizeof why);
        CHECK(w || strncmp(why, "t:", 2) == 0, "%s", why);
        world_free(w);
    }
}

TEST(numbers_arrive)
{
    static const char text[] =
        "world A  title\nfingers index little\nlook ahead 0.07 graze 0\n"
        "hand at 1 2 3 palm 0 0 -1 point 0 1 0\nmaterial a\nmaterial b k 5 b 6 fmax 7 colour 0 0.5 "
        "1\n"
        "capsule c at 1 0 0 rpy 0 90 0 radius 0.5 length 3 material b # end\n"
        "motion c sine move 0 0 2 hz 0.25 phase 90\n";
    char why[700];
    struct world *w = world_load("t", text, why, sizeof why);
    const struct scene *s = w ? world_scene(w) : NULL;
    struct pose p;
    CHECK(w != NULL, "%s", why);
    if (w == NULL) { return; }
    CHECK(strcmp(s->title, "A title") == 0, "%s", s->title);
    CHECK_EQ_I64(s->fingers, 1 << 1 | 1 << 4);
    CHECK(s->look_m == 0.07 && s->graze == 0, "%g %g", s->look_m, s->graze);
    CHECK(v3_len(v3_sub(s->hand.turn.x, v3(0, 0, -1))) < 1e-15, "palm");
    CHECK(v3_len(v3_sub(s->hand.turn.y, v3(-1, 0, 0))) < 1e-15,
        "the thumb is on the left of a right hand");
    CHECK(s->material[0].k == 20000 && s->material[1].k == 5 && s->material[1].f_max == 7,
        "material");
    CHECK(s->object[0].material == 1 && s->object[0].shape.half_m.z == 1.5, "capsule");
    CHECK(v3_len(v3_sub(s->object[0].stand.turn.z, v3(1, 0, 0))) < 1e-15, "its axis");
    p = motion_at(&s->object[0].motion, &s->object[0].stand, 0);
    CHECK(fabs(p.at.z - 2) < 1e-12, "at 0: %g", p.at.z);
    p = motion_at(&s->object[0].motion, &s->object[0].stand, 1e6 + 2);
    CHECK(fabs(p.at.z + 2) < 1e-9, "half a turn after a million: %g", p.at.z);
    world_free(w);
}

TEST(keys_are_joined_by_lines)
{
    static const char text[] =
        "motion hand keys loop\nkey hand t 1 move 1 0 0\nkey hand t 2 move 3 0 0\n"
        "key hand t 4 move 1 0 0 turn 0 0 0\n";
    static const double want[][2] = {
        {0, 1}, {1, 1}, {1.5, 2}, {2, 3}, {3, 2}, {4, 1}, {4.5, 2}, {301.5, 2}};
    char why[700];
    struct world *w = world_load("t", text, why, sizeof why);
    CHECK(w != NULL, "%s", why);
    for (size_t i = 0; w && i < sizeof want / sizeof want[0]; i++) {
        const struct pose p = world_hand_at(w, want[i][0]);
        CHECK(
            fabs(p.at.x - want[i][1]) < 1e-12, "at %g: %g, not %g", want[i][0], p.at.x, want[i][1]);
    }
    world_free(w);
}

TEST(the_scenes_that_come_along_load)
{
    static const char *const name[] = {"collision", "rehabilitation", "explore", "grasp", "gem"};
    for (size_t i = 0; i < sizeof name / sizeof name[0]; i++) {
        char path[100], why[700];
        struct world *w;
        snprintf(path, sizeof path, "ports/posix/world/scenes/%s.world", name[i]);
        w = world_load_file(path, why, sizeof why);
        if (w == NULL && strstr(why, "libembree-dev")) {
            check_note("%s: not tested: needs libembree-dev", name[i]);
            continue;
        }
        CHECK(w != NULL, "%s", why);
        world_free(w);
    }
}

TEST_MAIN("world: scenes", each_fault_is_named_with_its_line_and_remedy,
    a_short_buffer_is_not_overrun, damaged_scenes_do_no_harm, numbers_arrive,
    keys_are_joined_by_lines, the_scenes_that_come_along_load);
