/* SPDX-License-Identifier: MIT */
/* What the generator found: the digest of each module at 1, 2, … 2000 Hz. */
#include "modules.h"

const uint32_t digest_fix[GOLDEN_RATES] = {
#include "digest/fix.inc"
};
const uint32_t digest_bytes[GOLDEN_RATES] = {
#include "digest/bytes.inc"
};
const uint32_t digest_record[GOLDEN_RATES] = {
#include "digest/record.inc"
};
const uint32_t digest_ring[GOLDEN_RATES] = {
#include "digest/ring.inc"
};
const uint32_t digest_signal[GOLDEN_RATES] = {
#include "digest/signal.inc"
};
const uint32_t digest_slots[GOLDEN_RATES] = {
#include "digest/slots.inc"
};
const uint32_t digest_quad[GOLDEN_RATES] = {
#include "digest/quad.inc"
};
const uint32_t digest_quad_ab[GOLDEN_RATES] = {
#include "digest/quad_ab.inc"
};
const uint32_t digest_velocity_window[GOLDEN_RATES] = {
#include "digest/velocity_window.inc"
};
const uint32_t digest_velocity_pole[GOLDEN_RATES] = {
#include "digest/velocity_pole.inc"
};
const uint32_t digest_velocity_foaw[GOLDEN_RATES] = {
#include "digest/velocity_foaw.inc"
};
const uint32_t digest_velocity_track[GOLDEN_RATES] = {
#include "digest/velocity_track.inc"
};
const uint32_t digest_contact[GOLDEN_RATES] = {
#include "digest/contact.inc"
};
const uint32_t digest_table[GOLDEN_RATES] = {
#include "digest/table.inc"
};
const uint32_t digest_drive[GOLDEN_RATES] = {
#include "digest/drive.inc"
};
const uint32_t digest_track[GOLDEN_RATES] = {
#include "digest/track.inc"
};
const uint32_t digest_passivity[GOLDEN_RATES] = {
#include "digest/passivity.inc"
};
const uint32_t digest_watch[GOLDEN_RATES] = {
#include "digest/watch.inc"
};
const uint32_t digest_guard[GOLDEN_RATES] = {
#include "digest/guard.inc"
};
const uint32_t digest_supply[GOLDEN_RATES] = {
#include "digest/supply.inc"
};
const uint32_t digest_safety[GOLDEN_RATES] = {
#include "digest/safety.inc"
};
const uint32_t digest_calibrate[GOLDEN_RATES] = {
#include "digest/calibrate.inc"
};
const uint32_t digest_probe[GOLDEN_RATES] = {
#include "digest/probe.inc"
};
const uint32_t digest_home[GOLDEN_RATES] = {
#include "digest/home.inc"
};
const uint32_t digest_weigh[GOLDEN_RATES] = {
#include "digest/weigh.inc"
};
const uint32_t digest_filter[GOLDEN_RATES] = {
#include "digest/filter.inc"
};
const uint32_t digest_quantizer[GOLDEN_RATES] = {
#include "digest/quantizer.inc"
};
const uint32_t digest_gains[GOLDEN_RATES] = {
#include "digest/gains.inc"
};
const uint32_t digest_glove[GOLDEN_RATES] = {
#include "digest/glove.inc"
};
const uint32_t digest_glove_every[GOLDEN_RATES] = {
#include "digest/glove_every.inc"
};
const uint32_t digest_glove_cal[GOLDEN_RATES] = {
#include "digest/glove_cal.inc"
};
const uint32_t digest_angle[GOLDEN_RATES] = {
#include "digest/angle.inc"
};
const uint32_t digest_hand[GOLDEN_RATES] = {
#include "digest/hand.inc"
};
const uint32_t digest_precontact[GOLDEN_RATES] = {
#include "digest/precontact.inc"
};
const uint32_t digest_wire[GOLDEN_RATES] = {
#include "digest/wire.inc"
};
const uint32_t digest_mirror[GOLDEN_RATES] = {
#include "digest/mirror.inc"
};
const uint32_t digest_modbus[GOLDEN_RATES] = {
#include "digest/modbus.inc"
};
const uint32_t digest_modbus_rtu[GOLDEN_RATES] = {
#include "digest/modbus_rtu.inc"
};
const uint32_t digest_drop[GOLDEN_RATES] = {
#include "digest/drop.inc"
};
const uint32_t digest_guarded[GOLDEN_RATES] = {
#include "digest/guarded.inc"
};
const uint32_t digest_bilateral[GOLDEN_RATES] = {
#include "digest/bilateral.inc"
};
