// SPDX-License-Identifier: MIT
// Run: a machine in v86 whose port accesses to the cards are answered by the emulator, compiled
// to WebAssembly. Usage: node run.mjs DIR GOLDEN [--update]; DIR holds what
// strangers.sh put there, GOLDEN the register traffic that is compared.

import fs from "node:fs";
import path from "node:path";
import { performance } from "node:perf_hooks";
import { pathToFileURL } from "node:url";

import { archive } from "./cpio.mjs";
import { Trace } from "./trace.mjs";
import { withOtherMask } from "./mask.mjs";

const dir = path.resolve(process.argv[2]);
const golden = process.argv[3];
const update = process.argv.includes("--update");
const limit_ms = 1000 * (Number(process.env.LIMIT_S) || 1800);
const file = (...name) => fs.readFileSync(path.join(dir, ...name));

const CARDS = [[0x280, 0x80, 2], [0x300, 0x10, 1]]; // from, ports, bytes of an access
const PIN = 0xe000, MARK = 0xe008, POWER = 0xe00c, FILE = 0xe010, EXIT = 0xf4;

const { V86 } = await import(pathToFileURL(path.join(dir,
    "npm/node_modules/v86/build/libv86.mjs")));
const emu = (await WebAssembly.instantiate(file("box.wasm"), {})).instance.exports;
emu.box_open(0, 0);

const s526 = file("module", "s526.ko");
const { module: s526_mask, found: bug } = withOtherMask(s526);
const initrd = archive({
    "init": [0o100755, file("init")],
    "comedi.ko": [0o100644, file("module", "comedi.ko")],
    "comedi_8255.ko": [0o100644, file("module", "comedi_8255.ko")],
    "s526.ko": [0o100644, s526],
    "dmm32at.ko": [0o100644, file("module", "dmm32at.ko")],
    "s526-mask.ko": [0o100644, s526_mask],
    "exhand": [0o100755, file("exhand")],
    "proc": [0o040755, Buffer.alloc(0)],
    "dev": [0o040755, Buffer.alloc(0)],
});

const buffer = (b) => ({ buffer: b.buffer.slice(b.byteOffset, b.byteOffset + b.byteLength) });
const bios = (name) => buffer(file("root/usr/share/seabios", name));
const machine = new V86({
    wasm_path: path.join(dir, "npm/node_modules/v86/build/v86.wasm"),
    bios: bios("bios-256k.bin"),
    vga_bios: bios("vgabios-stdvga.bin"),
    bzimage: buffer(file("vmlinuz")),
    initrd: buffer(initrd),
    cmdline: "console=ttyS0 quiet panic=-1 nokaslr mitigations=off random.trust_cpu=on " +
        `mask=${bug ? 9 : 0}`,
    memory_size: 96 * 1024 * 1024,
    vga_memory_size: 2 * 1024 * 1024,
    autostart: false,
    disable_keyboard: true,
    disable_mouse: true,
    disable_speaker: true,
});

// The cards' time is the machine's, which is the host's; but where the host was busy with others,
// the cards do not run ahead of the machine: no more than 10 ms pass in one step.
let then = performance.now();
function advance() {
    const now = performance.now();
    emu.box_advance_ns(Math.min(now - then, 10) * 1e6);
    then = now;
}

// The interrupt line of the MM-32X-AT, on an ISA bus: an edge.
const IRQ = 5;
let up = 0;
function interrupt() {
    const level = emu.box_interrupt();
    if (level !== up) {
        up = level;
        if (up) { machine.v86.cpu.device_raise_irq(IRQ); } else {
            machine.v86.cpu.device_lower_irq(IRQ); }
    }
}

const trace = new Trace();

function answer(io, port) {
    const read = (width) => () => {
        advance();
        const v = emu.box_in(port, width) >>> 0;
        interrupt();
        trace.add("r", width, port, v);
        return v;
    };
    const write = (width) => (v) => {
        advance();
        emu.box_out(port, width, v);
        interrupt();
        trace.add("w", width, port, v);
    };
    io.register_read(port, null, read(1), read(2), () => 0xffffffff);
    io.register_write(port, null, write(1), write(2), () => {});
}

// Logs that leave the machine: number n is compared with DIR/plain/n.exh.
const log = { n: 0, bytes: [], same: 0 };
function mark_file(n) {
    if (n) {
        log.n = n;
        log.bytes = [];
    } else {
        const got = Buffer.from(log.bytes);
        fs.writeFileSync(path.join(dir, `linux-${log.n}.exh`), got);
        log.same = got.equals(file("plain", `${log.n}.exh`)) ? 1 : 0;
    }
}

function connect(io) {
    let pin = 0;
    const none = () => {};
    for (const [from, ports] of CARDS) {
        for (let port = from; port < from + ports; port++) { answer(io, port); }
    }
    io.register_write(PIN, null, none, none, (v) => { pin = v; });
    io.register_write(PIN + 4, null, none, none, (v) => emu.box_set_pin(pin, v));
    io.register_read(PIN + 4, null, none, none, () => emu.box_pin(pin));
    io.register_write(MARK, null, none, none, (v) => trace.mark(v));
    io.register_write(POWER, null, none, none, (v) => emu.box_open(v & 0xff, v >> 8));
    io.register_write(FILE, null, none, none, mark_file);
    io.register_write(FILE + 4, null, (v) => log.bytes.push(v), none, none);
    io.register_read(FILE, null, none, none, () => log.same);
    io.register_write(EXIT, null, none, none, end);
}

function end(status) {
    machine.stop();
    const same = trace.compare(golden, update);
    const s = ((performance.now() - started) / 1000).toFixed(1);
    console.log(`${trace.total} port accesses of the kernel to the cards; ${s} s`);
    process.exit(status === 0 && same ? 0 : 1);
}

let line = "";
machine.add_listener("serial0-output-byte", (byte) => {
    const c = String.fromCharCode(byte);
    if (c === "\n") {
        console.log(line);
        if (/Kernel panic|FAILED:/.test(line)) { end(1); }
        line = "";
    } else if (c !== "\r") {
        line += c;
    }
});

const started = performance.now();
machine.add_listener("emulator-ready", () => {
    connect(machine.v86.cpu.io);
    machine.run();
    setInterval(() => { advance(); interrupt(); }, 1);
});
setTimeout(() => {
    console.log(`no end after ${limit_ms / 1000} s; last line: ${line}`);
    process.exit(1);
}, limit_ms);
