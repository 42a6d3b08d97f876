/* SPDX-License-Identifier: MIT */
/* Prints modelDescription.xml, or with "build" buildDescription.xml, of the unit it is linked with:
 * describe [build SOURCE...] */
#include "unit.h"

#include "exhand/exhand.h"

#include <stdio.h>
#include <string.h>

static const char *const type_name[] = {"Int32", "Float64"};
static const char *const role_text[] = {"causality=\"parameter\" variability=\"fixed\"",
    "causality=\"parameter\" variability=\"tunable\"", "causality=\"input\"",
    "causality=\"output\""};

/* The tables' units as importers know them, with their exponents of kg, m, s and A. */
struct si {
    const char *ours, *name;
    int kg, m, s, a;
};
static const struct si si[] = {{"a", "A", 0, 0, 0, 1}, {"hz", "Hz", 0, 0, -1, 0},
    {"j", "J", 1, 2, -2, 0}, {"kg", "kg", 1, 0, 0, 0}, {"m", "m", 0, 1, 0, 0},
    {"m_per_s", "m/s", 0, 1, -1, 0}, {"n", "N", 1, 1, -2, 0}, {"n_per_a", "N/A", 1, 1, -2, -1},
    {"n_per_m", "N/m", 1, 0, -2, 0}, {"ns_per_m", "N.s/m", 1, 0, -1, 0},
    {"ohm", "Ohm", 1, 2, -3, -2}, {"per_a", "1/A", 0, 0, 0, -1}, {"s", "s", 0, 0, 1, 0},
    {"v", "V", 1, 2, -3, -1}, {"w", "W", 1, 2, -3, 0}};

/* NULL: none of these. */
static const struct si *si_of(const char *unit)
{
    for (size_t i = 0; i < sizeof si / sizeof si[0]; i++) {
        if (strcmp(si[i].ours, unit) == 0) { return &si[i]; }
    }
    return NULL;
}

static const char *shown(const char *unit)
{
    const struct si *u = si_of(unit);
    return u ? u->name : unit;
}

static void define(const char *unit)
{
    const struct si *u = si_of(unit);
    if (u == NULL) {
        printf("    <Unit name=\"%s\"/>\n", unit);
        return;
    }
    printf("    <Unit name=\"%s\"><BaseUnit kg=\"%d\" m=\"%d\" s=\"%d\" A=\"%d\"/></Unit>\n",
        u->name, u->kg, u->m, u->s, u->a);
}

static void text(const char *s)
{
    for (; *s; s++) {
        if (*s == '<') {
            printf("&lt;");
        } else if (*s == '&') {
            printf("&amp;");
        } else if (*s == '"') {
            printf("&quot;");
        } else {
            putchar(*s);
        }
    }
}

/* Each unit once. */
static void units(void)
{
    struct unit_var v, other;
    printf("  <UnitDefinitions>\n");
    for (uint32_t i = 0; i < unit_vars(); i++) {
        uint32_t k = 0;
        unit_var(i, &v);
        if (v.unit[0] == '\0' || v.type != UNIT_FLOAT64) { continue; }
        for (unit_var(k, &other);
             k < i && (other.type != UNIT_FLOAT64 || strcmp(other.unit, v.unit) != 0);
             unit_var(++k, &other)) {}
        if (k == i) { define(v.unit); }
    }
    printf("  </UnitDefinitions>\n");
}

static void variable(uint32_t i, const struct unit_var *v)
{
    printf("    <%s name=\"%s\" valueReference=\"%lu\" %s", type_name[v->type], v->name,
        (unsigned long)i, role_text[v->role]);
    if (v->type == UNIT_INT32 && v->role > UNIT_TUNABLE) { printf(" variability=\"discrete\""); }
    if (v->type == UNIT_FLOAT64 && v->role == UNIT_OUTPUT) { printf(" variability=\"discrete\""); }
    if (v->role != UNIT_OUTPUT) { printf(" start=\"%.17g\"", v->start); }
    if (v->min <= v->max) { printf(" min=\"%.17g\" max=\"%.17g\"", v->min, v->max); }
    if (v->unit[0] && v->type == UNIT_FLOAT64) { printf(" unit=\"%s\"", shown(v->unit)); }
    printf(" description=\"");
    text(v->help);
    if (v->unit[0] && v->type == UNIT_INT32) { printf(", %s", shown(v->unit)); }
    printf("\"/>\n");
}

static uint32_t token(void)
{
    uint32_t crc = 0;
    struct unit_var v;
    for (uint32_t i = 0; i < unit_vars(); i++) {
        unit_var(i, &v);
        crc = exh_crc32(crc, v.name, strlen(v.name));
        crc = exh_crc32(crc, &v.type, 1);
        crc = exh_crc32(crc, &v.role, 1);
    }
    return crc;
}

static void model(void)
{
    const struct exh_period T = unit_period();
    struct unit_var v;
    printf(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<fmiModelDescription fmiVersion=\"3.0\" modelName=\"%s\" instantiationToken=\"%s-%08lx\"\n"
        "    description=\"%s; %s\" version=\"%d.%d.%d\" license=\"MIT\" "
        "generationTool=\"exhand\">\n"
        "  <CoSimulation modelIdentifier=\"%s\" canBeInstantiatedOnlyOncePerProcess=\"true\" "
        "canGetAndSetFMUState=\"true\"\n"
        "      canSerializeFMUState=\"true\" canHandleVariableCommunicationStepSize=\"false\"/>\n",
        unit_name, unit_name, (unsigned long)token(), unit_help, unit_order, EXH_VERSION_MAJOR,
        EXH_VERSION_MINOR, EXH_VERSION_PATCH, unit_name);
    units();
    printf("  <DefaultExperiment startTime=\"0\" stopTime=\"3\" stepSize=\"%.17g\"/>\n  "
           "<ModelVariables>\n"
           "    <Float64 name=\"time\" valueReference=\"%lu\" causality=\"independent\" "
           "variability=\"continuous\"/>\n",
        (double)T.num / T.den, (unsigned long)unit_vars());
    for (uint32_t i = 0; i < unit_vars(); i++) {
        unit_var(i, &v);
        variable(i, &v);
    }
    printf("  </ModelVariables>\n  <ModelStructure>\n");
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < unit_vars(); i++) {
            unit_var(i, &v);
            if (v.role == UNIT_OUTPUT) {
                printf("    <%s valueReference=\"%lu\"/>\n", pass ? "InitialUnknown" : "Output",
                    (unsigned long)i);
            }
        }
    }
    printf("  </ModelStructure>\n</fmiModelDescription>\n");
}

static void build(int n, char **source)
{
    printf("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n"
           "  <BuildConfiguration modelIdentifier=\"%s\">\n    <SourceFileSet language=\"C99\" "
           "compilerOptions=\"-ffp-contract=off\">\n",
        unit_name);
    for (int i = 0; i < n; i++) { printf("      <SourceFile name=\"%s\"/>\n", source[i]); }
    printf("      <PreprocessorDefinition name=\"FMI_TOKEN\" value=\"0x%08lx\"/>\n"
           "      <IncludeDirectory name=\".\"/>\n    </SourceFileSet>\n  "
           "</BuildConfiguration>\n</fmiBuildDescription>\n",
        (unsigned long)token());
}

int main(int argc, char **argv)
{
    unit_reset();
    if (argc > 1 && strcmp(argv[1], "build") == 0) {
        build(argc - 2, argv + 2);
    } else {
        model();
    }
    return 0;
}
