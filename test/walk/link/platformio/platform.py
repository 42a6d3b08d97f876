# SPDX-License-Identifier: MIT
from platformio.public import PlatformBase


class NativePlatform(PlatformBase):
    pass
