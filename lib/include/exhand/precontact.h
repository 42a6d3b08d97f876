/* SPDX-License-Identifier: MIT */
/* Pre-contact: predicts the string position at contact and freezes it before (eq. 2 and 3).
 *
 * The world sends one plane per finger, late and irregularly. Every tick computes the distance
 * d = (P_C - P_F).n + t, negative before contact and 0 at touch. While d < d_lim, the virtual
 * contact moves along: q_lim = q - s*d. From the first tick with d >= d_lim, q_lim, plane and
 * material are frozen: later messages do not change them. The freeze ends when the contact law no
 * longer touches, and d < d_lim - hyst or the string is back by |d_lim| since the freeze.
 *
 * Doubt: the contact law depends on the string alone, whose zero may slip. So this module compares
 * it with the glove. A frozen contact is in doubt while the law touches and
 * d < d_lim - hyst - doubt, and while the fingertip is unknown. After more than doubt_ms in doubt
 * it is let go: the contact ends, and the force falls as fast as the drive allows. d uses the
 * frozen plane, so the link has no influence.
 *
 * If exh_precontact_none() returns 1, no contact is possible; call exh_contact_step_free() instead
 * of the law. The reasons are:
 * - No plane has come yet, or the world reported that the ray hit nothing.
 * - The plane is older than age_max and not frozen. A frozen plane does not age.
 * - Nothing is frozen, and the fingertip is unknown or older than tip_age_max.
 * - The finger was inside the object when the plane was born, and the plane was not late.
 *
 * A plane is born when it is new: the first one, of another object, or received while the finger
 * was frozen. If it is born at d_lim <= d < 0, q_lim moves along and freezes at the touch. Until
 * the finger has been at d < d_lim, 0 replaces d_lim. If the plane is born at d >= 0, inside the
 * object, it is either
 * - late: the link was too slow. The world has reported on the free finger before and sent the
 *   plane twice, the string runs out, s was not limited and is at most 2. q_lim becomes its true
 *   place (q - s*d) and freezes in this tick. The full force would start in one step, so the caller
 *   limits its rise to late_slew while late is 1, until exh_precontact_arrived(); or
 * - not late: the device has just started to pull, the world has just started to report
 *   (exh_precontact_forget()), or an object moved onto a resting finger. The force is 0 until the
 *   finger has left the object by hyst.
 *
 * A plane with a normal of wrong length or an unknown material is refused, without further effect.
 * Counters and the bits of every tick report all events. Per tick:
 *
 *   if (plane_came) { err = exh_precontact_update(&pre, &cfg, &plane, age_ticks); }
 *   uint32_t bits = exh_precontact_step(&pre, &cfg, &in);
 *   law_in.lim_m_q30 = pre.lim_m_q30; // unless exh_precontact_none(&pre) */
#ifndef EXHAND_PRECONTACT_H
#define EXHAND_PRECONTACT_H

#include "exhand/bytes.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The value of lim_m_q30 without contact, for logs and displays. The law must check
 * exh_precontact_none() instead, since INT32_MAX is also a valid position. */
#define EXH_PRECONTACT_NO_LIM INT32_MAX

/* --- messages of the world --- */

/* The kind of message about one finger. */
enum exh_plane_kind {
    EXH_PLANE_UNTOLD, /* no message about this finger */
    EXH_PLANE_NONE,   /* the ray hit nothing */
    EXH_PLANE_HIT     /* it hit the surface; the plane is tangent to it */
};

/* The plane of one finger in the frame of the palm, {R} of the paper. Preferably, point is the
 * point of the plane nearest the origin, computed once per object. All messages about one plane
 * then have the same bits, and so has the force. Any other point adds an error of 1 LSB of d. */
struct exh_plane {
    uint8_t kind;                /* enum exh_plane_kind */
    uint8_t material;            /* index of the material */
    uint16_t object;             /* id of the object; another id is another object */
    struct exh_vec3 normal_q30;  /* outward unit vector, length 1 within 2^-17 */
    struct exh_vec3 point_m_q30; /* any values */
};

/* --- parameters --- */

/* One material; rows in exh_material_rows[]. The freeze copies it: changes act later. */
struct exh_material_par {
    int32_t k_Npm_q10;   /* stiffness, N/m, 0 .. 10^6 */
    int32_t b_Nspm_q20;  /* damping, Ns/m, 0 .. 1000 */
    int32_t f_max_N_q20; /* force limit, N, 0 .. 100; the drive's limit also applies */
};
#define EXH_MATERIAL_ROWS 3
#define EXH_MATERIAL_K_ID 0x0B01 /* id of the row of k; the next id is b */
extern const struct exh_signal exh_material_rows[EXH_MATERIAL_ROWS];

