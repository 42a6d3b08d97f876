# SPDX-License-Identifier: MIT
# The library as a package: shared library, headers, pkg-config and CMake files.

PREFIX     ?= /usr/local
LIBDIR     ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
DESTDIR    ?=

# The shared library exports the names in lib/exhand.map. Until 1.0 each minor version is another
# interface.
soname := libexhand.so.$(word 1,$(subst ., ,$(version))).$(word 2,$(subst ., ,$(version)))
shared := $(out)/libexhand.so.$(version)
pic    := $(lib_src:%.c=$(out)/pic/%.o)
$(out)/pic/%.o: %.c $(stamp)
	@mkdir -p $(@D)
	$(Q)$(CC) $(base) $(PORT_CFLAGS) $(CFLAGS) -fPIC -c $< -o $@
$(shared): $(pic) lib/exhand.map
	$(Q)$(CC) $(PORT_CFLAGS) $(CFLAGS) -shared -Wl,-soname,$(soname) \
	    -Wl,--version-script=lib/exhand.map $(LDFLAGS) $(pic) -o $@

packages := $(addprefix $(DESTDIR)$(LIBDIR)/,pkgconfig/exhand.pc $(patsubst \
            %,cmake/exhand/exhand-%.cmake,config config-version))
fill_in  := sed 's|@prefix@|$(PREFIX)|; s|@version@|$(version)|; \
            s|@libdir@|$(LIBDIR:$(PREFIX)/%=$${prefix}/%)|; \
            s|@includedir@|$(INCLUDEDIR:$(PREFIX)/%=$${prefix}/%)|; \
            s|@includedir_from_package@|'"$$(realpath -m \
                --relative-to=$(LIBDIR)/cmake/exhand $(INCLUDEDIR))"'|'

# Of the host port's compiler: yes, if it makes programs for an operating system. A bare-metal CPU
# has no shared libraries.
hosted := $(if $(and $(filter posix,$(PORT)),$(filter install%,$(MAKECMDGOALS))),$(shell \
          $(CC) $(CFLAGS) -dM -E -xc /dev/null | grep -qE '__(unix|APPLE)__' && echo yes))

##@ Installation
##6 Install library, headers, pkg-config and CMake files, host program under DESTDIR/PREFIX.
.PHONY: install install-lib
install: all install-lib
	$(if $(filter posix,$(PORT)),install -d $(DESTDIR)$(PREFIX)/bin && \
	    install -m 755 $(program) $(DESTDIR)$(PREFIX)/bin)

## Install the same without the host program, for any CPU (CROSS=arm-none-eabi- CFLAGS=-mcpu=...).
install-lib: $(lib) $(if $(hosted),$(shared))
	install -d $(DESTDIR)$(LIBDIR)/pkgconfig $(DESTDIR)$(LIBDIR)/cmake/exhand \
	    $(DESTDIR)$(INCLUDEDIR)/exhand
	install -m 644 $(lib) $(DESTDIR)$(LIBDIR)
	install -m 644 lib/include/exhand/*.h $(DESTDIR)$(INCLUDEDIR)/exhand
	$(Q)for f in $(packages); do $(fill_in) lib/$$(basename $$f).in > $$f && chmod 644 $$f || \
	    exit 1; done
	$(if $(hosted),install -m 755 $(shared) $(DESTDIR)$(LIBDIR) && \
	    cd $(DESTDIR)$(LIBDIR) && \
	    ln -sf libexhand.so.$(version) $(soname) && ln -sf $(soname) libexhand.so)

## Write build/amalgamation: the library as one header and one source, and one finger's law and
## the limiter, each alone.
.PHONY: amalgamation
amalgamation:
	@.ci/deps "the amalgamation" python3 python3 || exit 3
	@rm -rf $(B)/amalgamation
	@lib/amalgamate.py $(B)/amalgamation/exhand exhand.h
	@lib/amalgamate.py $(B)/amalgamation/exhand_law quad.h velocity.h contact.h
	$(if $(wildcard lib/include/exhand/limiter.h),@lib/amalgamate.py \
	    $(B)/amalgamation/exhand_limiter limiter.h)
