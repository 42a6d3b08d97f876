/* SPDX-License-Identifier: MIT */
/* Every register of the STM32F405 that this port touches: bases, offsets, fields, reset values.
 * No other file has such a number; a test compares them with another source. Facts: ST's reference
 * manual RM0090 (names and chapters are its own) and the Armv7-M architecture manual.
 *
 * BASE_x is the address of a peripheral. PERIPHERAL_REGISTER is the offset of a register in it.
 * PERIPHERAL_REGISTER_FIELD is the mask of a field, FIELD(lowest bit, width).
 * RESET_PERIPHERAL_REGISTER is the value after a reset. TIM, GPIO, USART, SPI, ADC and DMA mean
 * each peripheral of that kind.
 *
 * Use of the peripherals:
 *   RCC, PWR, FLASH  clock: crystal to 168 MHz, else HSI to 168 MHz; CSS makes an NMI when the
 *                    crystal fails; PVD reports low supply; slots in sectors 10 and 11
 *   SysTick          the tick: its interrupt counts
 *   TIM5             free-running, 84 MHz, 32 bits: exh_board_cycles()
 *   TIM1 2 3 4 8     encoders of fingers 0 .. 4, x4; the low 16 bits are read
 *   SPI2             the D/A (DAC81408): mode 1, 21 MHz, 10.5 where an answer comes back,
 *                    24 bits as three bytes, polled
 *   CRC              of records and packets, by the loop alone
 *   ADC1, DMA2 S0    runs freely over 8 channels into a circle of 2 x 20 rounds; the interrupt of
 *                    half and whole circle sums the two glove channels and turns the multiplexers
 *   USART2, DMA1 S6  text (polled) and log (DMA)
 *   USART3, DMA1 S3 S1  link: out, in (circular)
 *   UART4, DMA1 S4 S2   Modbus RTU: out, in (circular)
 *   IWDG             started by the first tick, fed by whole ticks, and in the endless loop of
 *                    exh_board_halt(), which makes the outputs safe in each pass
 *   MPU              a guard below the stack; code is only read
 */
#ifndef STM32F405_REGS_H
#define STM32F405_REGS_H

#include <stdint.h>

#define FIELD(low, width) (((1u << (width)) - 1u) << (low)) /* width 1 .. 31 */
#define PUT(field, value) ((uint32_t)(value) * ((field) & (~(field) + 1u)))
#define GET(field, word)  (((word) & (field)) / ((field) & (~(field) + 1u)))
#define REG(base, offset) (*(volatile uint32_t *)((uintptr_t)(base) + (offset)))

/* --- addresses (RM0090, memory map) --- */
#define BASE_TIM2       0x40000000u
#define BASE_TIM3       0x40000400u
#define BASE_TIM4       0x40000800u
#define BASE_TIM5       0x40000C00u
#define BASE_IWDG       0x40003000u
#define BASE_SPI2       0x40003800u
#define BASE_USART2     0x40004400u
#define BASE_USART3     0x40004800u
#define BASE_UART4      0x40004C00u
#define BASE_PWR        0x40007000u
#define BASE_TIM1       0x40010000u
#define BASE_TIM8       0x40010400u
#define BASE_ADC1       0x40012000u
#define BASE_ADC_COMMON 0x40012300u
#define BASE_GPIOA      0x40020000u
#define BASE_GPIOB      0x40020400u
#define BASE_GPIOC      0x40020800u
#define BASE_GPIOD      0x40020C00u
#define BASE_CRC        0x40023000u
#define BASE_RCC        0x40023800u
#define BASE_FLASH      0x40023C00u
#define BASE_DMA1       0x40026000u
#define BASE_DMA2       0x40026400u
#define BASE_SCS        0xE000E000u /* System Control Space of the processor */

