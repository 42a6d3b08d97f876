/* SPDX-License-Identifier: MIT */
/* Text of each error code. */
#include "exhand/error.h"

const char *exh_error_text(int code)
{
    static const char *const text[EXH_E_COUNT] = {
        "ok",
        "value outside its range",
        "no such signal, record or command",
        "not allowed in this state",
        "checksum wrong",
        "another version or table",
        "ends too early, or buffer too small",
        "table does not rise",
        "loop rate not possible",
        "device answered wrongly or late",
        "device not found",
        "calibration too old, or made before a change",
        "cut-off at or above half the rate",
        "stiffness, damping outside the rule of gains",
    };
    if (code <= -EXH_E_COUNT || code >= EXH_E_COUNT) { return "unknown error"; }
    return text[code < 0 ? -code : code];
}
