/* SPDX-License-Identifier: MIT */
/* FMI 3.0, Co-Simulation, over a unit. One instance a process: a scene is one static instance. */
#include "unit.h"

#include "exhand/error.h"

#include "fmi3Functions.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct {
    int used, initialising, running;
    fmi3InstanceEnvironment env;
    fmi3LogMessageCallback log;
    uint64_t step;
    double start_s;
} fmu;

static fmi3Status fail(const char *format, ...)
{
    char text[256];
    va_list args;
    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (fmu.log) { fmu.log(fmu.env, fmi3Error, "logStatusError", text); }
    return fmi3Error;
}

/* --- life --- */

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(
    fmi3Instance instance, fmi3Boolean loggingOn, size_t nCategories, const fmi3String categories[])
{
    (void)instance, (void)loggingOn, (void)nCategories, (void)categories;
    return fmi3OK;
}

static void reset(void)
{
    fmu.initialising = fmu.running = 0;
    fmu.step = 0;
    unit_reset();
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String instanceName, fmi3String instantiationToken,
    fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed,
    fmi3Boolean earlyReturnAllowed, const fmi3ValueReference requiredIntermediateVariables[],
    size_t nRequiredIntermediateVariables, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3IntermediateUpdateCallback intermediateUpdate)
{
    char token[64];
    (void)instanceName, (void)resourcePath, (void)visible, (void)loggingOn,
        (void)earlyReturnAllowed;
    (void)requiredIntermediateVariables, (void)intermediateUpdate;
    fmu.env = instanceEnvironment;
    fmu.log = logMessage;
    (void)snprintf(token, sizeof token, "%s-%08lx", unit_name, (unsigned long)FMI_TOKEN);
    if (instantiationToken == NULL || strcmp(instantiationToken, token) != 0) {
        (void)fail("instantiationToken: %s: this binary is of %s: build it from its own sources",
            instantiationToken ? instantiationToken : "none", token);
        return NULL;
    }
    if (fmu.used || eventModeUsed || nRequiredIntermediateVariables) {
        (void)fail(fmu.used ? "one instance a process: free the other first"
                            : "no event mode, no intermediate variables");
        return NULL;
    }
    fmu.used = 1;
    reset();
    return &fmu;
}

void fmi3FreeInstance(fmi3Instance instance)
{
    if (instance) { fmu.used = 0; }
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined,
    fmi3Float64 tolerance, fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    (void)instance, (void)toleranceDefined, (void)tolerance, (void)stopTimeDefined, (void)stopTime;
    fmu.initialising = 1;
    fmu.start_s = startTime;
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    const char *which;
    const int err = unit_start(&which);
    (void)instance;
    fmu.initialising = 0;
    fmu.running = err == 0;
    return err < 0 ? fail("%s, period %lu/%lu s: refused, %d", which,
                         (unsigned long)unit_period().num, (unsigned long)unit_period().den, err)
                   : fmi3OK;
}

fmi3Status fmi3Terminate(fmi3Instance instance)
{
    (void)instance;
    fmu.running = 0;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance instance)
{
    (void)instance;
    reset();
    return fmi3OK;
}

/* --- values --- */

/* The variable of this reference and type, or -1 after a message. */
static int32_t variable(fmi3ValueReference vr, enum unit_type type, struct unit_var *v)
{
    if (vr < unit_vars()) {
        unit_var(vr, v);
        if (v->type == type) { return (int32_t)vr; }
    }
    (void)fail("value reference %lu: none of this type", (unsigned long)vr);
    return -1;
}

static fmi3Status set(fmi3ValueReference vr, enum unit_type type, double value)
{
    struct unit_var v;
    const int32_t i = variable(vr, type, &v);
    const int err = i < 0 ? 0 : unit_set((uint32_t)i, value);
    if (i < 0) { return fmi3Error; }
    if (err == -EXH_E_RANGE) {
        return fail("%s: %.17g (%.9g..%.9g %s): give one in that range", v.name, value, v.min,
            v.max, v.unit);
    }
    if (err < 0 && v.role == UNIT_OUTPUT) {
        return fail("%s: an output: it cannot be set", v.name);
    }
    return err < 0 ? fail("%s: %.17g: not now: before the first step", v.name, value) : fmi3OK;
}

/* The independent variable, time, follows all others. */
static double time_s(void)
{
    const struct exh_period T = unit_period();
    return fmu.start_s + (double)fmu.step * (double)T.num / (double)T.den;
}

static fmi3Status get(fmi3ValueReference vr, enum unit_type type, double *value)
{
    struct unit_var v;
    const int is_time = type == UNIT_FLOAT64 && vr == unit_vars();
    const int32_t i = is_time ? 0 : variable(vr, type, &v);
    if (i < 0) { return fmi3Error; }
    *value = is_time ? time_s() : unit_get((uint32_t)i);
    return fmi3OK;
}

