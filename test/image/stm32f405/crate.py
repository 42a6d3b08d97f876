#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Facts of registers out of two crates that are generated from the vendors' descriptions.

crate.py extract DIR REGS >crate.tsv: DIR holds the sources of `stm32f4` and `cortex-m`, as
`cargo vendor` leaves them. One row a register: peripheral, base, register, offset, reset, rights,
its fields as name:lowest bit:width. Names are the crates'. Only what the header REGS names.
crate.py check TSV REGS: whatever REGS says of a register is what TSV says. Exit status 1: it is
not.
crate.py planted TSV REGS: the check detects each number of REGS that is changed by one bit.
"""
import pathlib
import re
import sys

CORE = {"SYST": "syst", "NVIC": "nvic", "SCB": "scb", "MPU": "mpu", "DWT": "dwt", "DCB": "dcb"}


def version(crate):
    text = (crate / "Cargo.toml").read_text()
    return re.search(r'^version = "(.*)"', text, re.M).group(1)


def fields(text):
    """Bits of a register: the union of what its reader and its writer name."""
    found = {}
    part = r"///Bits? (\d+)(?::(\d+))? - [^\n]*\n(?:\s*///[^\n]*\n)*\s*(?:#\[[^\n]*\n\s*)*"
    for m in re.finditer(part + r"pub (?:const )?fn (\w+)\(", text):
        low, high = int(m[1]), int(m[2] or m[1])
        found[m[3].upper()] = (low, high - low + 1)
    return ",".join(f"{n}:{lo}:{w}" for n, (lo, w) in sorted(found.items(), key=lambda f: f[1]))


def rights(text):
    return ("r" if "crate::Readable for" in text else "") + (
        "w" if "crate::Writable for" in text else "")


def registers(folder, name, text):
    """(register, offset, file of it) of one block; clusters of DMA streams among them."""
    shared = {reg: block for block, reg in re.findall(
        r"pub use crate::stm32f405::(\w+)::([a-z]\w*);", text)}
    one = (r"///(0x[0-9a-f]+)(\.\.0x[0-9a-f]+)? - [^\n]*\n(?:\s*///[^\n]*\n)*"
           r"\s*#\[inline\(always\)\]\n")
    for m in re.finditer(one + r"\s*pub const fn (\w+)\(&self(?:, n: usize)?\) -> &(\w+)", text):
        first, many, reg, kind = int(m[1], 16), m[2], m[3], m[4]
        file = folder / shared.get(kind.lower(), name) / f"{kind.lower()}.rs"
        if kind == "ST" and many:
            inner = (folder / name / "st.rs").read_text()
            for n in range(8):
                for r, off, f in registers(folder / name, "st", inner):
                    yield f"S{n}{r}", first + 0x18 * n + off, f
        elif not many and kind != "ST" and file.exists():
            yield reg.upper(), first, file


def device(crate, wanted):
    folder = crate / "src" / "stm32f405"
    line = r"pub type (\w+) = crate::Periph<(\w+)::RegisterBlock, (0x[0-9a-f_]+)>"
    for name, block, base in re.findall(line, (folder / "mod.rs").read_text()):
        if name not in wanted:
            continue
        text = (folder / f"{block}.rs").read_text()
        for reg, off, file in registers(folder, block, text):
            body = file.read_text()
            reset = re.search(r"const RESET_VALUE: u\d+ = (0x[0-9a-f_]+)", body)
            yield (name, int(base.replace("_", ""), 16), reg, off,
                   int(reset[1].replace("_", ""), 16) if reset else 0, rights(body), fields(body))


def core(crate):
    """Offsets follow from the order of the block's words, which is all that this crate says."""
    folder = crate / "src" / "peripheral"
    pointer = r"impl (\w+) \{\n\s*/// Pointer[^\n]*\n\s*pub const PTR: [^=]*= (0x[0-9A-F_]+)"
    bases = dict(re.findall(pointer, (folder / "mod.rs").read_text()))
    for name, file in CORE.items():
        text = re.sub(r"\s*///[^\n]*", "", (folder / f"{file}.rs").read_text())
        text = re.sub(r"#\[cfg\((armv6m|armv8m)\)\]\n[^\n]*\n", "", text)
        block = re.search(r"pub struct RegisterBlock \{(.*?)\n\}", text, re.S)[1]
        off = 0
        for reg, kind in re.findall(r"^\s*(?:pub )?(\w+): (.*),$", block, re.M):
            size = 1 if "u8" in kind else 2 if "u16" in kind else 4
            many = re.search(r"; ([0-9a-fx]+|NVIC::BITMAP_WORDS)\]", kind)
            many = 1 if not many else 16 if "::" in many[1] else int(many[1], 0)
            right = {"RO": "r", "WO": "w", "RW": "rw"}.get(re.sub(r"^\[?(\w+).*", r"\1", kind))
            if right and not reg.startswith("_"):
                yield name, int(bases[name].replace("_", ""), 16), reg.upper(), off, 0, right, ""
            off += size * many


