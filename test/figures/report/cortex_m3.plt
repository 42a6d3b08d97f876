# SPDX-License-Identifier: MIT
load here.'/work.gp'
