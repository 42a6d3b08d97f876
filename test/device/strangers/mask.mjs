// SPDX-License-Identifier: MIT
// Mask: the s526 module with another mask of A/D channels, by one byte.
//
// In s526_ai_insn_read the compiler has made of  (1 << (5 + (chan & 0x9))) | (chan & 0xf) << 1  :
//     83 e2 09   and $0x9,%edx        83 c2 05   add $5,%edx
//     83 e0 1e   and $0x1e,%eax       0f ab d0   bts %edx,%eax
// The mask must be 0xf for ten channels. Debian signs its modules: a changed one is rejected as
// long as the signature is at its end, and loaded, with the kernel's remark, without.

const BUG = Buffer.from([0x83, 0xe2, 0x09, 0x83, 0xe0, 0x1e, 0x83, 0xc2, 0x05, 0x0f, 0xab, 0xd0]);
const MAGIC = Buffer.from("~Module signature appended~\n");
const TRAILER_B = 12; // before the magic; its last word is the signature's length, big-endian

function withoutSignature(module) {
    const end = module.length - MAGIC.length;
    if (!module.subarray(end).equals(MAGIC)) { return module; }
    return module.subarray(0, end - TRAILER_B - module.readUInt32BE(end - 4));
}

// found: the bug is there, once. Otherwise the module comes back as it was.
export function withOtherMask(module) {
    const at = module.indexOf(BUG);
    if (at < 0 || module.indexOf(BUG, at + 1) >= 0) { return { module, found: false }; }
    const other = Buffer.from(withoutSignature(module));
    other[at + 2] = 0x0f;
    return { module: other, found: true };
}
