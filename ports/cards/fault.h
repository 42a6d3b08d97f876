/* What a card can do wrong, and where it was when it did. */
#ifndef CARDS_FAULT_H
#define CARDS_FAULT_H

#include <stdint.h>

enum exh_card_phase {
    EXH_CARD_CONFIG,    /* the configuration itself                            */
    EXH_CARD_DETECT,
    EXH_CARD_SELFTEST,
    EXH_CARD_EEPROM,
    EXH_CARD_CALIBRATE,
    EXH_CARD_OUTPUT,    /* D/A and digital outputs                             */
    EXH_CARD_INPUT,     /* counters and digital inputs                         */
    EXH_CARD_MONITOR,   /* A/D scan of the current monitors                    */
    EXH_CARD_SCAN,      /* glove scan                                          */
    EXH_CARD_PHASES
};

enum exh_card_what {
    EXH_CARD_OK,
    EXH_CARD_BAD_VALUE,   /* of the configuration; at: its place               */
    EXH_CARD_EMPTY,       /* all ones: no card, or it died                     */
    EXH_CARD_SIGNATURE,   /* another answer than this card's                   */
    EXH_CARD_REGISTER,    /* a register does not read back; at: its offset     */
    EXH_CARD_COUNTER,     /* a counter does not hold what was loaded; at: counter */
    EXH_CARD_AD_TIMEOUT,  /* a conversion does not end                         */
    EXH_CARD_DA_TIMEOUT,  /* an update of the outputs does not end             */
    EXH_CARD_EE_TIMEOUT,  /* a word does not come; at: its address             */
    EXH_CARD_DA_GAIN,     /* EEPROM: implausible; at: channel                  */
    EXH_CARD_DA_OFFSET,   /* EEPROM: implausible; at: channel                  */
    EXH_CARD_AD_VREF,     /* EEPROM: implausible                               */
    EXH_CARD_REF_0V,      /* average of ten conversions implausible            */
    EXH_CARD_REF_10V,
    EXH_CARD_AD_GAIN,     /* implausible with all three together               */
    EXH_CARD_AD_NOISE,    /* ten conversions of a reference too far apart      */
    EXH_CARD_QUADRATURE,  /* too many illegal transitions; at: counter         */
    EXH_CARD_WAIT_TIMEOUT, /* the input does not settle                        */
    EXH_CARD_SCAN_TIMEOUT, /* a scan does not end                              */
    EXH_CARD_SCAN_LOST,   /* too many scans in a row with samples missing or too many */
    EXH_CARD_WHATS
};

struct exh_card_fault {
    uint8_t phase;    /* enum exh_card_phase                                   */
    uint8_t what;     /* enum exh_card_what                                    */
    uint8_t at;       /* channel, counter, address or offset, as said above    */
    int32_t got;      /* what was read, where one value tells                  */
    int32_t lo, hi;   /* what would have been right                            */
};

/* "detect", "no answer (all ones)", …; never NULL. */
const char *exh_card_phase_text(unsigned phase);
const char *exh_card_what_text(unsigned what);

#endif
