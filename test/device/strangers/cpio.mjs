// SPDX-License-Identifier: MIT
// Cpio: an archive in the "newc" format, as the kernel unpacks it into its first file system.

const hex = (n) => n.toString(16).toUpperCase().padStart(8, "0");
const padded = (b) => Buffer.concat([b, Buffer.alloc(-b.length & 3)]);

function entry(inode, name, mode, data) {
    const text = Buffer.from(name + "\0");
    const field = [inode, mode, 0, 0, 1, 0, data.length, 0, 0, 0, 0, text.length, 0];
    const head = Buffer.from("070701" + field.map(hex).join(""));
    return Buffer.concat([padded(Buffer.concat([head, text])), padded(data)]);
}

// files: {name: [mode, contents]}
export function archive(files) {
    const entries = Object.entries(files).map(([name, [mode, data]], i) => entry(i + 1, name, mode,
        data));
    return Buffer.concat([...entries, entry(0, "TRAILER!!!", 0, Buffer.alloc(0))]);
}
