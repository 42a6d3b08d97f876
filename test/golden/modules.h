/* SPDX-License-Identifier: MIT */
/* Every module that has golden vectors. The name is that of its run, its digests, its
 * files and its test. */
#ifndef TEST_GOLDEN_MODULES_H
#define TEST_GOLDEN_MODULES_H

#include "golden.h"

#define GOLDEN_MODULE(name) \
    void golden_##name(struct golden *g, uint32_t rate_Hz); \
    extern const uint32_t digest_##name[GOLDEN_HUNDREDS]

GOLDEN_MODULE(fix);
GOLDEN_MODULE(bytes);
GOLDEN_MODULE(mac);
GOLDEN_MODULE(record);
GOLDEN_MODULE(ring);
GOLDEN_MODULE(signal);
GOLDEN_MODULE(slots);
GOLDEN_MODULE(quad);
GOLDEN_MODULE(quad_ab);
GOLDEN_MODULE(velocity_window);
GOLDEN_MODULE(velocity_pole);
GOLDEN_MODULE(velocity_foaw);
GOLDEN_MODULE(velocity_track);
GOLDEN_MODULE(contact);
GOLDEN_MODULE(table);
GOLDEN_MODULE(drive);
GOLDEN_MODULE(track);
GOLDEN_MODULE(passivity);
GOLDEN_MODULE(watch);
GOLDEN_MODULE(chatter);
GOLDEN_MODULE(guard);
GOLDEN_MODULE(supply);
GOLDEN_MODULE(safety);
GOLDEN_MODULE(limiter);
GOLDEN_MODULE(calibrate);
GOLDEN_MODULE(probe);
GOLDEN_MODULE(home);
GOLDEN_MODULE(weigh);
GOLDEN_MODULE(filter);
GOLDEN_MODULE(filter_cheap);
GOLDEN_MODULE(quantizer);
GOLDEN_MODULE(gains);
GOLDEN_MODULE(glove);
GOLDEN_MODULE(glove_every);
GOLDEN_MODULE(glove_cal);
GOLDEN_MODULE(angle);
GOLDEN_MODULE(hand);
GOLDEN_MODULE(precontact);
GOLDEN_MODULE(wire);
GOLDEN_MODULE(mirror);
GOLDEN_MODULE(modbus);
GOLDEN_MODULE(modbus_rtu);
GOLDEN_MODULE(drop);
GOLDEN_MODULE(guarded);
GOLDEN_MODULE(bilateral);

#endif
