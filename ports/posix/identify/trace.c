/* SPDX-License-Identifier: MIT */
#include "identify/trace.h"

#include "identify/identify.h"

#include <stdlib.h>

int identify_trace(FILE *f, const struct identify_data *d, const struct model *m, unsigned round)
{
    const double mm = m->value[MODEL_STEP] * 1e3;
    float *q = calloc(d->n ? d->n : 1, sizeof *q);
    double off = 0, begin_s[IDENTIFY_STAGES] = {0};
    int first[IDENTIFY_STAGES] = {1, 1}, part = -1;
    if (q == NULL) { return -1; }
    model_run(m, 1, d, d->n, &q);
    fprintf(f, "stage,t_s,part,current_a,measured_mm,modelled_mm,apart_mm\n");
    for (size_t i = 0; i < d->n; i++) {
        const struct identify_sample *x = &d->sample[i];
        const double t_s = (double)i * d->T_s;
        if (!x->busy || x->repeat != round || x->stage >= IDENTIFY_STAGES) { continue; }
        if (first[x->stage]) {
            begin_s[x->stage] = t_s;
            first[x->stage] = 0;
            part = -1;
        }
        if (part != x->part) { off = x->cnt + 0.5 - (double)q[i]; }
        part = x->part;
        fprintf(f, "%u,%.5f,%u,%.6g,%.6g,%.6g,%.4g\n", x->stage, t_s - begin_s[x->stage], x->part,
            (double)x->coded_A, -(x->cnt + 0.5) * mm, -((double)q[i] + off) * mm,
            (x->cnt + 0.5 - (double)q[i] - off) * mm);
    }
    free(q);
    return 0;
}
