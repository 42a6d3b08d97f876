#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The FMUs against the native run: fmi.py FMU-FOLDER NATIVE EXHAND FALLS RATE...: FMPy validates
and compiles them and runs them alone and together; fmuloader, another importer, runs them together,
too. Every output of every step is the native one, bit for bit. With all defaults they are a run
of `exhand drop`, row by row. A third importer, ecos, where it can be had."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import zipfile

import fmpy
import fmuloader.fmi3
import numpy
from fmpy.build import build_platform_binary
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

try:
    import ecospy
except (ImportError, OSError): # it wants libtbb.so.12
    ecospy = None

failed = 0


def say(ok, text):
    global failed
    failed += not ok
    print(f"  {'ok' if ok else 'FAILED'} {text}", flush=True)


class Native:
    """A run as native.c prints it: parameters, and a dictionary a tick."""

    def __init__(self, program, rate, falls):
        self.rate, self.falls, self.param, self.tick = rate, falls, {}, []
        for line in subprocess.run([program, str(rate), str(falls), "1"], check=True,
                                   capture_output=True, text=True).stdout.splitlines():
            word = line.split()
            if word[0] == "param":
                self.param[word[1]] = int(word[2]) / 2 ** int(word[3])
            elif word[0] == "columns":
                column = [w.split(":") for w in word[1:]]
            else:
                self.tick.append({n: int(v) / 2 ** int(f) for (n, f), v in zip(column, word)})
        self.inputs = [n for n, _ in column[:6]]
        self.outputs = [n for n, _ in column[6:]]


class Described:
    """An FMU's variables by name, for any importer that has get and set by type."""

    def __init__(self, folder):
        self.description = fmpy.read_model_description(str(folder))
        self.variable = {v.name: v for v in self.description.modelVariables}

    def reference(self, name):
        v = self.variable[name]
        return v.valueReference, v.type


class ByFmpy(Described):
    name = "FMPy"

    def __init__(self, folder):
        super().__init__(folder)
        d = self.description
        self.said = []
        self.fmu = FMU3Slave(guid=d.guid, unzipDirectory=str(folder),
                             modelIdentifier=d.coSimulation.modelIdentifier, instanceName="a")
        self.fmu.instantiate(loggingOn=True)

    def put(self, name, value):
        vr, kind = self.reference(name)
        self.fmu.setInt32([vr],
                          [int(value)]) if kind == "Int32" else self.fmu.setFloat64([vr], [value])

    def get(self, name):
        vr, kind = self.reference(name)
        return self.fmu.getInt32([vr])[0] if kind == "Int32" else self.fmu.getFloat64([vr])[0]

    def start(self):
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def step(self, t, h):
        self.fmu.doStep(t, h)

    def end(self):
        self.fmu.terminate()
        self.fmu.freeInstance()

    def state(self):
        return self.fmu.serializeFMUState(self.fmu.getFMUState())

    def restore(self, data):
        self.fmu.setFMUState(self.fmu.deserializeFMUState(data))


class ByFmuloader(Described):
    name = "fmuloader"

    def __init__(self, folder):
        super().__init__(folder)
        d = self.description
        self.fmu = fmuloader.fmi3.Fmi3Slave(str(folder),
                                            model_identifier=d.coSimulation.modelIdentifier)
        self.fmu.instantiate_co_simulation("b", instantiation_token=d.guid)

    def put(self, name, value):
        vr, kind = self.reference(name)
        self.fmu.set_int32([vr],
                           [int(value)]) if kind == "Int32" else self.fmu.set_float64([vr], [value])

    def get(self, name):
        vr, kind = self.reference(name)
        return (self.fmu.get_int32([vr]) if kind == "Int32" else self.fmu.get_float64([vr]))[0]

    def start(self):
        self.fmu.enter_initialization_mode()
        self.fmu.exit_initialization_mode()

    def step(self, t, h):
        self.fmu.do_step(t, h)

    def end(self):
        self.fmu.terminate()
        self.fmu.free_instance()


def controller(importer, folder, native):
    c = importer(folder["ExhandController"])
    c.put("period_den", native.rate)
    for name, value in native.param.items():
        c.put(name, value)
    c.start()
    return c


def device(importer, folder, native):
    d = importer(folder["ExhandDevice"])
    for name, value in (("period_den", native.rate), ("falls", native.falls)):
        d.put(name, value)
    d.start()
    return d


