/* SPDX-License-Identifier: MIT */
/* Pre-contact: where the string will be when the finger touches, frozen before it does
 * (the paper's eq. 2 and 3).
 *
 * The world tells one plane per finger, late and irregularly. In every tick the distance
 * d = (P_C - P_F).n + t is computed here, negative before contact and 0 at touch, and
 * while d < d_lim the virtual contact moves along: q_lim = q - s*d. From the first tick
 * with d >= d_lim on, q_lim, the plane and the material stay as they are, whatever the
 * world says, until the finger has left: the contact law touches no more, and
 * d < d_lim - hyst, or the string is back by |d_lim| from where it was at the freeze.
 *
 * Whether the law touches, the string alone says, and its zero may slip. So what stands is held
 * against the glove: it is in doubt while the law touches and d < d_lim - hyst - doubt, and
 * while the fingertip is unknown. In doubt in more than doubt_ms of ticks on end, it is let go:
 * there is no contact, and the force falls as fast as the drive lets it. d is that of the plane
 * taken at the freeze, so that nothing of this hangs on the link.
 *
 * exh_precontact_none() says that no contact can be; then exh_contact_step_free() has the place of
 * the law. That is so when
 *   - no plane has come yet, or the world said that there is none (no hit);
 *   - the plane is older than age_max (only while q_lim moves along; a frozen one does
 *     not age);
 *   - the fingertip is older than tip_age_max, or unknown, and nothing is frozen;
 *   - the finger was inside when the plane was born, and that was not late.
 *
 * A plane is born when it is new: the first, of another object than the one before, or come while
 * the finger was frozen. Born at d_lim <= d < 0, before the touch, q_lim moves along, too, and is
 * frozen at the touch: until the finger has been at d < d_lim, 0 stands for d_lim everywhere.
 * Born at d >= 0, in the object, it is
 *   - late, if the world has spoken of this finger while it was free, it was told
 *     twice on end, the string runs out, and s is 2 at most and was not limited: the link was too
 *     slow for it. The wall is at its true place, (q - s*d), at once, and frozen. As it would push
 *     with all its force at once, the caller limits the rise of force to late_slew for as long as
 *     `late` is 1 (exh_precontact_arrived()).
 *   - nobody's fault else: the box has just begun to pull, the world has just begun to speak
 *     (exh_precontact_forget()), or something came onto a finger that rests. There is no force
 *     until the finger has left the object by hyst.
 * A plane whose normal is no unit vector, or whose material does not exist, is refused: as
 * if it had not come. What happened is counted, and is in the bits of every tick.
 */
#ifndef EXHAND_PRECONTACT_H
#define EXHAND_PRECONTACT_H

#include "exhand/bytes.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What lim_m_q30 shows where there is no contact, for logs and people. The law goes by
 * exh_precontact_none(): a q_lim at the format's end is a place like any other. */
#define EXH_PRECONTACT_NO_LIM INT32_MAX

/* --- what the world tells --- */

/* What is told of one finger. */
enum exh_plane_kind {
    EXH_PLANE_UNTOLD, /* nothing about this finger */
    EXH_PLANE_NONE,   /* the ray hit nothing */
    EXH_PLANE_HIT     /* it hit the surface that the plane touches */
};

/* For one finger, in the frame of the palm, which is the paper's {R}. Canonical is the plane
 * of which `point` is the point nearest the origin, computed once per object: all messages
 * about one plane are then the same bits, and so is the force. Any other point of the plane is
 * taken as well, at an error of <= 1 LSB of d. */
struct exh_plane {
    uint8_t kind;                /* enum exh_plane_kind */
    uint8_t material;            /* index */
    uint16_t object;             /* whose surface: another number is another object */
    struct exh_vec3 normal_q30;  /* outward, of length 1 within 2^-17 */
    struct exh_vec3 point_m_q30; /* any values */
};

/* --- parameters --- */

/* One material; rows in exh_material_rows[]. Taken at the freeze, so a change never
 * reaches a contact that is there. */
struct exh_material_par {
    int32_t k_Npm_q10;   /* stiffness, N/m, 0 .. 10^6 */
    int32_t b_Nspm_q20;  /* damping, Ns/m, 0 .. 1000 */
    int32_t f_max_N_q20; /* its force limit, N, 0 .. 100; the drive's holds too */
};
#define EXH_MATERIAL_ROWS 3
#define EXH_MATERIAL_K_ID 0x0B01 /* of the row of k; that of b is the next */
extern const struct exh_signal exh_material_rows[EXH_MATERIAL_ROWS];

