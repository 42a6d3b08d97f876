/* main() of a firmware image: one scene, named by the build. It runs when somebody
 * takes hold of the dead-man switch; one that is closed at power-on, and so may be
 * stuck, has to be let go first. After a fault only a reset helps. */
#include "loop.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/safety.h"

extern const struct exh_scene EXH_SCENE;

static void before(uint32_t tick, struct exh_scene_in *in)
{
    static uint32_t held = EXH_DIN_DEADMAN;
    const uint32_t now = in->drive.din & EXH_DIN_DEADMAN;
    (void)tick;
    if (now && !held) { in->command = EXH_CMD_RUN; }
    held = now;
}

int main(void)
{
    static const struct exh_loop_hooks hooks = {.before = before};
    int err;
    if (EXH_SCENE.defaults) { EXH_SCENE.defaults(); }
    err = exh_loop(&EXH_SCENE, 0, &hooks);
    exh_board_halt(err < 0 ? exh_error_text(err) : "done");
    return 0;
}