/* Parameters of one finger; rows in exh_precontact_rows[]. */
struct exh_precontact_par {
    int32_t d_lim_m_q30;    /* freeze at d >= d_lim, m, -0.2 .. -10^-4 */
    int32_t hyst_m_q30;     /* release at d < d_lim - hyst, m, 0 .. 0.05 */
    int32_t scale_q24;      /* s: string metres per fingertip metre, 1/8 .. 8 */
    int32_t from_slope;     /* 1: use the slope of the fingertip for s, limited to 1/8 .. 8 */
    int32_t printed_sign;   /* 1: d = (P_C - P_F).n - t, as the paper prints it */
    int32_t age_max_ms;     /* maximum age of a plane, ms, 1 .. 60000 */
    int32_t doubt_m_q30;    /* in doubt when touching at d < d_lim - hyst - this, m, 0 .. 0.05 */
    int32_t doubt_ms;       /* time in doubt before letting go, ms, 1 .. 60000 */
    int32_t tip_age_max_ms; /* maximum age of a fingertip, ms, 1 .. 60000 */
    int32_t late_slew_Nps;  /* rise of force in a late contact, N/s, 1 .. 10^7 */
};
#define EXH_PRECONTACT_ROWS 10
extern const struct exh_signal exh_precontact_rows[EXH_PRECONTACT_ROWS];

/* Set-up of one finger. */
struct exh_precontact_cfg {
    const struct exh_precontact_par *par;    /* read at every tick */
    const struct exh_material_par *material; /* array of length materials, the caller's */
    int64_t pad_m_q60;                       /* t with its sign */
    /* Times in ticks, rounded down, plus 1. */
    uint32_t age_ticks;   /* age_max: a plane of this age is too old */
    uint32_t doubt_ticks; /* doubt_ms: longest doubt */
    uint32_t tip_ticks;   /* tip_age_max: a tip of this age is unknown */
    uint8_t materials;    /* 1 .. 255 */
};

/* --- one finger --- */

/* A plane as the tick uses it: n.P_C + t replaces the point. */
struct exh_precontact_plane {
    int64_t offset_m_q60;       /* n.P_C + t plus half an LSB of d */
    struct exh_vec3 normal_q30; /* (0, 0, 0): no plane */
    uint16_t object;            /* id of the object */
    uint8_t material;           /* index, below materials */
};

/* The phase of a finger. */
enum exh_precontact_phase {
    EXH_PRECONTACT_IDLE,   /* no plane, or it is too old */
    EXH_PRECONTACT_INSIDE, /* plane born at d >= 0, not late */
    EXH_PRECONTACT_TRACK,  /* q_lim moves along */
    EXH_PRECONTACT_FROZEN  /* q_lim is frozen */
};

/* State of one finger. All zeros: no message yet. The first four members are results. */
struct exh_precontact {
    int32_t d_m_q30;                          /* distance; INT32_MIN: no plane */
    int32_t lim_m_q30;                        /* q_lim */
    struct exh_material_par taken;            /* material at the last freeze; zeros before */
    uint8_t phase;                            /* enum exh_precontact_phase */
    struct exh_precontact_plane newest, held; /* last received; frozen */
    uint32_t left_ticks;                      /* ticks until newest is too old */
    uint32_t frozen_n;                        /* freezes; this and all counters below wrap */
    uint32_t born_n;                          /* planes born at d >= 0 that were not late */
    uint32_t refused_n;                       /* planes refused */
    uint32_t ignored_n;                       /* planes ignored while frozen */
    uint32_t stale_n;                         /* planes that became too old while q_lim moved */
    uint32_t doubt_ticks;                     /* consecutive ticks in doubt */
    uint32_t let_go_n;                        /* contacts let go */
    uint32_t late_n;                          /* late contacts */
    int32_t late_m_q30;                       /* d at the start of the last late contact, m */
    int32_t ahead_m_q30;                      /* q_lim - q at the last freeze, m */
    uint8_t met;                              /* 1: the world has reported on the free finger */
    uint8_t near;                             /* 1: 0 replaces d_lim */
    uint8_t late;                             /* 1: the caller limits the rise of force */
    uint8_t told;                             /* messages about the newest object, at most 2 */
    uint8_t resumed;                          /* 1: restored, no step yet; not serialized */
};

/* Inputs of a tick. */
struct exh_precontact_in {
    struct exh_vec3 tip_m_q30; /* P_F of exh_hand_tip(); any values */
    struct exh_vec3 slope_q24; /* of exh_hand_tip_slope(); used if from_slope */
    int32_t pos_m_q30;         /* q, the same as the input of the contact law */
    uint32_t tip_age_ticks;    /* age of P_F; UINT32_MAX: unknown */
    uint8_t touching;          /* last return value of the contact law */
    uint8_t pulls;             /* 1: the permit is open */
    int32_t vel_mps_q27;       /* velocity of q */
};

