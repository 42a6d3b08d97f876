/* SPDX-License-Identifier: MIT */
/* Functions that a unit does not support: model exchange, scheduled execution, clocks, derivatives,
 * variables of other types. Importers look up all names of FMI, so all are here and return an
 * error. */
#include "fmi3Functions.h"

#include <stddef.h>

static fmi3Status none(fmi3Instance instance, ...)
{
    (void)instance;
    return fmi3Error;
}

#define NO(name, args, passed) \
    fmi3Status name args { return none passed; }
#define REFS fmi3Instance i, const fmi3ValueReference r[], size_t n

fmi3Instance fmi3InstantiateModelExchange(fmi3String a, fmi3String b, fmi3String c, fmi3Boolean d,
    fmi3Boolean e, fmi3InstanceEnvironment f, fmi3LogMessageCallback g)
{
    (void)a, (void)b, (void)c, (void)d, (void)e, (void)f, (void)g;
    return NULL;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String a, fmi3String b, fmi3String c,
    fmi3Boolean d, fmi3Boolean e, fmi3InstanceEnvironment f, fmi3LogMessageCallback g,
    fmi3ClockUpdateCallback h, fmi3LockPreemptionCallback i, fmi3UnlockPreemptionCallback j)
{
    (void)a, (void)b, (void)c, (void)d, (void)e, (void)f, (void)g, (void)h, (void)i, (void)j;
    return NULL;
}

/* Variables of other types. */
#define NO_VALUES(T) \
    NO(fmi3Get##T, (REFS, fmi3##T v[], size_t m), (i, r, n, v, m)) \
    NO(fmi3Set##T, (REFS, const fmi3##T v[], size_t m), (i, r, n, v, m))
NO_VALUES(Float32)
NO_VALUES(Int8)
NO_VALUES(UInt8)
NO_VALUES(Int16)
NO_VALUES(UInt16)
NO_VALUES(UInt32)
NO_VALUES(Int64)
NO_VALUES(UInt64)
NO_VALUES(Boolean)
NO_VALUES(String)
NO(fmi3GetBinary, (REFS, size_t s[], fmi3Binary v[], size_t m), (i, r, n, s, v, m))
NO(fmi3SetBinary, (REFS, const size_t s[], const fmi3Binary v[], size_t m), (i, r, n, s, v, m))
NO(fmi3GetClock, (REFS, fmi3Clock v[]), (i, r, n, v))
NO(fmi3SetClock, (REFS, const fmi3Clock v[]), (i, r, n, v))

/* Dependencies and derivatives. */
#define PARTIAL \
    (fmi3Instance i, const fmi3ValueReference u[], size_t n, const fmi3ValueReference k[], \
        size_t m, const fmi3Float64 s[], size_t l, fmi3Float64 d[], size_t o)
NO(fmi3GetNumberOfVariableDependencies, (fmi3Instance i, fmi3ValueReference r, size_t *n),
    (i, r, n))
NO(fmi3GetVariableDependencies,
    (fmi3Instance i, fmi3ValueReference d, size_t e[], fmi3ValueReference s[], size_t f[],
        fmi3DependencyKind k[], size_t n),
    (i, d, e, s, f, k, n))
NO(fmi3GetDirectionalDerivative, PARTIAL, (i, u, n, k, m, s, l, d, o))
NO(fmi3GetAdjointDerivative, PARTIAL, (i, u, n, k, m, s, l, d, o))
NO(fmi3GetOutputDerivatives, (REFS, const fmi3Int32 o[], fmi3Float64 v[], size_t m),
    (i, r, n, o, v, m))

/* Modes, clocks, events. */
NO(fmi3EnterConfigurationMode, (fmi3Instance i), (i))
NO(fmi3ExitConfigurationMode, (fmi3Instance i), (i))
NO(fmi3EnterEventMode, (fmi3Instance i), (i))
NO(fmi3EnterStepMode, (fmi3Instance i), (i))
NO(fmi3GetIntervalDecimal, (REFS, fmi3Float64 v[], fmi3IntervalQualifier q[]), (i, r, n, v, q))
NO(fmi3GetIntervalFraction, (REFS, fmi3UInt64 c[], fmi3UInt64 v[], fmi3IntervalQualifier q[]),
    (i, r, n, c, v, q))
NO(fmi3GetShiftDecimal, (REFS, fmi3Float64 v[]), (i, r, n, v))
NO(fmi3GetShiftFraction, (REFS, fmi3UInt64 c[], fmi3UInt64 v[]), (i, r, n, c, v))
NO(fmi3SetIntervalDecimal, (REFS, const fmi3Float64 v[]), (i, r, n, v))
NO(fmi3SetIntervalFraction, (REFS, const fmi3UInt64 c[], const fmi3UInt64 v[]), (i, r, n, c, v))
NO(fmi3SetShiftDecimal, (REFS, const fmi3Float64 v[]), (i, r, n, v))
NO(fmi3SetShiftFraction, (REFS, const fmi3UInt64 c[], const fmi3UInt64 v[]), (i, r, n, c, v))
NO(fmi3EvaluateDiscreteStates, (fmi3Instance i), (i))
NO(fmi3UpdateDiscreteStates,
    (fmi3Instance i, fmi3Boolean *a, fmi3Boolean *b, fmi3Boolean *c, fmi3Boolean *d, fmi3Boolean *e,
        fmi3Float64 *t),
    (i, a, b, c, d, e, t))
NO(fmi3ActivateModelPartition, (fmi3Instance i, fmi3ValueReference c, fmi3Float64 t), (i, c, t))

/* Model exchange. */
NO(fmi3EnterContinuousTimeMode, (fmi3Instance i), (i))
NO(fmi3CompletedIntegratorStep, (fmi3Instance i, fmi3Boolean p, fmi3Boolean *e, fmi3Boolean *t),
    (i, p, e, t))
NO(fmi3SetTime, (fmi3Instance i, fmi3Float64 t), (i, t))
NO(fmi3SetContinuousStates, (fmi3Instance i, const fmi3Float64 x[], size_t n), (i, x, n))
NO(fmi3GetContinuousStateDerivatives, (fmi3Instance i, fmi3Float64 x[], size_t n), (i, x, n))
NO(fmi3GetEventIndicators, (fmi3Instance i, fmi3Float64 x[], size_t n), (i, x, n))
NO(fmi3GetContinuousStates, (fmi3Instance i, fmi3Float64 x[], size_t n), (i, x, n))
NO(fmi3GetNominalsOfContinuousStates, (fmi3Instance i, fmi3Float64 x[], size_t n), (i, x, n))
NO(fmi3GetNumberOfEventIndicators, (fmi3Instance i, size_t *n), (i, n))
NO(fmi3GetNumberOfContinuousStates, (fmi3Instance i, size_t *n), (i, n))
