/* SPDX-License-Identifier: MIT */
/* What a card can do wrong, and where it was when it did. */
#ifndef CARDS_FAULT_H
#define CARDS_FAULT_H

#include <stdint.h>

enum exh_card_phase {
    EXH_CARD_CONFIG, /* the configuration itself */
    EXH_CARD_DETECT,
    EXH_CARD_SELFTEST,
    EXH_CARD_EEPROM,
    EXH_CARD_CALIBRATE,
    EXH_CARD_INPUT,   /* counters and digital lines */
    EXH_CARD_MONITOR, /* A/D scan of the current monitors */
    EXH_CARD_SCAN,    /* of the glove */
    EXH_CARD_PHASES
};

enum exh_card_what {
    EXH_CARD_OK,
    EXH_CARD_BAD_VALUE,    /* of the configuration; at: enum exh_box_row */
    EXH_CARD_EMPTY,        /* all ones: no card, or it died */
    EXH_CARD_SIGNATURE,    /* another answer than this card's */
    EXH_CARD_REGISTER,     /* does not read back; at: its offset */
    EXH_CARD_COUNTER,      /* does not hold what was loaded; at: counter */
    EXH_CARD_LINES,        /* output pins are not as written */
    EXH_CARD_AD_TIMEOUT,   /* a conversion does not end */
    EXH_CARD_DA_TIMEOUT,   /* an update of the outputs does not end */
    EXH_CARD_EE_TIMEOUT,   /* a word does not come; at: its address */
    EXH_CARD_DA_GAIN,      /* EEPROM: implausible; at: channel; 0.001 codes per volt */
    EXH_CARD_DA_OFFSET,    /* EEPROM: implausible; at: channel; 0.001 codes */
    EXH_CARD_AD_VREF,      /* EEPROM: implausible; microvolts */
    EXH_CARD_REF_0V,       /* implausible; the sum of ten conversions */
    EXH_CARD_REF_10V,      /* implausible; the sum of ten conversions */
    EXH_CARD_REF_NOISE,    /* ten conversions of a reference too far apart */
    EXH_CARD_AD_GAIN,      /* implausible with all three together; ppm */
    EXH_CARD_FOLLOW,       /* its high word is not what its low words came to; at: counter */
    EXH_CARD_QUADRATURE,   /* too many illegal transitions; at: counter */
    EXH_CARD_WAIT_TIMEOUT, /* the input does not settle */
    EXH_CARD_SCAN_TIMEOUT, /* a scan does not end */
    EXH_CARD_SCAN_LOST,    /* too many scans in a row with too few samples or too many */
    EXH_CARD_REST,         /* a drive that is off is given a current; at: finger */
    EXH_CARD_WHATS
};

struct exh_card_fault {
    uint8_t phase;  /* enum exh_card_phase */
    uint8_t what;   /* enum exh_card_what */
    uint8_t at;     /* channel, counter, address or offset, as said above */
    int32_t got;    /* what was read; lo .. hi would have been right, where lo */
    int32_t lo, hi; /* and hi are not both 0 */
};

/* The fault, in the phase it has. 0 is not among what it returns: -EXH_E_IO. */
int exh_card_fault(
    struct exh_card_fault *f, unsigned what, unsigned at, int32_t got, int32_t lo, int32_t hi);

/* "detect", "no answer, all ones", …; never NULL. */
const char *exh_card_phase_text(unsigned phase);
const char *exh_card_what_text(unsigned what);

#endif