def differs(native, n, unit, names, what):
    """The first of these outputs in tick n that is not the native run's."""
    for name in names:
        ours = unit.get(name)
        if ours != native.tick[n][name]:
            print(f"  {what}: step {n}: {name}: {ours!r}, native {native.tick[n][name]!r}")
            return True
    return False


def alone_controller(importer, folder, native):
    """By the inputs that the native one had; in mid-run kept as bytes, led astray, and put back."""
    c, h, bad = controller(importer, folder, native), 1 / native.rate, False
    kept = len(native.tick) // 2
    for n, tick in enumerate(native.tick):
        if n == kept and hasattr(c, "state"):
            data = c.state()
            c.put("din", 0)
            for k in range(50):
                c.step(n * h, h)
            bad = bad or c.get("faults") == 0
            c.restore(data)
        for name in native.inputs:
            c.put(name, tick[name])
        c.step(n * h, h)
        bad = bad or differs(native, n, c, native.outputs, "controller")
    c.end()
    return not bad


def alone_device(importer, folder, native):
    d, h, bad = device(importer, folder, native), 1 / native.rate, False
    for n, tick in enumerate(native.tick):
        bad = bad or differs(native, n, d, native.inputs[:4], "device")
        for name in ("dac_raw", "enable", "state"):
            d.put(name, tick[name])
        d.step(n * h, h)
    bad = bad or d.get("done") != 1
    d.end()
    return not bad


def together(importer, folder, native):
    """Controller first, then the device, a period at a time: as many steps as the native run had
    ticks."""
    c, d, h, bad, n = (controller(importer, folder, native), device(importer, folder, native),
                       1 / native.rate, False, 0)
    while not d.get("done") and not bad and n < len(native.tick):
        for name in ("enc_raw", "mon_raw", "supply_raw", "din"):
            c.put(name, d.get(name))
        c.step(n * h, h)
        bad = differs(native, n, c, native.outputs, "together")
        for name in ("dac_raw", "enable", "state"):
            d.put(name, c.get(name))
        d.step(n * h, h)
        n += 1
    done = d.get("done") == 1
    c.end()
    d.end()
    return not bad and done and n == len(native.tick)


def moved(folder, native, unit, inputs, outputs, late):
    """Moves a fall in its middle into an instance without period and parameters, and returns what
    it still gives. late: outputs behind the step."""
    h, kept, bad = 1 / native.rate, [t["c"] for t in native.tick].index(1) - 3, False
    u = (controller if late else device)(ByFmpy, folder, native)
    for n, tick in enumerate(native.tick):
        if n == kept:
            data = u.state()
            u.end()
            u = ByFmpy(folder[unit])
            u.restore(data)
        if not late:
            bad = bad or differs(native, n, u, outputs, "device, moved")
        for name in inputs:
            u.put(name, tick[name])
        u.step(n * h, h)
        if late:
            bad = bad or differs(native, n, u, outputs, "controller, moved")
    u.end()
    return not bad


def simulated(folder, native, name, inputs, outputs, values, first):
    """By FMPy's own simulate_fmu(), whose row n is the instant n: inputs of the native run in, its
    outputs `first` rows later."""
    table = numpy.array([(n / native.rate, *(int(t[i]) for i in inputs))
                         for n, t in enumerate(native.tick)],
                        dtype=[("time", float)] + [(i, numpy.int32) for i in inputs])
    row = fmpy.simulate_fmu(str(folder[name]), input=table, output=outputs,
                            start_values={**values, "period_den": native.rate}, output_interval=1 /
                            native.rate, stop_time=len(native.tick) / native.rate)
    return (len(row) == len(native.tick) + 1 and
            all(row[o][n + first] == t[o] for n, t in enumerate(native.tick) for o in outputs))


INTO_CONTROLLER, INTO_DEVICE = (("enc_raw", "mon_raw", "supply_raw", "din"),
                                ("dac_raw", "enable", "state"))
WALL = {"uncalibrated": 1, "q_lim": 0.07, "k": 2000.0, "b": 15.0}


