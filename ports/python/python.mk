# SPDX-License-Identifier: MIT
# The Python package: source distribution, wheel, and its tests in an environment of their own.

python_scenes := drop guarded calibrate glove bilateral bringup identify

##@ Python
## Build the Python package's sdist and wheel (build/python/dist), install it in an environment of
## its own, and run its tests (ARGS: of pytest).
.PHONY: python python-run
python: $(exhand)
	@.ci/deps "the Python package" "python3 -c 'import ensurepip'" python3 python3-venv || exit 3
	@$(python_run) $(ARGS)
python_run = B=$(B) CC="$(CC)" test/walk/python/python.sh "$(python_scenes)"
# The part for CI. Exit status 3 means that no package index can be reached.
python-run: $(exhand)
	@$(python_run) > $(B)/python.txt 2>&1; s=$$?; tail -n 3 $(B)/python.txt; \
	    [ $$s = 0 ] || [ $$s = 3 ] || { cat $(B)/python.txt; exit 1; }

## Install its sdist on a bare Debian 12 with a C compiler and no Python.h, and run the tests that
## need no host program (root).
.PHONY: python-fresh
python-fresh: python
	@test/walk/fresh/root.sh make bookworm $(B)/fresh/python gcc libc6-dev python3-venv ca-certificates
	@$(python_fresh) $(B)/fresh/python $(B)/python/dist/*.tar.gz
python_fresh = test/walk/python/fresh.sh