/* --- RCC --- */
#define RCC_CR               0x00u
#define RCC_CR_HSION         FIELD(0, 1)
#define RCC_CR_HSIRDY        FIELD(1, 1)
#define RCC_CR_HSEON         FIELD(16, 1)
#define RCC_CR_HSERDY        FIELD(17, 1)
#define RCC_CR_CSSON         FIELD(19, 1)
#define RCC_CR_PLLON         FIELD(24, 1)
#define RCC_CR_PLLRDY        FIELD(25, 1)
#define RCC_PLLCFGR          0x04u
#define RCC_PLLCFGR_PLLM     FIELD(0, 6)
#define RCC_PLLCFGR_PLLN     FIELD(6, 9)
#define RCC_PLLCFGR_PLLP     FIELD(16, 2)
#define RCC_PLLCFGR_PLLSRC   FIELD(22, 1)
#define RCC_PLLCFGR_PLLQ     FIELD(24, 4)
#define RESET_RCC_PLLCFGR    0x24003010u
#define RCC_CFGR             0x08u
#define RCC_CFGR_SW          FIELD(0, 2)
#define RCC_CFGR_SWS         FIELD(2, 2)
#define RCC_CFGR_HPRE        FIELD(4, 4)
#define RCC_CFGR_PPRE1       FIELD(10, 3)
#define RCC_CFGR_PPRE2       FIELD(13, 3)
#define RESET_RCC_CFGR       0x00000000u
#define RCC_CIR              0x0Cu
#define RCC_CIR_CSSF         FIELD(7, 1)
#define RCC_CIR_CSSC         FIELD(23, 1)
#define RCC_AHB1ENR          0x30u
#define RCC_AHB1ENR_GPIOAEN  FIELD(0, 1)
#define RCC_AHB1ENR_GPIOBEN  FIELD(1, 1)
#define RCC_AHB1ENR_GPIOCEN  FIELD(2, 1)
#define RCC_AHB1ENR_GPIODEN  FIELD(3, 1)
#define RCC_AHB1ENR_CRCEN    FIELD(12, 1)
#define RCC_AHB1ENR_DMA1EN   FIELD(21, 1)
#define RCC_AHB1ENR_DMA2EN   FIELD(22, 1)
#define RESET_RCC_AHB1ENR    0x00100000u
#define RCC_APB1ENR          0x40u
#define RCC_APB1ENR_TIM2EN   FIELD(0, 1)
#define RCC_APB1ENR_TIM3EN   FIELD(1, 1)
#define RCC_APB1ENR_TIM4EN   FIELD(2, 1)
#define RCC_APB1ENR_TIM5EN   FIELD(3, 1)
#define RCC_APB1ENR_SPI2EN   FIELD(14, 1)
#define RCC_APB1ENR_USART2EN FIELD(17, 1)
#define RCC_APB1ENR_USART3EN FIELD(18, 1)
#define RCC_APB1ENR_UART4EN  FIELD(19, 1)
#define RCC_APB1ENR_PWREN    FIELD(28, 1)
#define RESET_RCC_APB1ENR    0x00000000u
#define RCC_APB2ENR          0x44u
#define RCC_APB2ENR_TIM1EN   FIELD(0, 1)
#define RCC_APB2ENR_TIM8EN   FIELD(1, 1)
#define RCC_APB2ENR_ADC1EN   FIELD(8, 1)
#define RESET_RCC_APB2ENR    0x00000000u
#define RCC_CSR              0x74u
#define RCC_CSR_LSION        FIELD(0, 1)
#define RCC_CSR_LSIRDY       FIELD(1, 1)
#define RCC_CSR_IWDGRSTF     FIELD(29, 1)

/* --- PWR --- */
#define PWR_CR       0x00u
#define PWR_CR_PVDE  FIELD(4, 1)
#define PWR_CR_PLS   FIELD(5, 3)
#define PWR_CR_VOS   FIELD(14, 1)
#define PWR_CSR      0x04u
#define PWR_CSR_PVDO FIELD(2, 1)