def parallel(folder, steps):
    """Both in the same step in FMPy, as a master without an order does: codes come a period
    later."""
    c, d, rows = ByFmpy(folder["ExhandController"]), ByFmpy(folder["ExhandDevice"]), []
    for name, value in WALL.items():
        c.put(name, value)
    c.start()
    d.start()
    for n in range(steps):
        counts, codes = [d.get(x) for x in INTO_CONTROLLER], [c.get(x) for x in INTO_DEVICE]
        for name, value in zip(INTO_CONTROLLER, counts):
            c.put(name, value)
        for name, value in zip(INTO_DEVICE, codes):
            d.put(name, value)
        c.step(n / 2000, 1 / 2000)
        d.step(n / 2000, 1 / 2000)
        rows.append([c.get("dac_raw"), c.get("state"), d.get("enc_raw"), d.get("mon_raw"),
                     c.get("f_des"), d.get("x")])
    c.end()
    d.end()
    return rows


def parallel_ecos(folder, steps):
    """The same in ecos, an engine with a separate importer in C++."""
    s, rows = ecospy.EcosSimulationStructure(), []
    for short, name in (("c", "ExhandController"), ("d", "ExhandDevice")):
        archive = shutil.make_archive(str(folder[name]) + "-built", "zip", folder[name])
        s.add_model(short, shutil.move(archive, archive[:-4] + ".fmu"))
    for name in INTO_CONTROLLER:
        s.make_int_connection(f"d::{name}", f"c::{name}")
    for name in INTO_DEVICE:
        s.make_int_connection(f"c::{name}", f"d::{name}")
    s.add_parameter_set("wall", {f"c::{name}": value for name, value in WALL.items()})
    run = ecospy.EcosSimulation(structure=s, step_size=1 / 2000)
    run.init(parameter_set="wall")
    for _ in range(steps):
        run.step(1)
        rows.append([run.get_integer(i)
                     for i in ("c::dac_raw", "c::state", "d::enc_raw", "d::mon_raw")] +
                    [run.get_real(i) for i in ("c::f_des", "d::x")])
    return rows


DROP = ("--rate", "2000", "--falls", "1", "--runs", "1")


def dropped(exhand):
    """The columns and the rows of that run's log, as `exhand csv --all` prints them."""
    with tempfile.TemporaryDirectory() as at:
        subprocess.run([exhand, "drop", *DROP, "--out", at], check=True, capture_output=True)
        text = subprocess.run([exhand, "csv", "--all", f"{at}/drop_2000Hz.exh"], check=True,
                              capture_output=True, text=True).stdout
    columns, *rows = [line.split(",") for line in text.splitlines()]
    return columns, rows


def by_default(folder, exhand):
    """Nothing is set but what one gives the other: each row of that run, in all its digits."""
    columns, rows = dropped(exhand)
    c, d = ByFmpy(folder["ExhandController"]), ByFmpy(folder["ExhandDevice"])
    names = [max((v for v in c.variable if col == v or col.startswith(v + "_")), key=len)
             for col in columns[1:]]
    c.start()
    d.start()
    h, bad = float(c.description.defaultExperiment.stepSize), 0
    for n, row in enumerate(rows):
        for name in INTO_CONTROLLER:
            c.put(name, d.get(name))
        c.step(n * h, h)
        got = [f"{n * h:.9f}"] + [f"{c.get(name):.9g}" for name in names]
        if got != row and not bad:
            print(f"  row {n} of {columns}: {got}, exhand drop {row}")
        bad += got != row
        for name in INTO_DEVICE:
            d.put(name, c.get(name))
        d.step(n * h, h)
    say(not bad and len(rows) > 2000 and d.get("done") == 1,
        f"both with all defaults: {len(rows) - bad} of {len(rows)} rows of exhand drop "
        f"{' '.join(DROP)}, {len(columns)} columns")
    c.end()
    d.end()


def defaults_of_drop(folder, native):
    """Start values are what the native run took, to the bit."""
    v = Described(folder["ExhandController"]).variable
    wrong = [n for n, x in native.param.items() if float(v[n].start) != x]
    say(not wrong, f"start values: {len(native.param)} as in exhand drop {' '.join(DROP)}"
                   f"{wrong or ''}")


def units(folder):
    """Every unit has its dimension, so an importer can check it."""
    for name in folder:
        d = Described(folder[name]).description
        bare = [u.name for u in d.unitDefinitions if u.baseUnit is None]
        say(d.unitDefinitions and not bare,
            f"{name}: {len(d.unitDefinitions)} units with base units{bare or ''}")


