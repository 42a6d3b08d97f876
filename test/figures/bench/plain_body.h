/* SPDX-License-Identifier: MIT */
/* Included with T (a type), N(name) (its functions' names), SIN and COS. */

/* y at x: the knots are evenly spaced or not, the last one below x is looked for. */
T N(table)(const struct N(table) * t, T x)
{
    unsigned k = 0;
    if (x <= t->x[0]) { return t->y[0]; }
    if (x >= t->x[15]) { return t->y[15]; }
    while (x >= t->x[k + 1]) { k++; }
    return t->y[k] + (x - t->x[k]) * t->slope[k];
}

#if __STDC_HOSTED__
/* Sines of sums out of those of the joints: three calls of each a finger. */
void N(tip)(const struct N(bones) * b, const T q[3], T tip[3])
{
    const T sine0 = SIN(q[0]), cosine0 = COS(q[0]), sine2 = SIN(q[2]), cosine2 = COS(q[2]);
    T sine = SIN(q[1]), cosine = COS(q[1]), out = b->len[0] * cosine, up = b->len[0] * sine;
    for (int i = 1; i < 3; i++) {
        const T turned = cosine * cosine2 - sine * sine2;
        sine = sine * cosine2 + cosine * sine2;
        cosine = turned;
        out += b->len[i] * cosine;
        up += b->len[i] * sine;
    }
    for (int i = 0; i < 3; i++) {
        tip[i] =
            b->base[i] + (b->rot[i][0] * cosine0 + b->rot[i][1] * sine0) * out + b->rot[i][2] * up;
    }
}
#endif

/* Distance to the plane. The virtual contact moves along until d_lim, then it is fixed until the
 * finger has left. */
void N(freeze)(struct N(freeze) * s, const T tip[3], T pos, int touching)
{
    s->d = s->offset - (s->n[0] * tip[0] + s->n[1] * tip[1] + s->n[2] * tip[2]);
    if (s->frozen && !touching && s->d < s->d_lim - s->hyst) { s->frozen = 0; }
    if (!s->frozen && s->d >= s->d_lim) { s->frozen = 1; }
    if (!s->frozen) { s->lim = pos - s->d; }
}

/* Energy that a contact has taken up, and the force that it may still give. */
T N(energy)(struct N(energy) * s, int32_t cnt, int touching, T asked)
{
    T limit = s->f_most;
    s->energy += s->held * (T)(cnt - s->cnt) * s->step;
    if (s->held <= 0 && (!touching || !s->touching)) { s->energy = 0; }
    s->cnt = cnt;
    s->touching = touching;
    if (s->energy < 0) { limit += s->energy / s->way; }
    if (limit < 0) { limit = 0; }
    return asked > limit && s->energy < 0 ? limit : asked;
}

/* --- velocity --- */

T N(pole)(struct N(pole) * s, T pos)
{
    s->v = s->keep * s->v + s->gain * (pos - s->pos);
    s->pos = pos;
    return s->v;
}

T N(window)(struct N(window) * s, T pos)
{
    const unsigned at = s->at;
    const T v = (pos - s->pos[at]) * s->gain;
    s->pos[at] = pos;
    s->at = at + 1 == s->n ? 0 : at + 1;
    return v;
}

/* First-order adaptive window: the longest whose straight line through its ends passes all samples
 * within a band of one encoder step. */
T N(foaw)(struct N(foaw) * s, T pos)
{
    T v = 0;
    unsigned n;
    for (n = 1; n <= s->have; n++) {
        const T slope = (pos - s->pos[(s->at - n) & 15]) / (T)n;
        unsigned k;
        for (k = 1; k < n; k++) {
            const T off = s->pos[(s->at - k) & 15] - (pos - (T)k * slope);
            if (off > s->band || off < -s->band) { break; }
        }
        if (k < n) { break; }
        v = slope * s->rate;
    }
    s->pos[s->at & 15] = pos;
    s->at++;
    if (s->have < 16) { s->have++; }
    return v;
}
