/* SPDX-License-Identifier: MIT */
/* Included with T (a type), N(name) (its functions' names), SIN, COS and FLOOR. */

/* --- a finger --- */

void N2(wall, start)(
    struct N(wall) * s, const struct pipe_wall_par *p, const struct pipe_wall_now *now)
{
    const struct N(wall) zero = {0};
    *s = zero;
    s->step = (T)p->step_m;
    s->rate = (T)(1 / (p->period_s * p->window));
    s->speed = (T)p->speed_mps;
    s->k = (T)p->k_Npm;
    s->b = (T)p->b_Nspm;
    s->f0 = (T)p->f0_N;
    s->band = (T)p->band_m;
    s->hyst = (T)p->hyst_m;
    s->f_max = (T)p->f_max_N;
    s->up = (T)(p->up_Nps * p->period_s);
    s->down = (T)(p->down_Nps * p->period_s);
    s->A_per_N = (T)p->A_per_N;
    s->code_per_A = (T)p->code_per_A;
    s->way = (T)p->way_m;
    s->n = p->window;
    for (int i = 0; i < 16; i++) { s->cnt[i] = now->cnt; }
    s->last = now->cnt;
    s->turn = (T)now->turn_m;
    s->force = (T)now->force_N;
    s->inward = now->inward;
    s->touching = now->touching;
    s->rest = now->rest_ticks;
    s->rest_most = p->rest_ticks;
    s->out = s->turn;
}

/* The energy of the contact, and the force that it allows. */
static T N(passive)(struct N(wall) * s, int32_t cnt, int touching, T asked)
{
    T limit = s->f_max;
    s->energy += s->held * (T)(cnt - s->last) * s->step;
    if (s->held <= 0 && (!touching || !s->energised)) { s->energy = 0; }
    s->energised = touching;
    if (s->energy >= 0) { return asked; }
    limit += s->energy / s->way;
    if (limit < 0) { limit = 0; }
    return asked > limit ? limit : asked;
}

/* A slack string does not run in without a pull. */
static void N(wind)(struct N(wall) * s)
{
    if (s->touching || s->inward || s->turn != s->out) {
        s->rest = 0;
    } else if (s->rest < s->rest_most) {
        s->rest++;
    } else {
        s->inward = 1;
    }
    s->out = s->turn;
}

/* From a count to the force commanded. */
T N(wall)(struct N(wall) * s, int32_t cnt, T lim)
{
    const T q = (T)cnt * s->step, back = s->inward ? q - s->turn : s->turn - q, past = q - lim;
    T v = (T)(cnt - s->cnt[s->at]) * s->step * s->rate, f = 0, least, most;
    s->cnt[s->at] = cnt;
    s->at = s->at + 1 == s->n ? 0 : s->at + 1;
    v = v > s->speed ? s->speed : v < -s->speed ? -s->speed : v;
    if (back > s->band) {
        s->inward = !s->inward;
        s->turn = q;
    } else if (back < 0) {
        s->turn = q;
    }
    s->touching = past >= 0 || (s->touching && past >= -s->hyst);
    if (s->touching) { f = s->k * past + s->b * v; }
    if (s->way > 0) { f = N(passive)(s, cnt, s->touching, f); }
    s->last = cnt;
    if (s->inward) { f += s->f0; }
    if (s->rest_most >= 0) { N(wind)(s); } /* for the next tick */
    f = f < 0 ? 0 : f > s->f_max ? s->f_max : f;
    least = s->force - s->down;
    most = s->force + s->up;
    f = f < least ? least : f > most ? most : f;
    if (s->way > 0) {
        const T code = FLOOR(f * s->A_per_N * s->code_per_A + (T)0.5);
        s->held = code / s->code_per_A / s->A_per_N - (s->inward ? s->f0 : 0);
        if (s->held < 0 || f <= (s->inward ? s->f0 : 0)) { s->held = 0; }
    }
    s->q = q;
    s->v = v;
    s->force = f;
    return f;
}

/* --- the glove --- */