/* --- FLASH --- */
#define FLASH_ACR         0x00u
#define FLASH_ACR_LATENCY FIELD(0, 3)
#define FLASH_ACR_PRFTEN  FIELD(8, 1)
#define FLASH_ACR_ICEN    FIELD(9, 1)
#define FLASH_ACR_DCEN    FIELD(10, 1)
#define FLASH_ACR_ICRST   FIELD(11, 1)
#define FLASH_ACR_DCRST   FIELD(12, 1)
#define RESET_FLASH_ACR   0x00000000u
#define FLASH_KEYR        0x04u
#define FLASH_SR          0x0Cu
#define FLASH_SR_EOP      FIELD(0, 1)
#define FLASH_SR_OPERR    FIELD(1, 1)
#define FLASH_SR_WRPERR   FIELD(4, 1)
#define FLASH_SR_PGAERR   FIELD(5, 1)
#define FLASH_SR_PGPERR   FIELD(6, 1)
#define FLASH_SR_PGSERR   FIELD(7, 1)
#define FLASH_SR_BSY      FIELD(16, 1)
#define RESET_FLASH_SR    0x00000000u
#define FLASH_CR          0x10u
#define FLASH_CR_PG       FIELD(0, 1)
#define FLASH_CR_SER      FIELD(1, 1)
#define FLASH_CR_SNB      FIELD(3, 4)
#define FLASH_CR_PSIZE    FIELD(8, 2)
#define FLASH_CR_STRT     FIELD(16, 1)
#define FLASH_CR_LOCK     FIELD(31, 1)
#define RESET_FLASH_CR    0x80000000u
#define FLASH_KEY1        0x45670123u
#define FLASH_KEY2        0xCDEF89ABu
#define FLASH_SECTOR_10   0x080C0000u /* 128 KiB each */
#define FLASH_SECTOR_11   0x080E0000u

/* --- GPIO --- */
#define GPIO_MODER        0x00u /* 2 bits a pin */
#define GPIO_OTYPER       0x04u
#define GPIO_OSPEEDR      0x08u
#define GPIO_PUPDR        0x0Cu
#define GPIO_IDR          0x10u
#define GPIO_ODR          0x14u
#define GPIO_BSRR         0x18u                          /* bit n sets, bit 16 + n clears */
#define GPIO_AFRL         0x20u                          /* 4 bits a pin, 0 .. 7 */
#define GPIO_AFRH         0x24u                          /* 8 .. 15 */
#define GPIO_BASE(port)   (BASE_GPIOA + 0x400u * (port)) /* 0 .. 3: A .. D */
#define RESET_GPIOA_MODER 0xA8000000u
#define RESET_GPIOB_MODER 0x00000280u
#define RESET_GPIOA_PUPDR 0x64000000u
#define RESET_GPIOB_PUPDR 0x00000100u

/* --- TIM1 2 3 4 8 as encoders, TIM5 free-running --- */
#define TIM_CR1        0x00u
#define TIM_CR1_CEN    FIELD(0, 1)
#define TIM_SMCR       0x08u
#define TIM_SMCR_SMS   FIELD(0, 3) /* 3: counts every edge of both inputs */
#define TIM_EGR        0x14u
#define TIM_EGR_UG     FIELD(0, 1)
#define TIM_CCMR1      0x18u
#define TIM_CCMR1_CC1S FIELD(0, 2)
#define TIM_CCMR1_IC1F FIELD(4, 4)
#define TIM_CCMR1_CC2S FIELD(8, 2)
#define TIM_CCMR1_IC2F FIELD(12, 4)
#define TIM_CCER       0x20u
#define TIM_CNT        0x24u
#define TIM_PSC        0x28u
#define TIM_ARR        0x2Cu
#define RESET_TIM_CR1  0x00000000u
#define RESET_TIM_CNT  0x00000000u

