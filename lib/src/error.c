#include "exhand/error.h"

const char *exh_error_text(int code)
{
    static const char *const text[EXH_E_COUNT] = {
        "ok",
        "value outside its range",
        "no such signal, record or command",
        "not allowed in this state",
        "checksum wrong, bytes damaged",
        "another version or table",
        "ends too early, or buffer too small",
        "table does not rise strictly",
        "loop rate not possible",
        "device answered wrongly or too late",
        "device not found",
    };
    const int i = code < 0 ? -(code + 1) + 1 : code;
    return i >= 0 && i < EXH_E_COUNT ? text[i] : "unknown error";
}