/* One finger; rows in exh_precontact_rows[]. */
struct exh_precontact_par {
    int32_t d_lim_m_q30;    /* freeze at d >= d_lim, m, -0.2 .. -10^-4 */
    int32_t hyst_m_q30;     /* release at d < d_lim - hyst, m, 0 .. 0.05 */
    int32_t scale_q24;      /* s: string metres per fingertip metre, 1/8 .. 8 */
    int32_t from_slope;     /* 1: s from the fingertip's slope along the string
                               instead, limited to 1/8 .. 8 */
    int32_t printed_sign;   /* 1: d = (P_C - P_F).n - t, as the paper prints it */
    int32_t age_max_ms;     /* an older plane is none, ms, 1 .. 60000 */
    int32_t doubt_m_q30;    /* touching at d < d_lim - hyst - this is in doubt, m, 0 .. 0.05 */
    int32_t doubt_ms;       /* let go after so long in doubt, ms, 1 .. 60000 */
    int32_t tip_age_max_ms; /* an older fingertip is unknown, ms, 1 .. 60000 */
    int32_t late_slew_Nps;  /* rise of force of a late contact, N/s, 1 .. 10^7 */
};
#define EXH_PRECONTACT_ROWS 10
extern const struct exh_signal exh_precontact_rows[EXH_PRECONTACT_ROWS];

/* One finger as it is set up. */
struct exh_precontact_cfg {
    const struct exh_precontact_par *par;    /* read at every tick */
    const struct exh_material_par *material; /* the caller's, materials of them */
    int64_t pad_m_q60;                       /* t with its sign */
    /* Times, rounded down, and one more. */
    uint32_t age_ticks;   /* age_max: a plane so old is too old */
    uint32_t doubt_ticks; /* doubt_ms: more than so long in doubt, and the contact is released */
    uint32_t tip_ticks;   /* tip_age_max: a tip so old is unknown */
    uint8_t materials;    /* 1 .. 255 */
};

/* --- one finger --- */

/* A plane as the tick uses it: n.P_C + t is what matters of its point. */
struct exh_precontact_plane {
    int64_t offset_m_q60;       /* and half an LSB of d */
    struct exh_vec3 normal_q30; /* (0, 0, 0): no plane */
    uint16_t object;            /* of the plane told */
    uint8_t material;           /* index, below materials */
};

/* Where a finger is with its plane. */
enum exh_precontact_phase {
    EXH_PRECONTACT_IDLE,   /* no plane, or too old */
    EXH_PRECONTACT_INSIDE, /* born at d >= 0, and not late */
    EXH_PRECONTACT_TRACK,  /* q_lim moves along */
    EXH_PRECONTACT_FROZEN  /* q_lim stands */
};

/* A state of zeros is a finger that has been told nothing. The first four are the
 * results of exh_precontact_step(). */
struct exh_precontact {
    int32_t d_m_q30;                          /* INT32_MIN: there is no plane */
    int32_t lim_m_q30;                        /* q_lim */
    struct exh_material_par taken;            /* at the last freeze; zeros before */
    uint8_t phase;                            /* enum exh_precontact_phase */
    struct exh_precontact_plane newest, held; /* told last; frozen */
    uint32_t left_ticks;                      /* until the newest is too old */
    uint32_t frozen_n;                        /* freezes; this and the counts below modulo 2^32 */
    uint32_t born_n;                          /* planes born at d >= 0 that were not late */
    uint32_t refused_n;                       /* normal no unit vector, or no such material */
    uint32_t ignored_n;                       /* told while frozen, and not what was frozen */
    uint32_t stale_n;                         /* became too old while q_lim moved along */
    uint32_t doubt_ticks;                     /* in doubt on end */
    uint32_t let_go_n;                        /* contacts let go */
    uint32_t late_n;                          /* late contacts */
    int32_t late_m_q30;                       /* d of the last of them when it began, m */
    int32_t ahead_m_q30;                      /* q_lim - q at the last freeze, m */
    uint8_t met;                              /* 1: the world has spoken of the finger being free */
    uint8_t near;                             /* 1: 0 stands for d_lim */
    uint8_t late;                             /* 1: the rise of force is to be limited */
    uint8_t told;                             /* of the newest object: once, or 2: more often */
    uint8_t resumed;                          /* read from bytes, no step yet; not in the bytes */
};

/* What a tick goes by. */
struct exh_precontact_in {
    struct exh_vec3 tip_m_q30; /* P_F, of exh_hand_tip(); any values */
    struct exh_vec3 slope_q24; /* of exh_hand_tip_slope(); read with from_slope only */
    int32_t pos_m_q30;         /* q, the same that the contact law gets */
    uint32_t tip_age_ticks;    /* since P_F was measured; UINT32_MAX: it is unknown */
    uint8_t touching;          /* what the contact law returned last */
    uint8_t pulls;             /* 1: the permit is open */
    int32_t vel_mps_q27;       /* of q */
};

/* What a tick did. None of the first four: there is no plane, or no fingertip. */
enum exh_precontact_bit {
    EXH_PRECONTACT_STANDS = 1u << 0,  /* phase FROZEN */
    EXH_PRECONTACT_TRACKS = 1u << 1,  /* phase TRACK */
    EXH_PRECONTACT_AROUND = 1u << 2,  /* phase INSIDE, or it waits for being told again */
    EXH_PRECONTACT_STALE = 1u << 3,   /* phase IDLE: the newest plane is too old */
    EXH_PRECONTACT_BENT = 1u << 4,    /* s was limited: string and approach do not fit */
    EXH_PRECONTACT_FREEZE = 1u << 5,  /* frozen in this tick: `taken` is new */
    EXH_PRECONTACT_RELEASE = 1u << 6, /* released in this tick: the newest plane counts again,
                                         as one that has just come */
    EXH_PRECONTACT_BLIND = 1u << 7,   /* the fingertip is too old, or unknown */
    EXH_PRECONTACT_DOUBT = 1u << 8,   /* what stands is in doubt */
    EXH_PRECONTACT_LETGO = 1u << 9,   /* let go in this tick, RELEASE with it: no contact in
                                         this one; in the next the newest plane counts again */
    EXH_PRECONTACT_LATE = 1u << 10    /* a late contact: FREEZE with it in its first tick */
};

