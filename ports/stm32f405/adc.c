/* SPDX-License-Identifier: MIT */
/* ADC1 converts eight channels continuously: 15 + 12 cycles of 21 MHz each, a round of eight in
 * 10.3 us. DMA2 writes them into a circle of two halves of 20 rounds.
 *
 * - Monitors and supply: the sum of the newest four rounds, at most 51 us old.
 * - Glove: 22 sensors on two 16:1 multiplexers. Each half has one address. Its first four rounds
 *   (41 us) settle, the other 16 are summed: 12 bits of 3.3 V become 16 of the library's +-10 V.
 *   The interrupt at the end of a half sets the next address; eleven make a frame of 2.26 ms.
 * - Neighbours on a multiplexer are 206 us apart, sensors i and 11 + i 1.3 us. The age of a frame
 *   is that of its oldest sensor. */
#include "stm.h"

#include "exhand/error.h"

#define CHANNELS   8u
#define ROUNDS     20u /* in a half */
#define SETTLE     4u
#define CIRCLE     (2u * ROUNDS * CHANNELS)
#define STEPS      11u
#define MONITOR    4u /* rounds */
#define GLOVE_A    6u /* places in a round */
#define GLOVE_B    7u
#define SUPPLY     5u
#define LATE       (3u * 17280u) /* of TIM5: three halves of 205.7 us */
#define STREAM     (BASE_DMA2 + DMA_STREAM(0u))
#define OPEN_POLLS 200u
#define AGE_MAX    65535

static volatile uint16_t circle[CIRCLE];
static struct glove {
    int16_t raw[EXH_GLOVE_SENSORS];
    uint32_t tick; /* in which its first sensors were converted */
} frame[2];
static volatile uint8_t newest; /* of both, the one that is whole */
static volatile uint8_t frames; /* 1: there is one */
static uint8_t step, spoiled;   /* the half that runs has no good address */
static uint32_t began_tick;     /* of the half that runs */
static volatile uint32_t heard; /* TIM5, at the last interrupt */
static volatile uint8_t failed;

static void address(void)
{
    PIN_PUT(MUX_S0, step & 1u);
    PIN_PUT(MUX_S1, step & 2u);
    PIN_PUT(MUX_S2, step & 4u);
    PIN_PUT(MUX_S3, step & 8u);
}

static uint32_t place(void) /* of the next sample */
{
    const uint32_t left = REG(STREAM, DMA_SNDTR);
    return left == 0 || left > CIRCLE ? 0 : CIRCLE - left;
}

static int16_t sum16(const volatile uint16_t *at)
{
    int32_t sum = -32768;
#pragma GCC unroll 16
    for (unsigned i = 0; i < 16; i++) { sum += at[i * CHANNELS] & 0xFFF; }
    return (int16_t)sum;
}

/* A half is whole. */
static void take(const volatile uint16_t *half)
{
    struct glove *const g = &frame[!newest];
    const volatile uint16_t *const from = half + SETTLE * CHANNELS;
    if (step == 0) { g->tick = began_tick; }
    g->raw[step] = sum16(from + GLOVE_A);
    g->raw[STEPS + step] = sum16(from + GLOVE_B);
    if (++step < STEPS) { return; }
    step = 0;
    newest = !newest;
    frames = 1;
}

void stm_adc_half(void)
{
    const uint32_t flags = REG(BASE_DMA2, DMA_LISR) & DMA_FLAGS;
    const uint32_t both = DMA_FLAG_HT | DMA_FLAG_TC;
    REG(BASE_DMA2, DMA_LIFCR) = flags;
    if (flags & DMA_FLAG_TE) { failed = 1; }
    if (!(flags & both)) { return; }
    if (!spoiled && (flags & both) != both) {
        take(flags & DMA_FLAG_HT ? circle : circle + CIRCLE / 2);
    }
    address();
    spoiled = place() % (CIRCLE / 2) >= (SETTLE - 1) * CHANNELS; /* late: no time to settle */
    began_tick = stm_ticks();
    heard = stm_now();
}

int stm_adc_late(void)
{
    return failed || (REG(BASE_ADC1, ADC_SR) & ADC_SR_OVR) || stm_now() - heard > LATE;
}