void N2(glove, start)(struct N(glove) * s, const struct pipe_glove_par *p, const int16_t *raw)
{
    const long double g = tanl(3.14159265358979323846264338327950288L * p->fc_period);
    const long double d = 1 + g * (g + sqrtl(2));
    const struct N(glove) zero = {0};
    *s = zero;
    s->b0 = s->b2 = (T)(g * g / d);
    s->b1 = (T)(2 * g * g / d);
    s->a1 = (T)(2 * (g * g - 1) / d);
    s->a2 = (T)((1 + g * (g - sqrtl(2))) / d);
    for (int i = 0; i < PIPE_SENSORS; i++) {
        s->zero[i] = (T)p->zero[i];
        s->gain[i] = (T)p->rad_per_code[i];
        s->s2[i] = (s->b2 - s->a2) * (T)raw[i]; /* at rest */
        s->s1[i] = (s->b1 - s->a1) * (T)raw[i] + s->s2[i];
        for (int k = 0; k < 2; k++) {
            s->cross[i][k] = (T)p->cross[i][k];
            s->of[i][k] = p->of[i][k];
        }
    }
    for (int f = 0; f < PIPE_FINGERS; f++) {
        for (int k = 0; k < 3; k++) {
            s->bias[f][k] = (T)p->bias[f][k];
            s->lo[f][k] = (T)p->lo[f][k];
            s->hi[f][k] = (T)p->hi[f][k];
            s->len[f][k] = (T)p->len[f][k];
            s->base[f][k] = (T)p->base[f][k];
            for (int j = 0; j < 2; j++) {
                s->term[f][k][j] = (T)p->gain[f][k][j];
                s->sensor[f][k][j] = p->sensor[f][k][j];
            }
            for (int j = 0; j < 3; j++) { s->rot[f][k][j] = (T)p->rot[f][k][j]; }
        }
    }
}

static void N(tip)(struct N(glove) * s, int f)
{
    const T *q = s->joint[f];
    const T sine0 = SIN(q[0]), cosine0 = COS(q[0]), sine2 = SIN(q[2]), cosine2 = COS(q[2]);
    T sine = SIN(q[1]), cosine = COS(q[1]), out = s->len[f][0] * cosine, up = s->len[f][0] * sine;
    for (int i = 1; i < 3; i++) {
        const T turned = cosine * cosine2 - sine * sine2;
        sine = sine * cosine2 + cosine * sine2;
        cosine = turned;
        out += s->len[f][i] * cosine;
        up += s->len[f][i] * sine;
    }
    for (int i = 0; i < 3; i++) {
        s->tip[f][i] = s->base[f][i] + (s->rot[f][i][0] * cosine0 + s->rot[f][i][1] * sine0) * out +
                       s->rot[f][i][2] * up;
    }
}

/* From codes to angles, joints and fingertips. */
void N(glove)(struct N(glove) * s, const int16_t *raw)
{
    T own[PIPE_SENSORS];
    for (int i = 0; i < PIPE_SENSORS; i++) {
        const T x = (T)raw[i], y = s->b0 * x + s->s1[i];
        s->s1[i] = s->b1 * x - s->a1 * y + s->s2[i];
        s->s2[i] = s->b2 * x - s->a2 * y;
        own[i] = (y - s->zero[i]) * s->gain[i];
    }
    for (int i = 0; i < PIPE_SENSORS; i++) {
        s->angle[i] = own[i];
        for (int k = 0; k < 2; k++) {
            if (s->of[i][k] >= 0) { s->angle[i] += s->cross[i][k] * own[s->of[i][k]]; }
        }
    }
    for (int f = 0; f < PIPE_FINGERS; f++) {
        for (int k = 0; k < 3; k++) {
            T q = s->bias[f][k];
            for (int j = 0; j < 2; j++) { q += s->term[f][k][j] * s->angle[s->sensor[f][k][j]]; }
            s->joint[f][k] = q < s->lo[f][k] ? s->lo[f][k] : q > s->hi[f][k] ? s->hi[f][k] : q;
        }
        N(tip)(s, f);
    }
}

/* --- the plane --- */

void N2(plane, start)(struct N(plane) * s, const struct pipe_plane_par *p)
{
    long double offset = p->pad_m;
    for (int k = 0; k < 3; k++) {
        s->n[k] = (T)p->n[k];
        offset += p->n[k] * p->point[k];
    }
    s->offset = (T)offset;
    s->d_lim = (T)p->d_lim_m;
    s->hyst = (T)p->hyst_m;
    s->scale = (T)p->scale;
    s->d = -1;
    s->lim = 2;
    s->frozen = 0;
}

void N(plane)(struct N(plane) * s, const T tip[3], T q, int touching)
{
    s->d = s->offset - (s->n[0] * tip[0] + s->n[1] * tip[1] + s->n[2] * tip[2]);
    if (s->frozen && !touching && s->d < s->d_lim - s->hyst) { s->frozen = 0; }
    if (!s->frozen && s->d >= s->d_lim) { s->frozen = 1; }
    if (!s->frozen) { s->lim = q - s->scale * s->d; }
}
