/* SPDX-License-Identifier: MIT */
/* Held: a finger before a wall that the box knows, as a bilateral contact is once q_lim is frozen.
 * The library's own modules in the scene's order, with estimators and laws that the scene does not
 * link. */
#ifndef LAB_CONTACT_HELD_H
#define LAB_CONTACT_HELD_H

#include "box/hand.h"

enum held_estimator {
    HELD_WINDOW, /* of: p of its 2^p ticks */
    HELD_POLE,   /* of: tau, us */
    HELD_FOAW,   /* of: longest window, ticks */
    HELD_TRACK,  /* of: T_f, us */
    HELD_EDGES   /* time between two edges of the encoder, whole ticks; of: longest, ticks */
};

enum held_damper {
    HELD_EVERY, /* the velocity as it is */
    HELD_STILL, /* 0 up to one count over the estimator's window */
    HELD_PLAY   /* of a count with one count of play */
};

struct held_law {
    const char *name;
    uint32_t rate_Hz;
    int decode; /* counts an encoder line */
    double k_Npm, b_Nspm;
    enum held_estimator estimator;
    int of; /* of the estimator, above */
    enum held_damper damper;
    double hyst_m;              /* of the contact */
    int passivity;              /* exh_passivity_par.on */
    double pulse_Nspm, pulse_s; /* the speed of the impact times this, for so long */
    int32_t lim_m_q30;          /* 0: where the wall is */
};

/* The run of the index before its wall, samples kept for bilateral_judge(). work_J: unless NULL,
 * the wall's work on the string up to each sample; freed by the caller. 0 or -EXH_E_... */
int held_run(const struct held_law *law, const struct bilateral_run_cfg *c, struct bilateral_run *r,
    double **work_J);

#endif