/* --- SPI --- */
#define SPI_CR1      0x00u
#define SPI_CR1_CPHA FIELD(0, 1)
#define SPI_CR1_CPOL FIELD(1, 1)
#define SPI_CR1_MSTR FIELD(2, 1)
#define SPI_CR1_BR   FIELD(3, 3)
#define SPI_CR1_SPE  FIELD(6, 1)
#define SPI_CR1_SSI  FIELD(8, 1)
#define SPI_CR1_SSM  FIELD(9, 1)
#define SPI_SR       0x08u
#define SPI_SR_RXNE  FIELD(0, 1)
#define SPI_SR_TXE   FIELD(1, 1)
#define SPI_SR_BSY   FIELD(7, 1)
#define RESET_SPI_SR 0x00000002u
#define SPI_DR       0x0Cu

/* --- USART --- */
#define USART_SR       0x00u
#define USART_SR_PE    FIELD(0, 1)
#define USART_SR_FE    FIELD(1, 1)
#define USART_SR_NF    FIELD(2, 1)
#define USART_SR_ORE   FIELD(3, 1)
#define USART_SR_TC    FIELD(6, 1)
#define USART_SR_TXE   FIELD(7, 1)
#define RESET_USART_SR 0x000000C0u
#define USART_DR       0x04u
#define USART_BRR      0x08u
#define USART_CR1      0x0Cu
#define USART_CR1_RE   FIELD(2, 1)
#define USART_CR1_TE   FIELD(3, 1)
#define USART_CR1_PCE  FIELD(10, 1)
#define USART_CR1_M    FIELD(12, 1)
#define USART_CR1_UE   FIELD(13, 1)
#define USART_CR3      0x14u
#define USART_CR3_DMAR FIELD(6, 1)
#define USART_CR3_DMAT FIELD(7, 1)

/* --- ADC --- */
#define ADC_SR                0x00u
#define ADC_SR_OVR            FIELD(5, 1)
#define ADC_CR1               0x04u
#define ADC_CR1_SCAN          FIELD(8, 1)
#define ADC_CR2               0x08u
#define ADC_CR2_ADON          FIELD(0, 1)
#define ADC_CR2_CONT          FIELD(1, 1)
#define ADC_CR2_DMA           FIELD(8, 1)
#define ADC_CR2_DDS           FIELD(9, 1)
#define ADC_CR2_SWSTART       FIELD(30, 1)
#define ADC_SMPR1             0x0Cu /* channels 10 .. 18, 3 bits each */
#define ADC_SMPR2             0x10u /* channels 0 .. 9 */
#define ADC_SQR1              0x2Cu
#define ADC_SQR1_L            FIELD(20, 4)
#define ADC_SQR2              0x30u /* conversions 7 .. 12, 5 bits each */
#define ADC_SQR3              0x34u /* conversions 1 .. 6 */
#define ADC_DR                0x4Cu
#define RESET_ADC_CR2         0x00000000u
#define ADC_COMMON_CCR        0x04u
#define ADC_COMMON_CCR_ADCPRE FIELD(16, 2)

/* --- DMA: a controller, then its streams --- */
#define DMA_LISR         0x00u
#define DMA_HISR         0x04u
#define DMA_LIFCR        0x08u
#define DMA_HIFCR        0x0Cu
#define DMA_STREAM(n)    (0x10u + 0x18u * (n)) /* offset of stream n; the registers of one: */
#define DMA_SCR          0x00u
#define DMA_SCR_EN       FIELD(0, 1)
#define DMA_SCR_HTIE     FIELD(3, 1)
#define DMA_SCR_TCIE     FIELD(4, 1)
#define DMA_SCR_DIR      FIELD(6, 2)
#define DMA_SCR_CIRC     FIELD(8, 1)
#define DMA_SCR_MINC     FIELD(10, 1)
#define DMA_SCR_PSIZE    FIELD(11, 2)
#define DMA_SCR_MSIZE    FIELD(13, 2)
#define DMA_SCR_PL       FIELD(16, 2)
#define DMA_SCR_CHSEL    FIELD(25, 3)
#define DMA_SNDTR        0x04u
#define DMA_SPAR         0x08u
#define DMA_SM0AR        0x0Cu
#define RESET_DMA_SCR    0x00000000u
#define DMA_FLAGS        0x3Du /* of one stream in ISR and IFCR: FE DME TE HT TC */
#define DMA_FLAG_TE      0x08u
#define DMA_FLAG_HT      0x10u
#define DMA_FLAG_TC      0x20u
#define IRQ_DMA2_STREAM0 56u

