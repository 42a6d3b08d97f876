#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs an image under QEMU's netduinoplus2, which has of this chip the processor, UARTs and timers:
# run.sh IMAGE. Text comes by USART2, the second serial line. Exit status and the rest of the
# environment: ports/mps2/run.sh.
SERIAL="-serial null -serial stdio" MACHINE=${MACHINE:-netduinoplus2} exec ports/mps2/run.sh "$@"
