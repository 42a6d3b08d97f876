# SPDX-License-Identifier: MIT
# The world simulator build/posix/world.

# The core needs a C compiler alone. Pictures and meshes are in where their packages are.
# World and host program share the core; it has no clock, socket or picture.
world_core := $(patsubst %,ports/posix/world/%.c,world scene_text scene_find scene_object \
              scene_motion tokens motion rpy \
              shape ahead pace reach finger mesh draw draw_list draw_hand draw_numbers)
# Meshes need the package, a compiler that sees it, and a program that can load it when it runs.
world_tree := $(if $(filter -static,$(LDFLAGS)),,$(if $(call sees,embree3/rtcore.h),3,$(if $(call \
              sees,embree4/rtcore.h),4)))
world_mesh := $(B)/posix/ports/posix/world/$(if $(world_tree),mesh_embree,mesh_none).o
world_gl   := $(and $(call have,SDL2/SDL_ttf.h),$(call have,GL/gl.h),$(call have,png.h))
world_mesh_deps := .ci/deps "the world's meshes" "ls /usr/include/embree*/rtcore.h" \
                   libembree-dev || :
world_pkgs := libsdl2-dev libsdl2-ttf-dev libgl-dev libegl-dev libgl1-mesa-dri libpng-dev \
              fonts-dejavu-core
world      := $(B)/posix/world

world_part := main live alone bench solo link link_put link_param link_trace view \
              $(if $(world_gl),gl gl_program gl_form gl_batch gl_solid gl_layer \
              gl_text,picture_none)
world_core_obj := $(patsubst %.c,$(B)/posix/%.o,$(world_core) $(patsubst %,ports/posix/sim/%.c,lag \
                  plant device))
world_obj  := $(world_core_obj) $(world_mesh) $(world_part:%=$(B)/posix/ports/posix/world/%.o) \
              $(patsubst %,$(B)/posix/ports/posix/base/%.o,ends fifo outpart outfile option key \
              near lines none) \
              $(B)/posix/examples/bilateral/tables.o \
              $(B)/posix/examples/glove/cal.o \
              $(B)/posix/lib/src/run/calib_set.o
world_libs := $(if $(world_gl),-lSDL2 -lSDL2_ttf -lGL -lpng) $(if $(world_tree),-ldl) -lpthread -lm

$(filter $(B)/posix/ports/posix/world/%,$(world_obj)): PORT_HOSTFLAGS += -fno-math-errno \
    $(if $(world_gl),-I$(dir $(call have,SDL2/SDL_ttf.h)) -D_REENTRANT) \
    $(if $(world_tree),-DWORLD_EMBREE=$(world_tree))

$(world): $(world_obj) $(B)/posix/libexhand.a
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(world_libs)

##@ The world simulator
## Build the world simulator build/posix/world; it has pictures and meshes if their packages are
## there.
.PHONY: world world-packages
world-packages:
	@.ci/deps "the world's pictures" "cd /usr/include && ls SDL2/SDL_ttf.h GL/gl.h png.h" \
	    $(world_pkgs) || true
world: world-packages
	@$(world_mesh_deps)
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(world)

## Run exhand and world over UDP as two processes, and in two network namespaces if it may.
.PHONY: two-computers
two-computers:
	@$(MAKE) --no-print-directory $(if $(V),,-s) $(exhand) $(world)
	@$(two_run)
two_run = test/closed/world/two_computers.sh $(exhand) $(world)
.PHONY: two-run
two-run:
	@$(two_run)

$(B)/bench/look: $(B)/posix/test/closed/world/look.o $(world_core_obj) $(world_mesh) \
    $(B)/posix/libexhand.a
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(if $(world_tree),-ldl) -lm

## Measure frames and looks per second, with and without culling, and instructions per look.
.PHONY: bench-world
bench-world: world $(B)/bench/look
	@command -v valgrind >/dev/null && test/closed/world/look.sh $(B)/bench/look || \
	    echo "instructions: not counted: install valgrind"
	@$(world) --bench --scene ports/posix/world/scenes/collision.world $(ARGS)
