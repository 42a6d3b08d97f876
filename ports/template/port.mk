# SPDX-License-Identifier: MIT
# Variables a port may set; only PORT_DESC and PORT_SRC are needed on a hosted compiler.
PORT_DESC := does nothing; the start of every new port
PORT_SRC  := ports/template/board.c
# CROSS           prefix of the compiler, e.g. arm-none-eabi-.
# PORT_PKGS       packages of Debian that have it.
# PORT_QEMU       the program that PORT_RUN needs, then its packages.
# PORT_CFLAGS     target and freestanding flags, for the library too.
# PORT_WHOLE      flags with -flto, for scenes with SCENE_WHOLE. Library, scene, loop and cards
#                 become one program, faster and longer. The port's own files stay separate,
#                 but for those of PORT_INLINE: called often, without state.
# PORT_LDFLAGS    e.g. -nostdlib -static.
# PORT_LDSCRIPT   one per memory map, in ldscripts/.
# PORT_RUN        program that runs an image: exit status 0 when it said "done".
# PORT_MAIN       its main(), instead of lib/src/run/image.c lib/src/run/deadman.c.
# PORT_SAY        prints a text, void f(const char *), for the contract test.
# PORT_CYCLES_HZ  frequency of exh_board_cycles(), if it is constant: for the contract test.
# PORT_FLOAT      flags for a controller in floats (scene custom), if PORT_CFLAGS without
#                 -mgeneral-regs-only do not suffice.
# PORT_FLOAT_LIBS libraries for it: -lgcc on a CPU without FPU.
# PORT_SUFFIX     in the name of the image, if one scene makes several.
# PORT_ISO        program that makes the boot medium: PORT_ISO IMAGE ISO [OPTION...].
