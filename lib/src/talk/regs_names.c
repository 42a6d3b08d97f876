/* SPDX-License-Identifier: MIT */
/* Names of the register map, for people and documents. An image that prints none links none. */
#include "exhand/regs.h"

const struct exh_regs_row exh_regs_head_row[EXH_HEADS] = {
    {"magic", "u32", "0x45584831, \"EXH1\""},
    {"map_version", "u32",
        "of this map: major << 16 | minor; a new major means something else, a minor adds"},
    {"test_int", "u32", "0x12345678, to find out the order of words"},
    {"test_float", "f32", "1.0, likewise"},
    {"tick", "u32", "ticks since set-up, modulo 2^32"},
    {"state", "u32", "0 OFF, 1 ARM, 2 RUN, 3 LIMIT, 4 RELEASE, 5 FAULT"},
    {"faults", "u32", "latched causes, bits as discrete inputs 0.."},
    {"first", "u32", "the first of them; stays after CLEAR"},
    {"first_tick", "u32", "and when"},
    {"present", "u32", "causes seen in the last tick: why RUN or CLEAR is refused"},
    {"limits", "u32", "limits that acted in the last tick, bits as discrete inputs 128.."},
    {"arm_step", "u32", "step that arming is on, or was refused at; bits as discrete inputs 160.."},
    {"din", "u32", "contacts, 1 is healthy; bits as discrete inputs 64.."},
    {"missed", "u32", "ticks missed since set-up, saturating"},
    {"signals", "u32", "values in the table of outputs"},
    {"params", "u32", "values in the table of parameters"},
    {"signals_crc", "u32", "of that table: the same number is the same meaning"},
    {"params_crc", "u32", "likewise"},
    {"period_num", "u32", "the loop's period in seconds is num/den"},
    {"period_den", "u32", ""},
    {"lib_version", "u32", "major << 16 | minor << 8 | patch"},
    {"fingers", "u32", "drives in use"},
    {"staged", "u32", "values staged that differ from what is wanted"},
    {"pending", "u32", "coils commanded and not yet carried out, bit k: coil k"},
    {"done", "u32", "commands carried out since set-up, modulo 2^32"},
    {"result", "i32", "of the last of them: 0 or minus an error (error.h)"},
    {"name_0", "text", "of the scene, four characters a value, the first highest"},
    {"name_1", "text", ""},
    {"name_2", "text", ""},
    {"name_3", "text", ""},
    {"refused", "u32", "writes and APPLY refused since set-up, modulo 2^32; since map 1.1"},
};

const struct exh_regs_row exh_regs_bits_row[EXH_BITS] = {
    {"faults", "exh_fault", "latched causes"},
    {"present", "exh_fault", "causes seen in the last tick"},
    {"din", "exh_din", "contacts, 1 is healthy"},
    {"state", "exh_state", "one of them is 1"},
    {"limits", "exh_limit", "that acted in the last tick"},
    {"arming", "exh_arm", "step that arming is on, or was refused at"},
};

const struct exh_regs_row exh_regs_coil_row[EXH_COILS] = {
    {"APPLY", "", "all that is staged, at once, between two ticks"},
    {"DISCARD", "", "nothing is staged any more"},
    {"SAVE", "", "keeps the parameters as they are wanted, where the port has a place for them"},
    {"OFF", "", "to OFF, by way of RELEASE where there may be a force"},
    {"RUN", "", "arms; where it has been allowed on the spot"},
    {"CLEAR", "", "FAULT to OFF; likewise"},
};

const struct exh_regs_row exh_regs_trace_row[EXH_TRACE_HEADS] = {
    {"trace.frames", "u32", "held at most, a power of two"},
    {"trace.next", "u32", "number of the next frame, modulo 2^32"},
    {"trace.oldest", "u32", "number of the oldest frame held; that of the next: there is none"},
    {"trace.run", "u32", "traces started, modulo 2^32"},
    {"trace.every", "u32", "ticks from frame to frame; 0: none"},
    {"trace.signal_0", "u32", "index in the table of outputs"},
    {"trace.signal_1", "u32", ""},
    {"trace.signal_2", "u32", ""},
    {"trace.signal_3", "u32", ""},
};

const struct exh_regs_block exh_regs_blocks[EXH_REGS_BLOCKS] = {
    {EXH_REGS_COIL, 0, "commands",
        "a 1 commands, a 0 does nothing; reads as 1 while it is pending"},
    {EXH_REGS_DISCRETE, 0, "bits", "state of the box, 32 bits each"},
    {EXH_REGS_INPUT, EXH_REGS_HEAD_AT, "head", "what this is, state, time"},
    {EXH_REGS_INPUT, EXH_REGS_TRACE_AT, "trace",
        "signals of every n-th tick, kept until they are read"},
    {EXH_REGS_INPUT, EXH_REGS_FRAMES_AT, "frames",
        "of the trace: frame k from + 12 (k mod frames) on"},
    {EXH_REGS_HOLDING, EXH_REGS_TRACE_AT, "trace", "which, and how often; a write starts another"},
    {EXH_REGS_INPUT, EXH_REGS_SIGNAL_AT, "outputs", "of the tick, raw: value times 2^fraction"},
    {EXH_REGS_INPUT, EXH_REGS_SIGNAL_FLOAT_AT, "outputs, float",
        "the same as binary32, in the row's unit"},
    {EXH_REGS_INPUT, EXH_REGS_PARAM_AT, "parameters", "in effect, raw"},
    {EXH_REGS_INPUT, EXH_REGS_PARAM_FLOAT_AT, "parameters, float", "the same as binary32"},
    {EXH_REGS_HOLDING, EXH_REGS_PARAM_AT, "staged", "parameters staged, else wanted; raw"},
    {EXH_REGS_HOLDING, EXH_REGS_PARAM_FLOAT_AT, "staged, float", "the same as binary32"},
};
