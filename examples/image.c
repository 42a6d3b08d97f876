/* main() of a firmware image: one scene, named by the build. */
#include "loop.h"

#include "exhand/board.h"
#include "exhand/error.h"

extern const struct exh_scene EXH_SCENE;

int main(void)
{
    int err;
    if (EXH_SCENE.defaults) { EXH_SCENE.defaults(); }
    err = exh_loop(&EXH_SCENE, 0, NULL);
    exh_board_halt(err < 0 ? exh_error_text(err) : "done");
    return 0;
}
