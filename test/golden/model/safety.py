"""safety: the box's state, and the gate to the D/A."""

from struct import Struct

from .drive import DAC, GATE, any_par
from .num import AGAIN, M32, TICKS, Rng, clamp, gain, shr, times, wave

OFF, RUN, FAULT = 0, 1, 2
ESTOP, DRIVE, OVERRUN, ENCODER, DEADMAN, TRACKING = 1, 2, 4, 8, 16, 32
LATE = 64
FINGERS = 5


class Safety:
    pack = Struct("<7I2B").pack

    def __init__(self):
        self.present = self.faults = self.first = self.first_tick = self.tick = 0
        self.missed = self.late = self.state_ = self.alive = 0

    def step(self, missed_max, din, raised, missed, command, fingers):
        most = missed_max if missed_max in (0, 1) else 0
        self.missed = min(M32, self.missed + missed)
        self.late = max(0, self.late - 1) + LATE * min(missed, 2)
        ready = (1 << fingers) - 1
        p = raised
        p |= 0 if din & 1 else ESTOP
        p |= 0 if din >> 8 & ready == ready else DRIVE
        p |= OVERRUN if self.late > LATE * most else 0
        p |= 0 if din & 2 else DEADMAN
        self.present = p
        if self.state_ == OFF:
            if command == 1 and not p:
                self.state_ = RUN
        elif self.state_ == RUN:
            if p:
                self.state_, self.faults, self.first, self.first_tick = FAULT, p, p, self.tick
            elif command == 2:
                self.state_ = OFF
        else:
            self.faults |= p
            if command == 3 and not p:
                self.state_, self.faults = OFF, 0
        self.tick = (self.tick + 1) & M32
        return self.state_

    def gate(self, pars, currents):
        """(limits, gate, dac, coded, code) a finger, and enable."""
        out, enable = [], 0
        for i, (par, cur) in enumerate(zip(pars, currents)):
            zero, span, scale = par[6:9]
            if self.state_ == RUN:
                enable |= 1 << i
                asked = shr(cur * scale, 42)
                code = clamp(zero + clamp(asked, -span, span), 0, 65535)
                limits = DAC if code != zero + asked else 0
                coded = times(gain(1 << 42, scale), code - zero)
                out.append((limits, 0, coded - cur, coded, code))
            else:
                out.append((GATE if cur else 0, -cur, 0, 0, zero))
        self.alive = (self.alive + 1) & 255
        return out, enable

    def state(self):
        return self.pack(self.present, self.faults, self.first, self.first_tick, self.tick,
                         self.missed, self.late, self.state_, self.alive)


def safety(rate):
    rng = Rng("safety", rate, 0)
    end = 442918502
    waves = [wave("safety", rate, 1 + i, -end, end, 1 << rng.draw(10, 26)) for i in range(FINGERS)]
    s, din = None, 0
    for k in range(TICKS):
        if k in (0, AGAIN):
            s, most, n = Safety(), rng.draw(-1, 2), rng.draw(1, FINGERS)
            pars = [any_par(rng, rate) for _ in range(n)]
            din = 0x1F03
        if rng.draw(0, 31) == 0:
            din ^= 1 << rng.draw(0, 12)
        elif rng.draw(0, 7) == 0:
            din = 0x1F03
        raised = 1 << rng.draw(0, 5) if rng.draw(0, 31) == 0 else 0
        missed = rng.draw(0, 2) if rng.draw(0, 63) == 0 else 0
        if k in (188, 190):
            missed = rng.draw(0, M32)
        command = (0, 2, 4, 1, 3, 1, 3, 1)[rng.draw(0, 7)]
        state = s.step(most, din, raised, missed, command, n)
        out, enable = s.gate(pars, [w[k] for w in waves[:n]])
        row = [din, raised, missed, command, state, enable, s.alive]
        for i in range(FINGERS):
            row += out[i] if i < n else (0, 0, 0, 0, pars[0][6])
        yield row, s.state()


COLUMNS = "din raised missed command | state enable alive " + " ".join(
    "%s%d" % (name, i) for i in range(FINGERS)
    for name in ("limits", "gate_A_q26_", "dac_A_q26_", "coded_A_q26_", "code"))

MODULES = {"safety": (COLUMNS, safety)}
