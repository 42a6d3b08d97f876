// SPDX-License-Identifier: MIT
// Trace: the port accesses of marked sequences, as text of a C table
// (test/device/emu/linux_trace.inc).

import fs from "node:fs";

const NAMES = ["", "s526 attach", "dmm32at attach", "counter 1 configured, x4", "counter 1 read",
    "A/D 0, 0 again, 1, 3 read", "D/A 2 written", "lines 4..7 outputs, written, read",
    "A/D 5 at +-10 V, 21 at +-5 V read", "D/A 3 written", "8255 port A output, written",
    "one scan of 22 channels, by command", "two scans of 22 channels, by the card's timer"];

const hex = (n, digits) => "0x" + n.toString(16).toUpperCase().padStart(digits, "0");

export class Trace {
    constructor() {
        this.total = 0;
        this.now = 0;
        this.of = NAMES.map(() => []);
    }

    mark(n) { this.now = n; }

    // Of a register that is read again and again the last reading stays: how many it took is time.
    add(kind, width, port, value) {
        this.total++;
        if (!this.now) { return; }
        const list = this.of[this.now], last = list[list.length - 1];
        if (last && kind === "r" && last.kind === "r" && last.port === port) {
            last.value = value;
        } else {
            list.push({ kind, width, port, value });
        }
    }

    text() {
        let s = "/* Port accesses of Debian's drivers s526 and dmm32at, as they were seen by\n" +
            " * test/device/strangers, which writes this file (--update) and compares with it.\n" +
            " * Of readings in a row of one port, the last. */\n";
        for (let n = 1; n < NAMES.length; n++) {
            s += `\n/* ${n}: ${NAMES[n]} */\n`;
            this.of[n].forEach((a, i, all) => {
                s += `{${n}, '${a.kind}', ${a.width}, ` +
                    `${hex(a.port, 3)}, ${hex(a.value, 2 * a.width)}},`;
                s += i % 3 === 2 || i + 1 === all.length ? "\n" : " "; // three in a line
            });
        }
        return s;
    }

    // true: as the golden file has it.
    compare(golden, update) {
        const text = this.text();
        if (update) { fs.writeFileSync(golden, text); }
        const want = fs.existsSync(golden) ? fs.readFileSync(golden, "utf8") : "";
        const a = want.split("\n"), b = text.split("\n");
        const accesses = text.split("{").length - 1;
        let differ = 0;
        for (let i = 0; i < Math.max(a.length, b.length); i++) {
            if (a[i] !== b[i] && differ++ < 10) {
                console.log(`  golden ${a[i]}\n  seen   ${b[i]}`); }
        }
        console.log(`register traffic: ${accesses} accesses in ${NAMES.length - 1} sequences, ` +
            `${differ} lines differ from ${golden}`);
        return differ === 0;
    }
}