/* The sums of the newest rounds; the round that is under way comes behind them. */
void stm_adc_read(struct exh_drive_in *in)
{
    const volatile uint16_t *row = &circle[place() / CHANNELS * CHANNELS];
    int32_t sum[SUPPLY + 1] = {0};
    for (unsigned k = 0; k < MONITOR; k++) {
        row = (row == circle ? circle + CIRCLE : row) - CHANNELS;
        for (unsigned i = 0; i <= SUPPLY; i++) { sum[i] += row[i] & 0xFFF; }
    }
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        in->mon_raw[i] = (int16_t)(sum[i] * (16 / (int)MONITOR) - 32768);
    }
    in->supply_raw = (int16_t)(sum[SUPPLY] * (16 / (int)MONITOR) - 32768);
}

int stm_adc_glove(struct exh_glove_in *in, uint32_t tick)
{
    const struct glove *const g = &frame[newest]; /* whole for 2 ms */
    const int32_t age = (int32_t)(tick - g->tick);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { in->raw[i] = g->raw[i]; }
    in->age_ticks = (uint16_t)(!frames || age > AGE_MAX ? AGE_MAX : age < 0 ? 0 : age);
    return stm_adc_late() ? -EXH_E_IO : 0;
}

static void stop(void)
{
    REG(BASE_ADC1, ADC_CR2) = 0;
    REG(STREAM, DMA_SCR) = 0;
    for (uint32_t n = 0; n < 10000 && REG(STREAM, DMA_SCR) & DMA_SCR_EN; n++) {}
    REG(BASE_DMA2, DMA_LIFCR) = DMA_FLAGS;
    REG(BASE_ADC1, ADC_SR) = 0;
    step = spoiled = 0;
    frames = failed = 0;
}

static void start(void)
{
    REG(STREAM, DMA_SPAR) = BASE_ADC1 + ADC_DR;
    REG(STREAM, DMA_SM0AR) = (uint32_t)circle;
    REG(STREAM, DMA_SNDTR) = CIRCLE;
    REG(STREAM, DMA_SCR) = DMA_SCR_MINC | DMA_SCR_CIRC | DMA_SCR_HTIE | DMA_SCR_TCIE |
                           PUT(DMA_SCR_PSIZE, 1) | PUT(DMA_SCR_MSIZE, 1) | PUT(DMA_SCR_PL, 2) |
                           DMA_SCR_EN;
    REG(BASE_ADC_COMMON, ADC_COMMON_CCR) = PUT(ADC_COMMON_CCR_ADCPRE, 1); /* 84 MHz / 4 */
    REG(BASE_ADC1, ADC_CR1) = ADC_CR1_SCAN;
    REG(BASE_ADC1, ADC_SMPR1) = 0111111;    /* channels 10 .. 15: 15 cycles */
    REG(BASE_ADC1, ADC_SMPR2) = 011u << 24; /* 8, 9 */
    REG(BASE_ADC1, ADC_SQR1) = PUT(ADC_SQR1_L, CHANNELS - 1);
    REG(BASE_ADC1, ADC_SQR3) = 10u | 11u << 5 | 12u << 10 | 13u << 15 | 14u << 20 | 15u << 25;
    REG(BASE_ADC1, ADC_SQR2) = 8u | 9u << 5;
    REG(BASE_ADC1, ADC_CR2) = ADC_CR2_ADON | ADC_CR2_CONT | ADC_CR2_DMA | ADC_CR2_DDS;
    stm_delay_us(10); /* until it is stable: 3 us */
    REG(BASE_ADC1, ADC_CR2) |= ADC_CR2_SWSTART;
}

int stm_adc_open(void)
{
    REG(BASE_RCC, RCC_AHB1ENR) |= RCC_AHB1ENR_DMA2EN;
    REG(BASE_RCC, RCC_APB2ENR) |= RCC_APB2ENR_ADC1EN;
    (void)REG(BASE_RCC, RCC_APB2ENR);
    stop();
    address();
    heard = stm_now();
    began_tick = stm_ticks();
    REG(BASE_SCS, NVIC_ISER(IRQ_DMA2_STREAM0 / 32u)) = 1u << IRQ_DMA2_STREAM0 % 32u;
    start();
    for (uint32_t n = 0; n < OPEN_POLLS && !frames; n++) { stm_delay_us(50); }
    return failed ? -EXH_E_IO : frames ? 0 : -EXH_E_ABSENT;
}
