#!/bin/sh
# SPDX-License-Identifier: MIT
# cortex_m.sh MACHINE IMAGE: runs an image under QEMU; what the environment says of EXH_* goes with
# it.
# Exit status: the image's, 5 a processor exception, 124 it did not end.
args=arg=image
for v in $(env | grep '^EXH_[A-Z]*='); do args=$args,arg=$v; done
exec timeout "${TIMEOUT_s:-7200}" qemu-system-arm -M "$1" -kernel "$2" -display none -serial none \
    -monitor none \
    -semihosting-config "enable=on,target=native,$args" </dev/null
