# SPDX-License-Identifier: MIT
"""contact: the law of one finger."""

from struct import Struct

from .num import AGAIN, TICKS, Rng, sat32, shr, wave


class Contact:
    pack = Struct("<iBBB").pack

    def __init__(self):
        self.turn = self.inward = self.touching = self.started = 0

    def tick(self, par, q, v, lim):
        """lim None: there is nothing to touch."""
        k, b, f0, band, hyst = par
        if not self.started:
            self.turn, self.started = q, 1
        if self.inward:
            if q < self.turn:
                self.turn = q
            elif q - self.turn > band:
                self.turn, self.inward = q, 0
        elif q > self.turn:
            self.turn = q
        elif self.turn - q > band:
            self.turn, self.inward = q, 1
        if lim is None:
            self.touching = 0
        elif q >= lim:
            self.touching = 1
        elif q < lim - hyst:
            self.touching = 0
        c = self.touching
        return (c, shr(k * sat32(q - lim), 20) if c else 0, shr(b * v, 27) if c else 0,
                f0 if self.inward else 0)

    def state(self):
        return self.pack(self.turn, self.inward, self.touching, self.started)


def contact(rate):
    rng = Rng("contact", rate, 0)
    rails = -(1 << 31), (1 << 31) - 1
    q = wave("contact", rate, 1, *rails, 1 << rng.draw(8, 24))
    v = wave("contact", rate, 2, *rails, 1 << rng.draw(8, 28))
    s, par = None, None
    for k in range(TICKS):
        if k in (0, AGAIN):
            s = Contact()
        if k % 32 == 0:
            par = (rng.draw(0, 1024000000), rng.draw(0, 1048576000), rng.draw(0, 20971520),
                   rng.draw(0, 10737418) >> rng.draw(0, 23),
                   rng.draw(0, 10737418) >> rng.draw(0, 23))
            if k:  # a band that the next movement may just reach
                par = par[:3] + (min(10737418, abs(q[k] - q[k - 1])), par[4])
        where = rng.draw(0, 7)
        if k % 32 == 0 or where > 5:
            off = rng.draw(-(1 << 24), 1 << 24)
        elif where < 4:  # at the edges of contact
            off = (0, 1, par[4], par[4] + 1)[where]
        lim = (rng.draw(*rails) if 176 <= k < AGAIN else rails[0] if 24 <= k < 28
               else sat32(q[k] + off))
        row = s.tick(par, q[k], v[k], lim)
        yield (q[k], v[k], lim, *row), s.state()


COLUMNS = "pos_m_q30 vel_mps_q27 lim_m_q30 | touching spring_N_q20 damper_N_q20 pullback_N_q20"

MODULES = {"contact": (COLUMNS, contact)}
