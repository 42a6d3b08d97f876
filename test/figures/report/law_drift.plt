# SPDX-License-Identifier: MIT
load here.'/drift.gp'
