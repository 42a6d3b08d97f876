# SPDX-License-Identifier: MIT
# The contract test as an image. It calls the board itself, so it has a main() and no tick.
SCENE_DESC   := the port contract, every check printed
SCENE_MAIN   := $(addprefix test/port/,image.c say.c contract_test.c contract/contract.c) \
                test/support.c
SCENE_SRC    :=
SCENE_ROM    := yes
CONTRACT_RATE_HZ ?= 1000
SCENE_CFLAGS  = -Itest -Itest/port -DEXH_CHECK_PLAIN -DEXH_CHECK_PUTCHAR=contract_put \
                -DCONTRACT_REAL_TIME \
                -DCONTRACT_RATE_HZ=$(CONTRACT_RATE_HZ)u $(PORT_SAY:%=-DCONTRACT_SAY=%) \
                $(PORT_CYCLES_HZ:%=-DCONTRACT_CYCLES_HZ=%u)
# The printer divides 64 bits by ten: of the compiler's own library, not of C's.
SCENE_LIBS   := -lgcc
