# SPDX-License-Identifier: MIT
# The same at another rate.
CONTRACT_RATE_HZ := 90
include test/port/contract/scene.mk