/* Set-up (divides); par and the materials must outlive cfg. pad_m_q30: the pad's radius t,
 * m, 0 .. 25 mm (exh_hand_par has it). -EXH_E_RATE: T. -EXH_E_RANGE: a parameter outside its range
 * above, or no material, or more than 255. Pad and its sign are those of planes told afterwards. */
int exh_precontact_setup(struct exh_precontact_cfg *cfg, const struct exh_precontact_par *par,
    const struct exh_material_par *material, unsigned materials, int32_t pad_m_q30,
    struct exh_period T);

/* What a message tells about this finger, age_ticks old; before the step of the tick. A frozen
 * finger's q_lim, material, distance and release do not depend on it. 0, or -EXH_E_RANGE for a
 * plane refused. */
int exh_precontact_update(struct exh_precontact *s, const struct exh_precontact_cfg *cfg,
    const struct exh_plane *plane, uint32_t age_ticks);

/* 1: no contact can be, exh_contact_step_free() is due; 0: one can be at lim_m_q30. */
static inline int exh_precontact_none(const struct exh_precontact *s)
{
    return s->phase < EXH_PRECONTACT_TRACK;
}

/* The peer is another one, or has started anew: what it says of a finger first is no late word. */
static inline void exh_precontact_forget(struct exh_precontact *s) { s->met = 0; }

/* The force of a late contact has come to what the law asks for: its rise was not limited in this
 * tick. */
static inline void exh_precontact_arrived(struct exh_precontact *s) { s->late = 0; }

/* Ticks that were missed, before tell() and step() of the next: the plane told last is so much
 * older, and a doubt has lasted so much longer. */
void exh_precontact_advance(struct exh_precontact *s, uint32_t missed);

/* One tick; call before the contact law and give it lim_m_q30. d is exact but for its one
 * rounding (1/2 LSB) and saturates at +-2 m; q_lim is within 1/2 LSB of q - s*d, and s of the
 * slope within 2^-25 + 2^-28*s; it saturates. Returns bits. With the law's own q, no input
 * makes the law touch before the freeze, but for q at the format's end while q_lim moves along. */
uint32_t exh_precontact_step(struct exh_precontact *s, const struct exh_precontact_cfg *cfg,
    const struct exh_precontact_in *in);

/* State through a cursor; what was read is brought back into range. A q_lim that was to be frozen
 * in the first tick after it is not if it touches at once: the plane counts as born there. */
void exh_precontact_serialize(struct exh_bytes *c, struct exh_precontact *s);

/* --- how far off to freeze, how far to look --- */

/* What moves how fast, and is known how late. */
struct exh_precontact_need {
    int32_t speed_mps_q27;  /* fastest approach, m/s, 0 .. 16 */
    int32_t lag_us;         /* of the fingertip behind the string: glove frame, filter */
    int32_t noise_m_q30;    /* of d, peak, m */
    int32_t age_us;         /* oldest the newest plane may be: frame + latency + jitter */
    int32_t object_mps_q27; /* speed of the object (or of the hand's base in the world), m/s */
    int32_t slide_m_q30;    /* tangential way from where the plane was taken to the contact, m */
    int32_t radius_m_q30;   /* of the object's surface, m; 0: plane */
};
/* What d_lim, ray and error come of it. */
struct exh_precontact_advice {
    int32_t d_lim_m_q30;   /* freeze no nearer than this: -(v*(T + lag) + noise) */
    int32_t ray_m_q30;     /* look at least this far: |d_lim| + v*(T + age) + noise */
    int32_t error_m_q30;   /* of q_lim/s at the freeze: v_object*age + slide^2 / (2*radius) */
    int32_t speed_mps_q27; /* fastest approach that the d_lim asked about allows */
};

/* Set-up or host (divides). d_lim_m_q30, < 0: the one to be judged, of which ray and speed are
 * told; it is too small if it is above advice->d_lim_m_q30. All rounded to the safe side, the
 * first within 2 LSB and 1 ns of motion. -EXH_E_RATE: T. -EXH_E_RANGE: a need below 0, lag or age
 * above 2 s, d_lim not below 0, or an answer beyond 2 m or 16 m/s (the speed stands at 16 m/s
 * instead). */
int exh_precontact_advise(struct exh_precontact_advice *advice,
    const struct exh_precontact_need *need, struct exh_period T, int32_t d_lim_m_q30);

#ifdef __cplusplus
}
#endif
#endif
