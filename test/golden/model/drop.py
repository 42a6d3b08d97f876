# SPDX-License-Identifier: MIT
"""The scenes drop and guarded: one tick from an encoder's counter to a D/A code."""

from .chatter import Chatter, any_par as any_chatter
from .contact import Contact
from .drive import Drive, Table, any_par
from .guard import Rail, Supply, any_supply
from .num import AGAIN, M32, TICKS, Rng, period, sat32, shr, wave
from .passivity import Passivity
from .quad import narrowest, position
from .safety import ENCODER, FAULT, HEALTHY, SUPPLY, TRACKING, Safety, any_safety
from .track import Monitor, Track, any_par as any_track
from .velocity import Window, scale
from .watch import Watch, any_par as any_watch


class Drop:
    def __init__(self, step, speed, p, law, drive, track, watch, safety, supply, lim, kf, chatter,
                 T):
        self.step, self.law, self.drive_par, self.lim = step, law, drive, lim
        self.quad, self.bits = narrowest(step, speed, T)
        self.velocity, self.contact, self.safety = Window(step, T, p), Contact(), Safety(safety, T)
        self.supply = Supply(supply, T)
        self.track, self.watch, self.last = Track(track, T), Watch(watch, T), 0
        peak = drive[3]
        top = sat32(shr(kf * peak, 26))
        self.chatter = Chatter(chatter, (top, peak), step, T)
        self.drive = Drive(drive, T, Table([(0, 0), (top, peak)]),
                           Table([(-peak, -top), (peak, top)]))

    def tick(self, raw, mon, din, supply, missed, command):
        cnt = self.quad.tick(raw)
        q, v = position(cnt, self.step), self.velocity.tick(cnt)
        i_mon, f_mon = self.drive.monitor(mon)
        raised = (ENCODER if self.quad.lost else 0) | (TRACKING if self.track.step(i_mon) else 0)
        raised |= self.chatter.step()
        raised |= SUPPLY if self.supply.step(supply, missed) else 0
        fast, v, limits = self.watch.step(v)
        permit = self.safety.step(din, raised | fast, missed, command, 1,
                                  7 if self.quad.lost else 15)
        c, spring, damper, pull = self.contact.tick(self.law, q, v, self.lim)
        bit, term = self.behind(cnt, c, spring + damper)
        told, _, _, _, force = self.drive.take(permit, spring + damper + pull + term, term)
        more, i0, peak, i2t = self.drive.current()
        ((limits, _, _, coded, code),), enable = self.safety.gate(
            [self.drive_par], [i0 + peak + i2t], [limits | bit | told | more])
        self.track.coded(coded)
        self.watch.coded(cnt, coded)
        self.chatter.coded(cnt, coded)
        self.last = coded
        more = self.after(force, pull, coded, term)
        return (q, v, force, coded, c, f_mon, limits, self.safety.state_,
                self.safety.faults, self.safety.present, self.safety.arm_step(), *more, code,
                enable, self.safety.alive)

    def behind(self, cnt, c, asked):
        """(bit, term) of what acts behind the law."""
        return 0, 0

    def after(self, force, pull, coded, term):
        """Further signals."""
        return ()

    def state(self):
        return (self.quad.state() + self.velocity.state() + self.contact.state() +
                self.drive.state() +
                self.track.state() + self.watch.state() + self.chatter.state() +
                self.safety.state() + self.supply.state())


class Guarded(Drop):
    def guard(self, on, T):
        top, peak = self.drive.to_cur.knots[-1]
        self.on = on
        self.passivity = Passivity(self.drive.top, Table([(0, 0), (peak, top)]), self.step, T,
                                   self.watch.most)

    def behind(self, cnt, c, asked):
        return self.passivity.tick(self.on, self.drive_par[0], cnt, c, asked)

    def after(self, force, pull, coded, term):
        self.passivity.hold(self.on, force, pull, coded)
        return self.passivity.joule(), sat32(term)

    def state(self):
        return super().state() + self.passivity.state()


def drop(rate, name="drop", kind=Drop):
    rng, monitor = Rng(name, rate, 0), Monitor()
    for k in range(TICKS):
        if k in (0, AGAIN):
            step, speed, p = scale(rng), rng.draw(13421773, (1 << 31) - 1), rng.draw(0, 4)
            law = (rng.draw(0, 1024000000) >> rng.draw(0, 12),
                   rng.draw(0, 1048576000) >> rng.draw(0, 12), rng.draw(0, 20971520),
                   rng.draw(0, 10737418) >> rng.draw(0, 12),
                   rng.draw(0, 10737418) >> rng.draw(0, 12))
            drive, track = any_par(rng, rate), any_track(rng, rate)
            watch, safety, supply = (any_watch(rng, rate), any_safety(rng, rate),
                                     any_supply(rng, rate, 31))
            lim, kf = rng.draw(-(1 << 26), 1 << 26), rng.draw(104858, 104857600)
            chatter = any_chatter(rng)
            # Quiet enough to run, not touching at first, and to and fro through the wall.
            drive, lim = drive[:2] + (10000000,) + drive[3:], abs(lim >> 8)
            s = kind(step, speed, p, law, drive, track, watch, safety, supply, lim, kf,
                     chatter, period(rate, k))
            if kind is Guarded:
                s.guard(rng.draw(0, 2), period(rate, k))
            jump = s.quad.jump if kind is Drop else s.passivity.way
            moves = wave(name, rate, 1 + (k > 0), -jump, jump, max(1, jump >> 10))
            raw, din, rail = rng.u64() & M32, HEALTHY, Rail(supply[4])
        if k < 8 or k >= 56:  # to both rails no longer than a hand would
            raw += moves[k]
        else:
            raw += moves[k] >> 3
        if 180 <= k < AGAIN:
            raw += rng.draw(-2 * jump, 2 * jump)
        if rng.draw(0, 191) == 0:
            din ^= 1 << rng.draw(0, 8)
        elif rng.draw(0, 3) == 0:
            din = HEALTHY
        if s.safety.state_ == FAULT and rng.draw(0, 3) == 0:
            din ^= 2
        missed = 1 if rng.draw(0, 127) == 0 else 0
        command = 1 if k % 4 == 2 or k % AGAIN == 0 else 3 if k % 8 == 5 else 0
        if rng.draw(0, 255) == 0:
            command = 2
        fed = rail.draw(rng, k)
        mon = monitor.draw(rng, drive, s.last)
        yield (raw & M32, mon, din, fed, missed, command,
               *s.tick(raw & M32, mon, din, fed, missed, command)), s.state()


COLUMNS = ("raw mon_raw din supply_raw missed command | q_m_q30 qd_mps_q27 f_des_N_q20 i_des_A_q26 "
           "c f_mon_N_q20 "
           "limits state faults present arm_step dac_raw enable alive")



def guarded(rate):
    return drop(rate, "guarded", Guarded)


MODULES = {"drop": (COLUMNS, drop),
           "guarded": (COLUMNS.replace("arm_step", "arm_step energy_J_q24 passivity_N_q20"),
                       guarded)}
