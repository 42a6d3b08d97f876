# SPDX-License-Identifier: MIT
"""exhand: a limiter, kernels, logs, wire and registers of the exhand haptic library.

All values are in SI units, and a name carries its unit where it is not obvious. This is software:
it is no safety function, and it does not replace an emergency stop.
"""
from importlib.metadata import version

from .kernels import Contact, Counter, LowPass, Quadrature, Velocity
from .limiter import Limiter
from .log import Damage, Log
from .wire import Plane, State, World

__version__ = version("exhand")
__all__ = ["Contact", "Counter", "Damage", "Limiter", "Log", "LowPass", "Plane", "Quadrature",
           "State", "Velocity", "World"]
