/* SPDX-License-Identifier: MIT */
/* Units and fixed-point formats: the table of docs/NUMERICS.md as constants. A test compares them.
 *
 * A value in format qN is an int32_t that holds the quantity times 2^N. The range below is that of
 * the format. The range of a parameter is narrower; its row (signal.h) gives it.
 *
 *   quantity          unit    format  range       LSB
 *   position          m       q30     +-2         0.93 nm
 *   velocity          m/s     q27     +-16        7.5 nm/s
 *   force             N       q20     +-2048      0.95 uN
 *   current           A       q26     +-32        15 nA
 *   stiffness k       N/m     q10     0..2.1e6    0.98 mN/m
 *   damping b         Ns/m    q20     0..2048     0.95 uNs/m
 *   encoder step      m/count q42     0..488 um   0.23 pm
 *   D/A codes         1/A     q16     0..32767    1.5e-5
 *   monitor           A/code  q40     0..1.95 mA  0.91 pA
 *   force slew        N/s     q0      0..2.1e9    1
 *   angle             turn    q32     +-1/2       1.5 nrad
 *   glove code        codes   q16     +-32768     1.5e-5
 *   glove zero        codes   q15     +-32768     3.1e-5
 *   glove gain        turn/code q38   +-1/128     3.6e-12
 *   supply            V       q20     +-2048      0.95 uV
 *   supply scale      V/code  q30     +-2         0.93 nV
 *
 * Example: a stiffness of 1500 N/m, and the length per count of an encoder with 2000 counts per
 * turn on a pulley of 100.531 mm circumference:
 *
 *   int32_t k_Npm_q10 = EXH_Q(1500, 1, EXH_Q_K);
 *   int32_t step_m_q42 = EXH_Q(100531, 2000 * INT64_C(1000000), EXH_Q_STEP); */
#ifndef EXHAND_UNITS_H
#define EXHAND_UNITS_H

#include <stdint.h>

#define EXH_Q_POS    30 /* m */
#define EXH_Q_VEL    27 /* m/s */
#define EXH_Q_FORCE  20 /* N */
#define EXH_Q_CUR    26 /* A */
#define EXH_Q_K      10 /* N/m */
#define EXH_Q_B      20 /* Ns/m */
#define EXH_Q_STEP   42 /* m/count */
#define EXH_Q_DAC    16 /* codes/A */
#define EXH_Q_MON    40 /* A/code */
#define EXH_Q_TURN   32 /* turn */
#define EXH_Q_RAW    16 /* codes */
#define EXH_Q_ZERO   15 /* codes */
#define EXH_Q_TPRAW  38 /* turn/code */
#define EXH_Q_SUPPLY 20 /* V */
#define EXH_Q_VPRAW  30 /* V/code */

/* The ratio num/den in format q: an integer constant expression for initialisers, truncated towards
 * zero. The caller keeps |num| * 2^q below 2^63 and the result within int32_t. EXH_Q(20000, 1,
 * EXH_Q_K) is 20 kN/m, EXH_Q(7, 100, EXH_Q_POS) is 7 cm. */
#define EXH_Q(num, den, q) ((int32_t)((num) * (INT64_C(1) << (q)) / (den)))

/* The loop period in seconds, as the exact ratio of two integers: {1, 2000} is 2 kHz. It is the
 * value programmed into the timer, never a measured one (docs/DESIGN.md 4). */
struct exh_period {
    uint32_t num; /* 1 .. 2^32-1 */
    uint32_t den; /* num/den within 50 us .. 1 s */
};

/* A point or a direction. The name of the value gives its unit and format. */
struct exh_vec3 {
    int32_t x, y, z; /* in the coordinate frame that the owner documents */
};

/* The fingers of the device. All arrays of fingers have this order. */
enum exh_finger {
    EXH_THUMB,  /* 0 */
    EXH_INDEX,  /* 1 */
    EXH_MIDDLE, /* 2 */
    EXH_RING,   /* 3 */
    EXH_LITTLE  /* 4 */
};
#define EXH_FINGERS 5 /* length of every array of fingers */

/* Limits of ranges that several modules share. */
#define EXH_FORCE_MAX_N_Q20 EXH_Q(100, 1, EXH_Q_FORCE) /* highest force limit */
#define EXH_K_MAX_NPM_Q10   EXH_Q(1000000, 1, EXH_Q_K) /* stiffness */
#define EXH_B_MAX_NSPM_Q20  EXH_Q(1000, 1, EXH_Q_B)    /* damping */
#define EXH_PAD_MAX_M_Q30   EXH_Q(25, 1000, EXH_Q_POS) /* radius of a fingertip's pad */

/* Compile-time assertion in C99. The name must be unique in its scope. */
#define EXH_STATIC_ASSERT(name, cond) typedef char exh_static_##name[(cond) ? 1 : -1]

#endif
