/* SPDX-License-Identifier: MIT */
/* What a Cortex-M starts from, for newlib under an emulator: top of the stack, entry. */
extern void _mainCRTStartup(void);

__attribute__((section(".vectors"), used)) static void *const vectors[] = {
    (void *)0x20400000, (void *)_mainCRTStartup};
