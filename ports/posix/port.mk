# SPDX-License-Identifier: MIT
PORT_DESC      := simulated device in virtual time
# The simulation must give the same digits everywhere: no contraction, no x87.
PORT_HOSTFLAGS := -D_POSIX_C_SOURCE=200809L -ffp-contract=off -Iports/posix -Iports/posix/exhand \
                  -Itest -DBILATERAL_KEEP_FRAMES=8
