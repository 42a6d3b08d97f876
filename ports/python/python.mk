# SPDX-License-Identifier: MIT
# The Python package: source distribution, wheel, and its tests in an environment of their own.

python_scenes := drop guarded calibrate glove bilateral bringup identify

##@ Python
## Build the Python package's sdist and wheel (build/python/dist), install it in an environment of
## its own, and run its tests (ARGS: of pytest).
.PHONY: python
python: $(exhand)
	@.ci/deps "the Python package" "python3 -c 'import ensurepip'" python3 python3-venv || exit 3
	@B=$(B) CC="$(CC)" test/walk/python/python.sh "$(python_scenes)" $(ARGS)
