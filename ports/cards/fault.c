/* SPDX-License-Identifier: MIT */
#include "fault.h"

#include "exhand/error.h"

static const char *const phase_text[EXH_CARD_PHASES] = {
    [EXH_CARD_CONFIG] = "configuration",
    [EXH_CARD_DETECT] = "detect",
    [EXH_CARD_SELFTEST] = "self-test",
    [EXH_CARD_EEPROM] = "EEPROM",
    [EXH_CARD_CALIBRATE] = "calibrate",
    [EXH_CARD_INPUT] = "inputs",
    [EXH_CARD_MONITOR] = "monitors",
    [EXH_CARD_SCAN] = "glove scan",
};

static const char *const what_text[EXH_CARD_WHATS] = {
    [EXH_CARD_OK] = "in order",
    [EXH_CARD_BAD_VALUE] = "value not allowed",
    [EXH_CARD_EMPTY] = "no answer, all ones",
    [EXH_CARD_SIGNATURE] = "another card's signature",
    [EXH_CARD_REGISTER] = "register does not read back",
    [EXH_CARD_COUNTER] = "counter does not hold what was loaded",
    [EXH_CARD_LINES] = "digital outputs are not as written",
    [EXH_CARD_AD_TIMEOUT] = "A/D conversion does not end",
    [EXH_CARD_DA_TIMEOUT] = "D/A update does not end",
    [EXH_CARD_EE_TIMEOUT] = "word does not come",
    [EXH_CARD_DA_GAIN] = "D/A gain implausible, 0.001 codes per volt",
    [EXH_CARD_DA_OFFSET] = "D/A offset implausible, 0.001 codes",
    [EXH_CARD_AD_VREF] = "A/D reference voltage implausible, microvolt",
    [EXH_CARD_REF_0V] = "0 V reference implausible, sum of ten codes",
    [EXH_CARD_REF_10V] = "10 V reference implausible, sum of ten codes",
    [EXH_CARD_REF_NOISE] = "reference too noisy, codes",
    [EXH_CARD_AD_GAIN] = "A/D gain implausible, ppm",
    [EXH_CARD_FOLLOW] = "counter jumped by more than 16 bits in a tick",
    [EXH_CARD_QUADRATURE] = "illegal transitions of the encoder lines",
    [EXH_CARD_WAIT_TIMEOUT] = "input does not settle",
    [EXH_CARD_SCAN_TIMEOUT] = "scan does not end",
    [EXH_CARD_REST] = "D/A code of a drive that is off is no 0 A",
    [EXH_CARD_SCAN_LOST] = "scans with too few or too many samples",
};

int exh_card_fault(
    struct exh_card_fault *f, unsigned what, unsigned at, int32_t got, int32_t lo, int32_t hi)
{
    f->what = (uint8_t)what;
    f->at = (uint8_t)at;
    f->got = got;
    f->lo = lo;
    f->hi = hi;
    return -EXH_E_IO;
}

const char *exh_card_phase_text(unsigned phase)
{
    return phase < EXH_CARD_PHASES ? phase_text[phase] : "?";
}

const char *exh_card_what_text(unsigned what)
{
    return what < EXH_CARD_WHATS ? what_text[what] : "?";
}
