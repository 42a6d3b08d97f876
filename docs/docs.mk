# SPDX-License-Identifier: MIT
# The documents: pages of the headers, tables and diagrams; and the format of sources.

##@ Documents and format
## Make pages of the public headers, build/doc/html; each symbol must be documented.
.PHONY: doc
doc:
	@.ci/deps "$@" doxygen doxygen || exit 3
	@rm -rf $(B)/doc && mkdir -p $(B)/doc
	@{ cat docs/Doxyfile; echo 'OUTPUT_DIRECTORY = $(B)/doc'; echo 'PROJECT_NUMBER = $(version)'; } | \
	    doxygen - 2> $(B)/doc/warnings || true
	@if [ -s $(B)/doc/warnings ] || ! [ -s $(B)/doc/html/index.html ]; then \
	    cat $(B)/doc/warnings; echo "doc: not documented, or no pages" >&2; exit 1; fi
	@echo "$(B)/doc/html/index.html"

fmt_src = $(shell git ls-files '*.c' '*.h' | grep -v _ert_rtw/)
.PHONY: fmt fmt-check
## Format every C source by .clang-format (clang-format 14).
fmt:
	$(Q)clang-format -i $(fmt_src)
# Another version of clang-format would differ in some lines.
fmt-check:
	@test/walk/docs/wide.sh || { echo "$@: lines of more than 100 columns" >&2; exit 1; }
	@.ci/deps "$@" clang-format clang-format || exit 3
	@clang-format --version | grep -q 'version 14' || \
	    { echo "$@: left out: this clang-format is not 14"; exit 0; }; \
	    clang-format --dry-run -Werror $(fmt_src)

## Draw block diagrams of the signal and device tables to build/; docs/ has four of them.
.PHONY: diagrams
dot_look := -Nshape=box -Nstyle=rounded,filled -Nfillcolor=\#f4f7fb -Ncolor=\#1f5fbf \
            -Nfontname="DejaVu Sans" \
            -Ecolor=\#555555 -Efontcolor=\#b03020 -Efontname="DejaVu Sans" \
            -Gfontname="DejaVu Sans" -Gbgcolor=white
diagrams: $(lab)
	@.ci/deps "the block diagrams" dot graphviz fonts-dejavu-core || exit 3
	$(Q)for d in $(basename $(notdir $(wildcard test/lab/diagram/*.dot))); do \
	    $(lab) diagram test/lab/diagram/$$d.dot > $(B)/$$d.dot && \
	    dot $(dot_look) -Tsvg -o $(B)/$$d.svg $(B)/$$d.dot || exit 1; \
	    awk '/^<svg/ { on = 1 } !on || /^<!--/ { next } \
	        { printf "%s%s", $$0, /^<\/(g|svg)>$$/ ? "\n" : " " }' $(B)/$$d.svg > $(B)/$$d.new && \
	    mv $(B)/$$d.new $(B)/$$d.svg || exit 1; \
	    ! [ -f docs/$$d.svg ] || cp $(B)/$$d.svg docs/ || exit 1; \
	done
	$(Q)$(lab) diagram test/lab/diagram/geometry.svg > docs/geometry.svg

## Write the pins of docs/STM32F405.md, table and picture, of wiring.tsv (ARGS=--check: compare).
.PHONY: wiring
wiring:
	@ports/stm32f405/wiring.sh $(ARGS)

## Write the table of docs/CARDS.md: every misbehaviour of a card in every phase of its driver.
.PHONY: cards
cards: $(lab)
	@$(lab) cards > $(B)/cards.md
	@awk '/^<!-- end -->/ { skip = 0 } !skip { print } \
	    /^<!-- exhand cards -->/ { \
	        skip = 1; while ((getline line < "$(B)/cards.md") > 0) print line }' \
	    docs/CARDS.md > $(B)/CARDS.md.new && cp $(B)/CARDS.md.new docs/CARDS.md && \
	    tail -n 1 $(B)/cards.md

FAULTS_TIMES ?= 100000

## Write docs/FAULTS.md: every fault in every state, any fault at any tick (FAULTS_TIMES=100000, ten
## minutes).
.PHONY: faults
faults: $(lab)
	@$(lab) faults > $(B)/faults.md || { tail -n 3 $(B)/faults.md; exit 1; }
	@$(lab) faults --rate 20000 > $(B)/faults_20kHz.md || { tail -n 3 $(B)/faults_20kHz.md; exit 1; }
	@$(lab) faults --times $(FAULTS_TIMES) > $(B)/faults_times.md || { cat $(B)/faults_times.md; \
	    exit 1; }
	@awk -v a="$(B)/faults.md" \
	    -v b="$(B)/faults_times.md" \
	    'function put(f, l) { skip = 1; while ((getline l < f) > 0) print l } \
	    /^<!-- end -->/ { skip = 0 } !skip { print } \
	    /^<!-- exhand faults -->/ { put(a) } /^<!-- exhand faults --times -->/ { put(b) }' \
	    docs/FAULTS.md > $(B)/FAULTS.md.new && cp $(B)/FAULTS.md.new docs/FAULTS.md
	@mkdir -p $(B)/faults && $(lab) faults --out $(B)/faults && if command -v gnuplot >/dev/null; \
	    then \
	    (cd $(B)/faults && gnuplot -c faults.gp "$(CURDIR)/ports/posix/plot") && \
	    cp $(B)/faults/faults.png docs/faults.png && \
	    { $(MAKE) --no-print-directory -s pictures || true; }; fi
	@tail -n 1 $(B)/faults.md; tail -n 1 $(B)/faults_20kHz.md; grep 'times:' $(B)/faults_times.md

## Give the pictures of docs/ a palette of 256 colours, which takes a third of the bytes.
.PHONY: pictures
pictures:
	@.ci/deps "small pictures" pngquant pngquant || exit 3
	@for p in docs/*.png; do [ "$$(od -An -tu1 -j25 -N1 $$p)" -eq 3 ] || \
	    pngquant --speed 1 --strip --nofs --force --ext .png 256 $$p || exit; done
