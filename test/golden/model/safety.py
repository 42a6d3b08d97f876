# SPDX-License-Identifier: MIT
"""safety: the box's state, and the gate to the D/A."""

from struct import Struct, pack as pack_once
from zlib import crc32

from .drive import DAC, FORCE, FULL, GATE, PULL, any_par
from .num import AGAIN, M32, TICKS, Rng, clamp, gain, period, shr, times, wave

OFF, ARM, RUN, LIMIT, RELEASE, FAULT = range(6)
(ESTOP, DRIVE, OVERRUN, ENCODER, DEADMAN, TRACKING, STUCK, SPEED, GLOVE, CARD, LINK, SUPPLY,
 WATCHDOG, CONFIG, LOGIC) = (1 << b for b in range(15))
CUT = ESTOP | DRIVE | TRACKING | CARD | WATCHDOG | CONFIG | LOGIC
ON = {name: i for i, name in enumerate(
    "refused cut latched released cause off armed limited run clear none".split())}
HEALTHY = 0x1F0F
LATE = 64
FINGERS = 5
LIMITS = 12


def any_safety(rng, rate):
    """missed_max, arm_force, arm_time, ramp_time, release_time"""
    most, small = rng.draw(0, 1), rng.draw(104858, 10485760)
    arm, ramp = (clamp(rng.draw(2, hi) * 1000 // rate, 1, ms) for hi, ms in ((6, 1000), (16, 5000)))
    return most, small, arm, ramp, rng.draw(5, 18)


class Safety:
    pack = Struct("<22Ii5B5H").pack

    def __init__(self, par, T):
        most, self.small, arm, ramp, release = par
        ticks = [ms * T[1] // (1000 * T[0]) for ms in (arm, ramp, release)]
        self.late_max, self.arm_ticks = LATE * most, max(2, ticks[0] + 1)
        self.ramp, self.release_ticks = -(-FULL // (ticks[1] + 1)), max(3, ticks[2])
        if T[1] < 500 * T[0]:
            self.release_ticks = min(4, self.release_ticks)
        self.fall = gain(1, self.release_ticks)
        self.present = self.faults = self.first = self.first_tick = self.tick = 0
        self.missed = self.late = self.limits = self.refusals = self.steps = self.share = 0
        self.held = [0] * LIMITS
        self.off = [0] * FINGERS
        self.state_ = self.alive = self.refused = self.opened = self.trigger = 0

    def open(self):
        return self.state_ in (RUN, LIMIT, RELEASE) or self.state_ == ARM and self.share > 0

    def arm_step(self):
        return self.refused if self.state_ != ARM else 64 if self.share else 32

    def causes(self, din, raised, fingers):
        ready = (1 << fingers) - 1
        p = raised
        for bit, cause in ((1, ESTOP), (2, DEADMAN), (4, WATCHDOG), (8, CARD)):
            p |= 0 if din & bit else cause
        p |= 0 if din >> 8 & ready == ready else DRIVE
        return p | (OVERRUN if self.late > self.late_max else 0)

    def latch(self, p):
        if p and not self.faults:
            self.first, self.first_tick = p, self.tick
        self.faults |= p

    def move(self, p, lacks, command):
        """(trigger, state)"""
        state = self.state_
        if state == OFF:
            if command == 1 and lacks:
                return "refused", OFF
            if p:
                return "cut" if p & CUT else "cause", OFF
            return ("off", OFF) if command == 2 else ("run", ARM) if command == 1 else ("none", OFF)
        if state == FAULT:
            if p:
                return "cut" if p & CUT else "cause", FAULT
            if command == 3 and self.opened:
                return "clear", OFF
            return {2: "off", 1: "run"}.get(command, "none"), FAULT
        early = state == ARM and not self.share
        if early and (lacks or command == 2):
            return "refused", OFF
        if p & CUT:
            return "cut", FAULT
        if state == RELEASE and self.steps >= self.release_ticks:
            return ("latched", FAULT) if self.faults else ("released", OFF)
        if p:
            return "cause", RELEASE
        if command == 2 or state == ARM and not early and lacks & 15:
            return "off", RELEASE
        if state == ARM and self.share == FULL:
            return "armed", RUN
        if state in (RUN, LIMIT):
            if self.limits & ~PULL:
                return "limited", LIMIT
            return "run" if command == 1 else "none", RUN
        return "run" if command == 1 else "none", state

    def step(self, din, raised, missed, command, fingers, ready):
        """mode, share, small, ticks, fall of the permit"""
        self.missed = min(M32, self.missed + missed)
        self.late = min(4 * LATE, max(0, self.late - 1) + LATE * min(missed, 2))
        self.held = [min(M32, h + (self.limits >> b & 1)) for b, h in enumerate(self.held)]
        self.present = p = self.causes(din, raised, fingers)
        lacks = ~ready & 15 | (16 if p else 0) | (32 if self.limits & FORCE else 0)
        if self.open() or self.state_ == FAULT:
            self.latch(p)
        if p:
            self.opened = int(p == DEADMAN and not din & 2)
        before = self.state_
        trigger, self.state_ = self.move(p, lacks, command)
        self.trigger = ON[trigger]
        if trigger == "refused" and lacks:
            self.refused, self.refusals = lacks & -lacks, min(M32, self.refusals + 1)
        if trigger == "clear":
            self.faults = 0
        if trigger == "armed":
            self.refused = 0
        anew = self.state_ != before
        if anew:
            self.steps = self.share = 0
        if self.state_ == RELEASE:
            self.steps = min(M32, self.steps + min(M32, missed + 1))
        if self.state_ == ARM and not anew:
            self.steps += 1
            if self.steps >= self.arm_ticks:
                self.share = min(FULL, self.share + self.ramp)
        self.tick = (self.tick + 1) & M32
        mode = 2 if self.state_ == RELEASE else 1 if self.open() else 0
        share = self.share if self.state_ == ARM else FULL
        return mode, share, self.small, min(M32, missed + 1), self.fall

    def gate(self, pars, currents, limits):
        """(limits, gate, dac, coded, code) a finger, and enable."""
        out, enable = [], 0
        for i, (par, cur, told) in enumerate(zip(pars, currents, limits)):
            zero, span, scale = par[6:9]
            span = min(span, min(par[3], par[12]) * scale >> 42)
            code = zero
            if self.open():
                enable |= 1 << i
                asked = shr(cur * scale, 42)
                most = min(span, self.off[i]) if self.state_ == RELEASE else span
                code = clamp(zero + clamp(asked, -most, most), 0, 65535)
                told |= DAC if code != zero + asked else 0
                coded = times(gain(1 << 42, scale), code - zero)
                out.append((told, 0, coded - cur, coded, code))
            else:
                out.append((told | (GATE if cur else 0), -cur, 0, 0, zero))
            self.off[i] = abs(code - zero)
        self.alive = (self.alive + 1) & 255
        self.limits = 0
        for o in out:
            self.limits |= o[0]
        return out, enable

    def state(self):
        b = self.pack(self.present, self.faults, self.first, self.first_tick, self.tick,
                      self.missed, self.late, self.limits, *self.held, self.refusals, self.steps,
                      self.share, self.state_, self.alive, self.refused, self.opened, self.trigger,
                      *self.off)
        return b + pack_once("<I", crc32(b) * 0x9E3779B1 & M32)


def safety(rate):
    rng = Rng("safety", rate, 0)
    end = 442918502
    waves = [wave("safety", rate, 1 + i, -end, end, 1 << rng.draw(10, 26)) for i in range(FINGERS)]
    s, din = None, 0
    for k in range(TICKS):
        if k in (0, AGAIN):
            s, n = Safety(any_safety(rng, rate), period(rate, k)), rng.draw(1, FINGERS)
            pars = [any_par(rng, rate) for _ in range(n)]
            din = HEALTHY
        if rng.draw(0, 127) == 0:
            din ^= 1 << rng.draw(0, 12)
        elif rng.draw(0, 1) == 0:
            din = HEALTHY
        if s.state_ == FAULT and rng.draw(0, 1) == 0:
            din ^= 2
        raised = (1 << rng.draw(0, 14) if rng.draw(0, (63, 127, 15, 15, 15, 31)[s.state_]) == 0
                  else 0)
        missed = rng.draw(0, 2) if rng.draw(0, 7 if s.state_ == RELEASE else 63) == 0 else 0
        if k in (188, 190):
            missed = rng.draw(0, M32)
        command = (1, 3, 1, 3, 4, 0, 0, 0)[rng.draw(0, 7)]
        if rng.draw(0, 63) == 0:
            command = 2
        ready = rng.draw(0, 15) if rng.draw(0, 7 if s.state_ == OFF else 63) == 0 else 15
        told, cur = [], [w[k] for w in waves[:n]]
        for f in range(n):
            if s.state_ == RELEASE:  # what should fall does not
                cur[f] = rng.draw(-end, end)
            told.append(1 << rng.draw(0, 10) if rng.draw(0, 15) == 0 else 0)
            if f == 0 and rng.draw(0, 3) == 0:
                told[0] |= PULL
        permit = s.step(din, raised, missed, command, n, ready)
        out, enable = s.gate(pars, cur, told)
        row = [din, raised, missed, command, ready, *permit[:4], *permit[4], enable, s.alive]
        for i in range(FINGERS):
            row += out[i] if i < n else (0, 0, 0, 0, pars[0][6])
        yield row, s.state()


COLUMNS = ("din raised missed command ready | mode share_q30 small_N_q20 ticks fall fall_shift "
           "enable alive " +
           " ".join("%s%d" % (name, i) for i in range(FINGERS)
                    for name in ("limits", "gate_A_q26_", "dac_A_q26_", "coded_A_q26_", "code")))

MODULES = {"safety": (COLUMNS, safety)}