/* Result of a tick. None of the first four is set: no plane, or no fingertip. */
enum exh_precontact_bit {
    EXH_PRECONTACT_STANDS = 1u << 0,  /* phase FROZEN */
    EXH_PRECONTACT_TRACKS = 1u << 1,  /* phase TRACK */
    EXH_PRECONTACT_AROUND = 1u << 2,  /* phase INSIDE, or waiting for a second message */
    EXH_PRECONTACT_STALE = 1u << 3,   /* phase IDLE: newest plane is too old */
    EXH_PRECONTACT_BENT = 1u << 4,    /* s was limited: string and approach disagree */
    EXH_PRECONTACT_FREEZE = 1u << 5,  /* frozen in this tick: taken is new */
    EXH_PRECONTACT_RELEASE = 1u << 6, /* released in this tick; newest counts as new */
    EXH_PRECONTACT_BLIND = 1u << 7,   /* fingertip unknown or too old */
    EXH_PRECONTACT_DOUBT = 1u << 8,   /* the frozen contact is in doubt */
    EXH_PRECONTACT_LETGO = 1u << 9,   /* let go in this tick, with RELEASE: no contact */
    EXH_PRECONTACT_LATE = 1u << 10    /* late contact; with FREEZE in its first tick */
};

/* Set-up (divides); par and the materials must outlive cfg. pad_m_q30 is the radius t of the pad,
 * m, 0 .. 25 mm (exh_hand_par). A changed pad or sign acts on later planes only. -EXH_E_RATE: T.
 * -EXH_E_RANGE: a parameter outside its range above, no material, or more than 255. */
int exh_precontact_setup(struct exh_precontact_cfg *cfg, const struct exh_precontact_par *par,
    const struct exh_material_par *material, unsigned materials, int32_t pad_m_q30,
    struct exh_period T);

/* Takes a message about this finger, age_ticks old; call it before the step of the tick. It does
 * not affect q_lim, material, distance and release of a frozen finger. Returns 0, or -EXH_E_RANGE:
 * refused. */
int exh_precontact_update(struct exh_precontact *s, const struct exh_precontact_cfg *cfg,
    const struct exh_plane *plane, uint32_t age_ticks);

/* 1: no contact is possible, call exh_contact_step_free(). 0: contact is possible at lim_m_q30. */
static inline int exh_precontact_none(const struct exh_precontact *s)
{
    return s->phase < EXH_PRECONTACT_TRACK;
}

/* Call it when the peer changes or restarts: its first plane then does not count as late. */
static inline void exh_precontact_forget(struct exh_precontact *s) { s->met = 0; }

/* Call it when the force of a late contact has reached the law's force. */
static inline void exh_precontact_arrived(struct exh_precontact *s) { s->late = 0; }

/* Accounts for missed ticks; call it before update and step of the next tick. It adds them to the
 * age of the plane and to the time in doubt. */
void exh_precontact_advance(struct exh_precontact *s, uint32_t missed);

/* One tick; call it before the contact law and pass lim_m_q30 to the law. d is rounded once (1/2
 * LSB) and saturates at +-2 m. q_lim is within 1/2 LSB of q - s*d and saturates; s from the slope
 * is within 2^-25 + 2^-28*s. Returns enum exh_precontact_bit. If the law gets the same q, it never
 * touches before the freeze, except for q at the end of its format while q_lim moves. */
uint32_t exh_precontact_step(struct exh_precontact *s, const struct exh_precontact_cfg *cfg,
    const struct exh_precontact_in *in);

/* State through a cursor; restored values are brought into range. If a restored q_lim freezes and
 * touches in the first tick, the plane counts as born there. */
void exh_precontact_serialize(struct exh_bytes *c, struct exh_precontact *s);

/* --- advice: freezing distance and ray length --- */

/* Speeds, delays and errors of the approach. */
struct exh_precontact_need {
    int32_t speed_mps_q27;  /* fastest approach, m/s, 0 .. 16 */
    int32_t lag_us;         /* delay of the fingertip behind the string: glove frame, filter */
    int32_t noise_m_q30;    /* peak noise of d, m */
    int32_t age_us;         /* highest age of the newest plane: frame + latency + jitter */
    int32_t object_mps_q27; /* speed of the object, or of the hand's base in the world, m/s */
    int32_t slide_m_q30;    /* tangential movement from the plane's point to the contact, m */
    int32_t radius_m_q30;   /* radius of the object's surface, m; 0: plane */
};
/* The resulting d_lim, ray length and error. */
struct exh_precontact_advice {
    int32_t d_lim_m_q30;   /* largest d_lim: -(v*(T + lag) + noise) */
    int32_t ray_m_q30;     /* shortest ray: |d_lim| + v*(T + age) + noise */
    int32_t error_m_q30;   /* error of q_lim/s at the freeze: v_object*age + slide^2 / (2*radius) */
    int32_t speed_mps_q27; /* fastest approach that the given d_lim allows */
};

/* Set-up or host (divides). d_lim_m_q30 < 0 is the value to judge: it gives ray and speed, and is
 * too small in magnitude if it exceeds advice->d_lim_m_q30. All results are rounded to the safe
 * side, the first within 2 LSB and 1 ns of motion. -EXH_E_RATE: T. -EXH_E_RANGE: a need below 0,
 * lag or age above 2 s, d_lim not below 0, or a result beyond 2 m. Speed saturates. */
int exh_precontact_advise(struct exh_precontact_advice *advice,
    const struct exh_precontact_need *need, struct exh_period T, int32_t d_lim_m_q30);

#ifdef __cplusplus
}
#endif
#endif
