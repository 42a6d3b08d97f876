/* SPDX-License-Identifier: MIT */
/* main() of an image of the contract test. It ends in exh_board_halt() with current on. The
 * caller of the image checks that no current is left. */
#include "contract.h"
#include "say.h"

#include "exhand/run/scene.h"

#include "exhand/board.h"

extern const struct exh_scene EXH_SCENE;

uint32_t contract_rate_Hz;

int main(void)
{
    const struct exh_drive_out out = {{32768 + 923, 32768, 32768, 32768, 32768}, 1, 0};
    int failed;
    contract_rate_Hz = EXH_SCENE.rate_Hz;
    failed = contract_main();
    (void)exh_board_wait();
    (void)exh_board_write_drive(&out);
    exh_board_halt(failed ? contract_said() : "done");
    return 0;
}