/* --- CRC: 32 bits a write, highest bit first --- */
#define CRC_DR       0x00u
#define CRC_CR       0x08u
#define CRC_CR_RESET FIELD(0, 1)
#define RESET_CRC_DR 0xFFFFFFFFu

/* --- IWDG --- */
#define IWDG_KR         0x00u
#define IWDG_KEY_FEED   0xAAAAu
#define IWDG_KEY_ACCESS 0x5555u
#define IWDG_KEY_START  0xCCCCu
#define IWDG_PR         0x04u
#define IWDG_RLR        0x08u
#define IWDG_SR         0x0Cu
#define IWDG_SR_PVU     FIELD(0, 1)
#define IWDG_SR_RVU     FIELD(1, 1)
#define RESET_IWDG_RLR  0x00000FFFu

/* --- the processor's own (Armv7-M) --- */
#define SYST_CSR        0x010u /* 0 enable, 1 interrupt, 2 the processor's clock (else an eighth) */
#define SYST_RVR        0x014u
#define SYST_CVR        0x018u
#define NVIC_ISER(n)    (0x100u + 4u * (n))
#define NVIC_IPR(irq)   (0x400u + ((irq) & ~3u))
#define SCB_ICSR        0xD04u
#define SCB_VTOR        0xD08u
#define SCB_AIRCR       0xD0Cu
#define SCB_AIRCR_KEY   0x05FA0000u
#define SCB_AIRCR_RESET 0x00000004u
#define SCB_SHPR3       0xD20u /* [31:24] SysTick */
#define SCB_CFSR        0xD28u
#define SCB_CPACR       0xD88u
#define SCB_CPACR_FPU   FIELD(20, 4)
#define MPU_CTRL        0xD94u
#define MPU_RBAR        0xD9Cu
#define MPU_RASR        0xDA0u

/* --- DAC81408 on SPI2: a frame is read << 23 | register << 16 | data, first bit first --- */
#define DA_READ       0x800000u
#define DA_DEVICEID   0x01u
#define DA_STATUS     0x02u
#define DA_SPICONFIG  0x03u
#define DA_GENCONFIG  0x04u
#define DA_SYNCCONFIG 0x06u
#define DA_DACPWDWN   0x09u
#define DA_DACRANGE0  0x0Bu /* channels 7 .. 4, 4 bits each, 4 lowest */
#define DA_DACRANGE1  0x0Cu /* channels 3 .. 0 */
#define DA_TRIGGER    0x0Eu
#define DA_DAC(n)     (0x14u + (n)) /* straight binary: 0x8000 is 0 V of +-10 V; reset 0x0000 */
#define DA_ID         0x298u        /* DEVICEID [15:2] */
#define DA_SPI_RUN    0x0A84u       /* reset 0x0AA4 less DEV-PWDWN; SDO-EN stays on */
#define DA_GEN_REF    0x3F00u       /* reset 0x7F00 less REF-PWDWN: the reference inside is on */
#define DA_SYNC_ALL   0x0FF0u       /* channels act at TRIGGER's LDAC */
#define DA_ON_0_TO_4  0xFE0Fu       /* DACPWDWN: bit 4 + n is channel n; 5 .. 7 stay off */
#define DA_RANGE_10V  0xAAAAu
#define DA_LDAC       0x0010u
#define DA_ZERO       0x8000u

#endif
