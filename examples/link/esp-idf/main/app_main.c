/* SPDX-License-Identifier: MIT */
/* Where ESP-IDF begins: the program of finger.c, as it is. */
int finger_main(void);
void app_main(void);

void app_main(void) { (void)finger_main(); }
