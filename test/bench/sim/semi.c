/* The simulator's own source, under another name: what is compared is what is shipped. Its name is
 * then ours to give, so that a whole simulator can be linked with another method (table2.c). */
#define plant_advance      semi_own_advance
#define plant_advance_hand semi_own_advance_hand
#include "../../../ports/posix/sim/plant.c"

#include "method.h"

void semi_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
                  const struct plant_hand *hand)
{
    if (hand) {
        semi_own_advance_hand(p, d, dt_s, ref_A, hand);
    } else {
        semi_own_advance(p, d, dt_s, ref_A, 0);
    }
}
