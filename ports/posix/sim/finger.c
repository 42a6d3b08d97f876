/* SPDX-License-Identifier: MIT */
/* Every parameter of a finger in the exoskeleton, with unit, range and how sure we are.
 *
 * - unsure: no data of a hand in this device exist. The middle of nine cases in a study of the
 *   bilateral contact: 0.05, 0.1, 0.2 kg; 150, 300, 600 N/m; 2, 5, 10 Ns/m. They fit a finger of
 *   3e-5..1e-4 kg m^2 about its knuckle with 0.3..3 Nm/rad and 0.005..0.05 Nms/rad. The arms turn
 *   the knuckle by 17 and the other joints by 24 rad per metre of string. The range is from a
 *   child's relaxed finger to a clenched hand with the exoskeleton.
 * - ours: a choice of the simulation.
 * - lib: the library's default for the same quantity (hand.h), which is a guess.
 */
#include "finger.h"

#include "codes.h"
#include "grid.h"

#define PIECE_S 600e-6 /* the target moves on a straight line for no longer */
#define FAR_S   1e30
#define LONG_S  0.5
#define NOTHING 1e-300 /* a smaller number may cost a processor 100 times as much */

const struct sim_device_row sim_finger_row[] = {
    {"mass", "kg", 0.1, 0.005, 1, "unsure", "finger and exoskeleton, reflected to the string"},
    {"hand_k", "n_per_m", 300, 10, 5000, "unsure", "the hand's stiffness at the string"},
    {"hand_b", "ns_per_m", 5, 0, 100, "unsure", "the hand's damping at the string"},
    {"learned", "", 1, 0, 1, "ours", "how much of the load of free movement the hand reckons with"},
    {"arm1", "m", 0.020, 0.002, 0.05, "lib", "string per radian of the knuckle"},
    {"arm2", "m", 0.016, 0.002, 0.05, "lib", "of the joint beyond it"},
    {"arm3", "m", 0.012, 0, 0.05, "lib", "of the last joint, which bends as that one does"},
};
SIM_ROWS(sim_finger_par, sim_finger_row);

struct sim_finger_par sim_finger_default(void)
{
    struct sim_finger_par p;
    sim_rows_default(&p, sim_finger_row, sim_finger_rows);
    return p;
}

int sim_finger_set(
    struct sim_finger_par *p, const char *name, double value, const struct sim_device_row **row)
{
    return sim_rows_set(p, sim_finger_row, sim_finger_rows, name, value, row);
}

/* Drawn out steadily, T = F + mu_motor T at the rotor, and the finger pulls (1 + mu_mass) T. */
static struct sim_path_load load_of(const struct sim_finger_par *p, const struct sim_device *d)
{
    const double rub = d->mu_motor < 0.9 ? (1 + d->mu_mass) / (1 - d->mu_motor) : 1;
    const struct sim_path_load load = {p->learned * (p->mass_kg + rub * d->rotor_kg),
        p->learned * rub * d->viscous_nspm, p->learned * rub * d->coulomb_n,
        p->learned * p->mass_kg, p->k_Npm, p->b_Nspm};
    return load;
}

void sim_finger_start(struct sim_finger *f, const struct sim_finger_par *par,
    const struct sim_path_par *path, const struct sim_path_record *record,
    const struct sim_device *d, uint64_t seed)
{
    const struct sim_finger none = {.par = *par};
    const struct sim_path_load load = load_of(par, d);
    const double rest = par->arm_m[1] + par->arm_m[2];
    const double square = par->arm_m[0] * par->arm_m[0] + rest * rest;
    *f = none;
    f->device = *d;
    f->device.mass_kg = par->mass_kg;
    f->rng.state = seed;
    f->bend_radpm[0] = par->arm_m[0] / square;
    f->bend_radpm[1] = rest / square;
    sim_path_start(&f->path, path, &load, record, sim_random_u64(&f->rng));
    f->lead_left = 1;
    f->hand = (struct plant_hand){par->k_Npm, par->b_Nspm, sim_path_at(&f->path, 0), 0, 0};
    f->plant.x_m = f->plant.q_m = f->hand.x_m;
    f->grid = sim_random_unit(&f->rng);
    f->servo_s = sim_random_unit(&f->rng) / d->servo_hz;
    f->sample_s = FAR_S;
}

