/* main() of a firmware image: one scene, named by the build. Taking hold of the dead-man
 * switch clears a fault whose cause is gone and runs the scene; letting go stops it.
 * A switch that is closed at power-on, and so may be stuck, has to be let go first. */
#include "loop.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/safety.h"

extern const struct exh_scene EXH_SCENE;

static uint32_t settle; /* ticks in 50 ms: contacts bounce, and a glitch is no hand */
static uint32_t open_for, closed_for;
static int armed; /* it was open for long enough */

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    settle = (uint32_t)exh_udiv64(board.T.den, UINT64_C(20) * board.T.num, NULL) + 1;
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    const int held = (in->drive.din & EXH_DIN_DEADMAN) != 0;
    (void)tick;
    open_for = held ? 0 : open_for + (open_for < settle);
    closed_for = held ? closed_for + (closed_for < settle + 2) : 0;
    if (open_for == settle) { armed = 1; }
    if (armed && closed_for == settle) { in->command = EXH_CMD_CLEAR; }
    if (armed && closed_for == settle + 1) {
        in->command = EXH_CMD_RUN;
        armed = 0;
    }
}

int main(void)
{
    static const struct exh_loop_hooks hooks = {.start = start, .before = before};
    int err;
    if (EXH_SCENE.defaults) { EXH_SCENE.defaults(); }
    err = exh_loop(&EXH_SCENE, 0, &hooks);
    exh_board_halt(err < 0 ? exh_error_text(err) : "done");
    return 0;
}