def interrupts(crate):
    text = (crate / "src" / "stm32f405" / "mod.rs").read_text()
    body = re.search(r"pub enum Interrupt \{(.*?)\n\}", text, re.S)[1]
    for name, n in re.findall(r"(\w+) = (\d+),", body):
        yield "IRQ", int(n), name, 0, 0, "", ""


# --- the header ---

KIND = {"TIM": r"TIM\d+", "GPIO": r"GPIO\w", "USART": r"US?ART\d", "SPI": r"SPI\d", "ADC": r"ADC\d",
        "DMA": r"DMA\d"}
# A name of the header for several fields, or that the crates write otherwise.
SAME = {"TIM_CCMR1": "CCMR1_INPUT"}
FIELD_SAME = {"IWDGRSTF": "WDGRSTF"}
# Not in the crates: keys of the flash and the watchdog, and the D/A, which is no part of the chip.
APART = r"FLASH_KEY\d|FLASH_SECTOR_\d+|IWDG_KEY_\w+|DA_\w+|SCB_AIRCR_\w+|SCB_CPACR_FPU"
FIELD = r"FIELD\((\d+), (\d+)\)"


def header(text):
    """name -> a number, or (lowest bit, width)."""
    said = {}
    for name, value in re.findall(r"^#define (\w+)(?:\(\w+\))? +([^/\n]+)", text, re.M):
        value = value.strip()
        bits = re.fullmatch(FIELD, value)
        number = re.match(r"\(?(0x[0-9A-Fa-f]+|\d+)u?\b", value)
        if bits:
            said[name] = (int(bits[1]), int(bits[2]))
        elif number:
            said[name] = int(number[1], 0)
    return said


def of(name, peripherals):
    """Peripherals of a name of the header, and the rest of the name."""
    if name.startswith("ADC_COMMON_"):
        return ["ADC_COMMON"], name[len("ADC_COMMON_"):]
    first, _, rest = name.partition("_")
    if re.fullmatch(r"GPIO\w", first):
        return [first], rest
    return [p for p in peripherals if re.fullmatch(KIND.get(first, first), p)], rest


def wanted_of(said):
    return {n[5:] for n in said if n.startswith("BASE_")}


def judge(name, value, facts, bases, said):
    """What is wrong with one name, or None; "" if no fact is about it."""
    if name.startswith("BASE_"):
        there = bases.get(name[5:])
        return None if name == "BASE_SCS" or there == value else f"base 0x{there or 0:08x}"
    if name.startswith("IRQ_"):
        return None if facts.get(("IRQ", name[4:])) == value else "another interrupt"
    reset = name.startswith("RESET_")
    plain = name[6:] if reset else name
    where, rest = of(plain, bases)
    if plain.startswith(("DMA_S", "DMA_FLAG")) and not re.match("DMA_STREAM", plain):
        return judge_stream(plain, value, facts, reset)
    if plain == "DMA_STREAM":
        ok = all(facts[(p, f"S{n}CR")][1] == value + 0x18 * n for p in where for n in range(8))
        return None if ok else "a stream stands elsewhere"
    reg = max((r for p, r in facts if p in where and (rest == r or rest.startswith(r + "_"))),
              key=len, default=None)
    reg = SAME.get(plain, reg)
    field = rest[len(reg) + 1:] if reg and rest.startswith(reg) else ""
    if plain.startswith("TIM_CCMR1_"):
        reg, field = "CCMR1_INPUT", plain[len("TIM_CCMR1_"):]
    if plain == "SCB_SHPR3":
        at = bases["SCB"] + facts[("SCB", "SHPR")][1] + 8
        return None if at == 0xE000E000 + value else "not there"
    rows = [(p, facts[(p, reg)]) for p in where if (p, reg) in facts]
    if not rows or len(rows) != len(where):
        return ""
    for p, (base, off, at_reset, _, bits) in rows:
        if reset and at_reset != value:
            return f"{p}: 0x{at_reset:08x} after a reset"
        if not reset and not field and (off if p not in CORE else base + off - 0xE000E000) != value:
            return f"{p}: at 0x{off:02x}"
        if field and bits.get(FIELD_SAME.get(field, field)) != value:
            return f"{p}: bits {bits.get(field)}"
    return None