void sim_finger_latch(struct sim_finger *f, double at_s, double ref_A)
{
    if (f->sample_s <= at_s) { sim_finger_advance(f, f->sample_s); }
    f->latched_A = ref_A;
    f->sample_s = ref_A != f->ref_A ? sim_servo_s(f->servo_s, f->device.servo_hz, at_s) : FAR_S;
}

void sim_finger_safe(struct sim_finger *f)
{
    f->latched_A = f->ref_A = 0;
    f->sample_s = FAR_S;
}

static double earlier(double a, double b) { return a < b ? a : b; }

/* From step to step, which takes no exponential. A long lag's rest is large and almost cancels, so
 * each of its last bits counts: it is computed anew. */
static void carry_lead(struct sim_finger *f, double to_s, double dt_s)
{
    const struct sim_lag *l = &f->path.e;
    if (l->tau_s > LONG_S) {
        f->lead_left = sim_exp_neg((to_s - l->x.start_s) / l->tau_s);
    } else if (dt_s > 0) {
        f->lead_left *= sim_decay_at(&f->lead, l->tau_s, dt_s);
    }
    if (f->lead_left < NOTHING) { f->lead_left = 0; }
}

/* Advances the finger alone to the next event. */
static void advance_plant(struct sim_finger *f, double to_s)
{
    const double grid_s = sim_grid(to_s), dt_s = grid_s - f->grid_s;
    double at_m;
    carry_lead(f, to_s, dt_s);
    at_m = sim_path_left(&f->path, to_s, f->lead_left);
    f->hand.v_mps = (at_m - f->hand.x_m) / (to_s - f->now_s);
    f->now_s = to_s;
    f->grid_s = grid_s;
    if (dt_s > 0) {
        plant_advance_hand_piece(&f->plant, &f->device,
            plant_pieces_find(&f->pieces, &f->device, dt_s, f->hand.b_Nspm), f->ref_A, &f->hand);
    }
    f->hand.x_m = at_m;
}

/* The path's next phase or row. Inline, this rare part would take the loop's registers. */
__attribute__((noinline)) static double turn(struct sim_finger *f)
{
    sim_path_advance(&f->path, f->now_s);
    f->lead_left = 1;
    f->hand.x_m = sim_path_at(&f->path, f->now_s);
    return sim_path_next_s(&f->path);
}

void sim_finger_advance(struct sim_finger *f, double until_s)
{
    double turn_s = sim_path_next_s(&f->path);
    while (f->now_s < until_s) {
        const double from_s = f->now_s;
        double to_s = earlier(earlier(until_s, from_s + PIECE_S), f->sample_s);
        if (turn_s <= from_s) { turn_s = turn(f); }
        to_s = earlier(to_s, turn_s);
        if (to_s > from_s) { advance_plant(f, to_s); }
        if (f->sample_s <= f->now_s) {
            f->ref_A = f->latched_A;
            f->sample_s = FAR_S;
        }
    }
}

void sim_finger_read(struct sim_finger *f, double jitter_cnt, uint32_t *enc_raw, int16_t *mon_raw)
{
    double jitter = 0;
    *mon_raw = sim_monitor_raw(&f->device, f->plant.mon_A, &f->rng);
    if (jitter_cnt > 0) { jitter = jitter_cnt * (sim_random_unit(&f->rng) - 0.5); }
    *enc_raw = sim_encoder_raw(&f->device, f->plant.q_m, f->grid, jitter);
}

double sim_finger_push_N(const struct sim_finger *f)
{
    const double h = 1e-6; /* of the target's speed: where it was, unless it has just begun */
    const double before_s = f->now_s - h > f->path.x.start_s ? f->now_s - h : f->path.x.start_s;
    const double at_m = sim_path_at(&f->path, f->now_s);
    const double v_mps =
        f->now_s > before_s ? (at_m - sim_path_at(&f->path, before_s)) / (f->now_s - before_s) : 0;
    return f->par.k_Npm * (at_m - f->plant.x_m) + f->par.b_Nspm * (v_mps - f->plant.v_mps);
}
