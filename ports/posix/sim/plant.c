#include "plant.h"

#define TWO_PI 6.283185307179586

double sim_exp_neg(double x)
{
    /* e^-x = e^-k (e^-f/4)^4, k whole, f < 1; Pade (5,5) on f/4. */
    const int k = x < 700 ? (int)x : 700;
    const double f = (x - k) / 4;
    const double even = 30240 + f * f * (3360 + 30 * f * f);
    const double odd = f * (15120 + f * f * (420 + f * f));
    double e = (even - odd) / (even + odd);
    double power = 0.36787944117144233; /* e^-1 */
    if (x > 700) { return 0; }
    e *= e;
    e *= e;
    for (int n = k; n > 0; n /= 2) {
        if (n % 2) { e *= power; }
        power *= power;
    }
    return e;
}

/* Dry friction may take up to `most` off a velocity, never turn it. */
static double shrink(double v, double most)
{
    return v > most ? v - most : v < -most ? v + most : 0;
}

/* What stays the same from sub-step to sub-step of h_s. */
struct step {
    double h_s, ref_A, kf_npa;
    double keep_cur, keep_mon;
    double h_mass, h_rotor; /* of a force, the change of speed                     */
    double viscous; /* implicit                                            */
};

static struct step step_of(const struct sim_device *d, double h_s, double ref_A)
{
    struct step s;
    s.h_s = h_s;
    s.ref_A = ref_A;
    s.kf_npa = d->kf_npa;
    s.keep_cur = sim_exp_neg(TWO_PI * d->current_hz * h_s);
    s.keep_mon = d->mon_lag_s > 0 ? sim_exp_neg(h_s / d->mon_lag_s) : 0;
    s.h_mass = h_s / d->mass_kg;
    s.h_rotor = h_s / d->rotor_kg;
    s.viscous = 1 / (1 + s.h_rotor * d->viscous_nspm);
    return s;
}

static void step_current(struct plant *p, const struct step *s)
{
    p->cur_A = s->ref_A + (p->cur_A - s->ref_A) * s->keep_cur;
    p->mon_A = p->cur_A + (p->mon_A - p->cur_A) * s->keep_mon;
}

/* push_mps: what a force besides the string adds to the mass's speed; damp: what that force's
 * own damping leaves of it (implicit). */
static inline void step_string(struct plant *p, const struct sim_device *d, const struct step *s,
                               double push_mps, double damp)
{
    const double stretch = p->x_m - p->q_m;
    double T = d->cable_npm * stretch + d->cable_nspm * (p->v_mps - p->w_mps);
    if (stretch < 0 || T < 0) { T = 0; }
    p->v_mps = shrink((p->v_mps + push_mps - s->h_mass * T) * damp, s->h_mass * d->mu_mass * T);
    p->w_mps = shrink((p->w_mps + s->h_rotor * (T - s->kf_npa * p->cur_A)) * s->viscous,
                      s->h_rotor * (d->coulomb_n + d->mu_motor * T));
    p->x_m += s->h_s * p->v_mps;
    p->q_m += s->h_s * p->w_mps;
}

void plant_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A, int held)
{
    const int n = (int)(dt_s / d->substep_s) + 1;
    const struct step s = step_of(d, dt_s / n, ref_A);
    for (int i = 0; i < n; i++) {
        step_current(p, &s);
        if (!held) { step_string(p, d, &s, s.h_s * SIM_GRAVITY, 1); }
    }
}

/* Of the stretch s of a taut string, friction with its motion: s'' = -w2 s - c s'. Positions by the new
 * speeds, c explicit: stable while h^2 w2 + 2 h c < 4. Viscous friction and the hand's are implicit. */
static int step_ok(const struct sim_device *d, double hand_npm, double h_s)
{
    const double per_kg = (1 + d->mu_mass) / d->mass_kg + (1 + d->mu_motor) / d->rotor_kg;
    const double w2 = d->cable_npm * per_kg + hand_npm / d->mass_kg, c = d->cable_nspm * per_kg;
    const double twice_s = 2 * h_s;
    return twice_s * twice_s * w2 + 2 * twice_s * c <= 4;
}

int plant_step_will_do(const struct sim_device *d, double hand_npm)
{
    return step_ok(d, hand_npm, d->substep_s);
}

double plant_step_that_will_do(const struct sim_device *d, double hand_npm)
{
    static const double step_s[] = {1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2e-7, 1e-7};
    for (unsigned i = 0; i < sizeof step_s / sizeof step_s[0]; i++) {
        if (step_ok(d, hand_npm, step_s[i])) { return step_s[i]; }
    }
    return 0;
}

static inline void stop(double *x_m, double *v_mps, double end_m)
{
    if (*x_m >= end_m) { return; }
    *x_m = end_m;
    if (*v_mps < 0) { *v_mps = 0; }
}

void plant_advance_hand(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
                        const struct plant_hand *hand)
{
    const int n = (int)(dt_s / d->substep_s) + 1;
    const struct step s = step_of(d, dt_s / n, ref_A);
    const double damp = 1 / (1 + s.h_mass * hand->b_Nspm);
    for (int i = 0; i < n; i++) {
        const double ahead_m = hand->x_m + (i + 1) * s.h_s * hand->v_mps - p->x_m;
        step_current(p, &s);
        step_string(p, d, &s, s.h_mass * (hand->k_Npm * ahead_m + hand->b_Nspm * hand->v_mps),
                    damp);
        stop(&p->x_m, &p->v_mps, hand->end_m);
        stop(&p->q_m, &p->w_mps, hand->end_m);
    }
}