def judge_stream(name, value, facts, reset):
    """Of the eight streams of both controllers, whose registers are S0CR ... of the crate."""
    if name.startswith("DMA_FLAG"):
        low = facts[("DMA2", "LISR")][4]
        kinds = [name[9:] + "IF0"] if name != "DMA_FLAGS" else [
            "FEIF0", "DMEIF0", "TEIF0", "HTIF0", "TCIF0"]
        return None if value == sum(1 << low[k][0] for k in kinds) else "other flags"
    reg, _, field = name[5:].partition("_")
    for p in ("DMA1", "DMA2"):
        for n in range(8):
            _, off, at_reset, _, bits = facts[(p, f"S{n}{reg}")]
            is_so = (at_reset if reset else bits.get(field) if field
                     else off - facts[(p, f"S{n}CR")][1]) == value
            if not is_so:
                return f"{p} stream {n}"
    return None


def read_facts(path):
    facts, bases = {}, {}
    for line in pathlib.Path(path).read_text().splitlines():
        if line.startswith("#"):
            continue
        p, base, reg, off, reset, right, bits = line.split("\t")
        if p == "IRQ":
            facts[(p, reg)] = int(base, 0)
            continue
        cut = [b.split(":") for b in bits.split(",") if b]
        facts[(p, reg)] = (int(base, 0), int(off, 0), int(reset, 0), right,
                           {n: (int(lo), int(w)) for n, lo, w in cut})
        bases[p] = int(base, 0)
    return facts, bases


def check(said, facts, bases):
    wrong, held, apart = [], [], []
    for name, value in said.items():
        what = "" if re.fullmatch(APART, name) else judge(name, value, facts, bases, said)
        kind = held if what is None else wrong if what or not re.fullmatch(APART, name) else apart
        kind.append((name, what))
    return wrong, held, apart


def planted(said, facts, bases):
    """Each number with its lowest and a higher bit changed, and each field moved and widened."""
    done, missed = 0, []
    _, held, _ = check(said, facts, bases)
    for name, _ in held:
        value = said[name]
        if name == "BASE_SCS":
            continue
        others = [(value[0] + 1, value[1]), (value[0], value[1] + 1)] if isinstance(
            value, tuple) else [value ^ 1, value ^ 4, value ^ 16]
        for other in others:
            done += 1
            if judge(name, other, facts, bases, said) is None:
                missed.append((name, other))
    return done, missed


def extract(where, regs):
    chip, cpu = where / "stm32f4", where / "cortex-m"
    said = header(regs)
    print("# SPDX-License-Identifier: MIT")
    print(f"# Facts out of the crates stm32f4 {version(chip)} and cortex-m {version(cpu)}, "
          "by crate.py. Not to be edited.")
    print("# peripheral\tbase\tregister\toffset\treset\trights\tfields")
    rows = list(device(chip, wanted_of(said)))
    names = {of(n, {r[0] for r in rows})[1] for n in said}
    names |= {of(n[6:], {r[0] for r in rows})[1] for n in said if n.startswith("RESET_")}
    for p, base, reg, off, reset, right, bits in rows + list(core(cpu)):
        stream = re.fullmatch(r"S\d(\w+)", reg)
        if reg in names or reg == "CCMR1_INPUT" or p in CORE or stream and "S" + stream[1] in names:
            print(f"{p}\t0x{base:08x}\t{reg}\t0x{off:02x}\t0x{reset:08x}\t{right}\t{bits}")
    for p, n, name, *_ in interrupts(chip):
        if f"IRQ_{name}" in said:
            print(f"{p}\t{n}\t{name}\t0\t0\t\t")


def main():
    what, first, regs = sys.argv[1:4]
    text = pathlib.Path(regs).read_text()
    if what == "extract":
        return extract(pathlib.Path(first), text)
    facts, bases = read_facts(first)
    said = header(text)
    if what == "planted":
        done, missed = planted(said, facts, bases)
        print(f"{done} numbers changed, {done - len(missed)} told")
        for name, value in missed:
            print(f"  not told: {name} = {value}")
        return len(missed) > 0
    wrong, held, apart = check(said, facts, bases)
    print(f"{len(held)} of {len(said)} numbers of {regs} are those of {first}; "
          f"{len(apart)} are of what no crate describes; {len(wrong)} are not")
    for name, why in wrong:
        print(f"  {name}: {why or 'the crate has no such name'}")
    return len(wrong) > 0


if __name__ == "__main__":
    sys.exit(main())
