/* SPDX-License-Identifier: MIT */
/* Memory of what cannot be left out of the full box when it is built, for costs.py: the size of
 * each array, by nm. Parameters count twice: active and staged. */
#include "bilateral/bilateral.h"

struct finger_par {
    struct exh_quad_par quad;
    struct exh_velocity_par velocity;
    struct exh_contact_par contact;
    struct exh_drive_par drive;
    struct exh_tracking_par track;
    struct exh_motion_par watch;
    int32_t kf_NpA_q20;
    struct exh_hand_par hand;
    struct exh_precontact_par precontact;
};

extern const char share_finger[], share_glove[], share_link[];

const char share_finger[sizeof(struct bilateral_finger) + sizeof(struct bilateral_finger_cfg) +
                        sizeof(struct exh_drive_cfg) + sizeof(struct exh_drive_par) +
                        2 * sizeof(struct finger_par) + sizeof(struct bilateral_paper) +
                        sizeof(struct bilateral_more)] = {0};

const char share_glove[sizeof(struct exh_glove) + sizeof(struct exh_glove_cfg) +
                       sizeof(struct exh_glove_cal) +
                       2 * (sizeof(struct exh_glove_par) + sizeof(struct glove_own_par) +
                               EXH_GLOVE_SENSORS * sizeof(struct glove_sensor_par))] = {0};

const char share_link[sizeof(struct bilateral_wire) + sizeof(struct bilateral_wire_cfg) +
                      2 * sizeof(struct exh_scene_mail)] = {0};