#define VALUES(T, TYPE) \
    fmi3Status fmi3Get##T(fmi3Instance instance, const fmi3ValueReference vr[], size_t n, \
        fmi3##T values[], size_t nValues) \
    { \
        (void)instance; \
        for (size_t k = 0; k < n && k < nValues; k++) { \
            double v; \
            if (get(vr[k], TYPE, &v) != fmi3OK) { return fmi3Error; } \
            values[k] = (fmi3##T)v; \
        } \
        return n == nValues ? fmi3OK : fail("%zu values for %zu variables", nValues, n); \
    } \
    fmi3Status fmi3Set##T(fmi3Instance instance, const fmi3ValueReference vr[], size_t n, \
        const fmi3##T values[], size_t nValues) \
    { \
        (void)instance; \
        for (size_t k = 0; k < n && k < nValues; k++) { \
            if (set(vr[k], TYPE, values[k]) != fmi3OK) { return fmi3Error; } \
        } \
        return n == nValues ? fmi3OK : fail("%zu values for %zu variables", nValues, n); \
    }
VALUES(Int32, UNIT_INT32)
VALUES(Float64, UNIT_FLOAT64)

/* --- steps --- */

/* Whole periods only: a step of several is as many ticks with the same inputs. */
fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint,
    fmi3Float64 communicationStepSize, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
    fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation, fmi3Boolean *earlyReturn,
    fmi3Float64 *lastSuccessfulTime)
{
    const struct exh_period T = unit_period();
    const double periods = communicationStepSize * (double)T.den / (double)T.num;
    const uint64_t n = periods > 0.5 && periods < 1e9 ? (uint64_t)(periods + 0.5) : 0;
    (void)instance, (void)currentCommunicationPoint, (void)noSetFMUStatePriorToCurrentPoint;
    *eventHandlingNeeded = *terminateSimulation = *earlyReturn = fmi3False;
    if (!fmu.running) { return fail("a step before initialisation, or after its end"); }
    if (n == 0 || periods - (double)n > 1e-3 || (double)n - periods > 1e-3) {
        return fail("communicationStepSize: %.17g s (whole periods of %lu/%lu s): give period_num "
                    "and period_den, or another step",
            communicationStepSize, (unsigned long)T.num, (unsigned long)T.den);
    }
    for (uint64_t k = 0; k < n; k++) {
        const int err = unit_step();
        if (err < 0) { return fail("step %lu: %d", (unsigned long)fmu.step, err); }
        fmu.step++;
    }
    *lastSuccessfulTime = time_s();
    return fmi3OK;
}

/* --- the whole state, as bytes --- */

struct kept {
    uint64_t step;
    double start_s;
    uint32_t len_B, running;
    uint8_t byte[];
};

static uint32_t state_B(void)
{
    struct exh_bytes c = exh_bytes_writer(NULL, 0);
    unit_bytes(&c);
    return c.at;
}

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *state)
{
    const uint32_t n = state_B();
    struct kept *k = *state ? (struct kept *)*state : malloc(sizeof *k + n);
    struct exh_bytes c;
    (void)instance;
    if (k == NULL) { return fail("no memory for a state of %lu bytes", (unsigned long)n); }
    c = exh_bytes_writer(k->byte, n);
    unit_bytes(&c);
    k->step = fmu.step;
    k->start_s = fmu.start_s;
    k->len_B = n;
    k->running = (uint32_t)fmu.running;
    *state = k;
    return exh_bytes_ok(&c) ? fmi3OK : fail("state: too long");
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state)
{
    const struct kept *k = state;
    struct exh_bytes c = exh_bytes_reader(k->byte, k->len_B);
    (void)instance;
    unit_bytes(&c);
    fmu.step = k->step;
    fmu.start_s = k->start_s;
    fmu.running = k->running && exh_bytes_ok(&c) && c.at == k->len_B;
    return exh_bytes_ok(&c) && c.at == k->len_B
               ? fmi3OK
               : fail("state: not one of this unit: it is of no more use without a reset");
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state)
{
    (void)instance;
    if (state) {
        free(*state);
        *state = NULL;
    }
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t *size)
{
    const struct kept *k = state;
    (void)instance;
    *size = sizeof *k + k->len_B;
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(
    fmi3Instance instance, fmi3FMUState state, fmi3Byte serializedState[], size_t size)
{
    const struct kept *k = state;
    (void)instance;
    if (size != sizeof *k + k->len_B) {
        return fail("state: %zu bytes, not %zu", size, sizeof *k + k->len_B);
    }
    memcpy(serializedState, k, size);
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(
    fmi3Instance instance, const fmi3Byte serializedState[], size_t size, fmi3FMUState *state)
{
    struct kept *k;
    (void)instance;
    if (size != sizeof *k + state_B()) {
        return fail("state: %zu bytes, not %zu", size, sizeof *k + state_B());
    }
    k = malloc(size);
    if (k == NULL) { return fail("no memory for a state of %zu bytes", size); }
    memcpy(k, serializedState, size);
    k->len_B = (uint32_t)(size - sizeof *k);
    *state = k;
    return fmi3OK;
}