def refused(call):
    try:
        call()
    except Exception:
        return True
    return False


def refusals(folder):
    c = ByFmpy(folder["ExhandController"])
    say(refused(lambda: c.put("k", 1e9)) and refused(lambda: c.put("f_des", 1.0)),
        "a value out of range, and an output that is set, are refused")
    c.start()
    say(refused(lambda: c.put("period_den", 1000)), "a fixed parameter is refused once it runs")
    say(refused(lambda: c.step(0, 0.0003)), "a step that is no period is refused")
    data = c.state()
    say(refused(lambda: c.restore(bytes([255]) * len(data))) and refused(lambda: c.step(0, 0.0005)),
        "a state that is none is refused, then steps too")
    c.restore(data)
    say(not refused(lambda: c.step(0, 0.0005)), "a state that is one brings it back")
    say(refused(lambda: c.fmu.setFloat32([1], [1.0])), "a variable of another type is refused")
    c.end()


def main(fmus, native_program, exhand, falls, *rates):
    folder, fmus = {}, pathlib.Path(fmus).resolve()
    for name in ("ExhandController", "ExhandDevice"):
        fmu = fmus / f"{name}.fmu"
        problems = validate_fmu(str(fmu))
        say(not problems, f"FMPy {fmpy.__version__}: validate {name}: {len(problems)} problems" +
            "".join(f"\n    {p}" for p in problems))
        folder[name] = fmus / name
        shutil.rmtree(folder[name], ignore_errors=True)
        with zipfile.ZipFile(fmu) as archive:
            archive.extractall(folder[name])
        build = fmus / f"{name}-cmake"
        shutil.rmtree(build, ignore_errors=True)
        build.mkdir()
        out = os.dup(1)
        with open(build / "said", "w") as said:
            os.dup2(said.fileno(), 1)
            try:
                build_platform_binary(folder[name], build_dir=build)
            finally:
                os.dup2(out, 1)
        say((folder[name] / "binaries" / fmpy.platform_tuple).is_dir(),
            f"FMPy compiled {name} from its sources")
        result = fmpy.simulate_fmu(str(folder[name]), stop_time=1.0, step_size=0.0005,
                                   output_interval=0.0005)
        say(len(result) == 2001, f"FMPy simulated {name} for 1 s: {len(result)} rows of "
                                 f"{len(result.dtype.names)} variables")
    units(folder)
    defaults_of_drop(folder, Native(native_program, 2000, 1))
    by_default(folder, exhand)
    for rate in rates:
        native = Native(native_program, int(rate), int(falls))
        say(len(native.tick) > int(rate) and any(t["c"] for t in native.tick),
            f"native at {rate} Hz: {len(native.tick)} ticks")
        say(alone_controller(ByFmpy, folder, native),
            f"controller at {rate} Hz: the native outputs, bit for bit; its state goes out and in")
        say(alone_device(ByFmpy, folder, native),
            f"device at {rate} Hz: the native codes, bit for bit")
        say(moved(folder, native, "ExhandController", native.inputs, native.outputs, True),
            f"controller at {rate} Hz: its state in another instance: the native outputs, bit for "
            f"bit")
        say(moved(folder, native, "ExhandDevice", INTO_DEVICE, native.inputs[:4], False),
            f"device at {rate} Hz: its state in another instance: the native codes, bit for bit")
        say(simulated(folder, native, "ExhandController", native.inputs, native.outputs,
                      native.param, 1),
            f"controller at {rate} Hz by simulate_fmu: the native outputs, bit for bit")
        say(simulated(folder, native, "ExhandDevice", ["dac_raw", "enable", "state"],
                      native.inputs[:4], {"falls": native.falls}, 0),
            f"device at {rate} Hz by simulate_fmu: the native codes, bit for bit")
        for importer in (ByFmpy, ByFmuloader):
            say(together(importer, folder, native),
                f"both at {rate} Hz in {importer.name}: the native run, bit for bit")
    refusals(folder)
    if ecospy:
        ours = parallel(folder, 5000)
        say(ours == parallel_ecos(folder, 5000) and max(r[4] for r in ours) > 1,
            "both in parallel: ecos gives FMPy's 5000 steps, bit for bit")
    else:
        print("  ecos, a third importer: not to be had here")
    print(f"fmi: {failed} failed" if failed else "fmi: all ok")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
