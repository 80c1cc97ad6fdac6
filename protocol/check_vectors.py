#!/usr/bin/env python3
"""Decodes every packet in vectors/ as WIRE.md says, and compares it with the head of its file (vectors/README.md).

It shares no code with the Rust crate or the Verilog, so it is also the shortest complete reader of the wire.
Run it without arguments. It exits 0 when everything agrees, else 1 after naming each file and field that does not.
"""
import re
import struct
import sys
import zlib
from itertools import zip_longest
from pathlib import Path

# Fields with their struct letters: B is u8, H u16, I u32, Q u64. A word without a letter is read by its TAILS function.
HEADER = "version:B kind:B sequence:H length:H flags:B session:B window:I"
SPAN = "table:B bank:B port:B first:H count:H "
PLACE = "row_sequence:I frame:H row:H width:H flags:B generation:B "
FROM_HOST = {
    0x00: "nonce:I host:I version_min:B version_max:B take_over:B",
    0x01: "", 0x02: "clear:B", 0x03: "level:B next_row:I", 0x04: "bytes",
    0x10: SPAN + "entries", 0x11: SPAN, 0x12: SPAN,
    0x13: "steps_crc:I kernel_crc:I first_frame:H generation:B shape",
    0x18: "width:H height:H centre2:H blanking:H gap_seed:I bits:B",
    0x20: PLACE + "samples", 0x22: "",
    0x30: "burst:I frames:I seed:I first_frame:H frame_blanking:H mode:B",
    0x31: "from:I", 0x32: "first:H count:H signatures", 0x33: "",
}
FROM_BOARD = {
    0x00: "nonce:I magic:4s version:B session:B build:I serial:Q",
    0x01: "capabilities",
    0x02: "packets:I crc_errors:I framing_errors:I foreign_packets:I refusals:I rows_in:I rows_out:I rows_repeated:I"
    " rows_unneeded:I samples_over:I next_row_in:I next_row_out:I core_busy:I generation:I least_latency:I"
    " most_latency:I",
    0x03: "", 0x04: "bytes",
    0x10: "", 0x11: SPAN + "entries", 0x12: "crc:I", 0x13: "generation:B", 0x18: "",
    0x21: PLACE + "first_latency:H last_latency:H pauses:H repeats:H samples entered",
    0x30: "", 0x31: "burst:I from:I state:B count:B records", 0x32: "", 0x33: "kept:B trapped",
    0x7F: "code:B kind:B detail:H",
}
CAPABILITIES = dict(enumerate((
    "datapath max_width max_height depths taps latency ring least_blanking table_banks row_banks_in row_banks_out"
    " step_ports kernel_ports clock_source clock_hz").split(), 1)) | {0x11: "entered", 0x20: "nature", 0x21: "name"}
BURSTS = "content:H records:H least_frame_blanking:H trap:B"  # of capability 10
GRIDS = "further_datapath:H entries:H ks:B grid_blanking:B grid_width:H"  # of capability 12
SHAPE = "v:B k:B"
TABLES = {0: "I", 1: "hhhhh", 3: "I"}  # the words of an entry
RECORD = "signature:I samples:I rows:H least_latency:H most_latency:H pauses:H generation:B flags:B"
TRAPPED = "frame:I row:H width:H signature:I samples"
MEANINGS = {"level": range(3), "table": TABLES, "bank": range(2), "mode": range(4),
            "state": range(3), "kept": range(2)}  # the values that have a meaning
# The part of a value that has a meaning.
LOOKED_AT = {"flags": lambda value: value & 1, "take_over": bool, "clear": bool, "trap": bool}


def unstuff(piece):
    """Undoes COBS; None when a code byte points past the end."""
    packet, at = bytearray(), 0
    while at < len(piece):
        code = piece[at]
        if at + code > len(piece):
            return None
        packet += piece[at + 1 : at + code]
        at += code
        if code < 0xFF and at < len(piece):
            packet.append(0)
    return bytes(packet)


def samples(data, fields):
    """Two samples are 24 bits, the first in the low twelve."""
    (packed,) = struct.unpack_from(f"{3 * fields['width'] // 2}s", data)
    pairs = [int.from_bytes(packed[at : at + 3], "little") for at in range(0, len(packed), 3)]
    return " ".join(f"{pair & 0xFFF} {pair >> 12}" for pair in pairs)


def entries(data, fields):
    """Row factors and grid entries are u32; a node is five i16."""
    return " ".join(map(str, struct.unpack_from("<" + TABLES[fields["table"]] * fields["count"], data)))


def shape(data, fields):
    """The shape of a bank that holds a grid: both numbers, or neither."""
    if len(data) >= 2:
        fields |= read_fields(SHAPE, data)


def capabilities(data, fields):
    """Every known tag becomes a field of its own."""
    while data:
        tag, value, data = data[0], data[2 : 2 + data[1]], data[2 + data[1] :]
        if tag == 0x11:
            value = b"\1" if any(value[:1]) else b""
        if tag in CAPABILITIES and (value or tag != 0x11):
            fields[CAPABILITIES[tag]] = value.decode() if tag == 0x21 else int.from_bytes(value, "little")
        elif tag == 0x10 and value:
            fields |= read_fields(BURSTS, value)
        elif tag == 0x12 and value:
            fields |= read_fields(GRIDS, value)


def entered(data, fields):
    """The word after the samples, which only boards with capability 11 send. `data` still begins with the samples."""
    tail = data[3 * fields["width"] // 2 :]
    return struct.unpack_from("<I", tail)[0] if len(tail) >= 4 else None


def records(data, fields):
    """The numbers of all records, one record after the other."""
    size = struct.calcsize("<" + "".join(word[-1] for word in RECORD.split()))
    found = [read_fields(RECORD, data[at : at + size]) for at in range(0, size * fields["count"], size)]
    return " ".join(str(value) for record in found for value in record.values())


def signatures(data, fields):
    """One 32-bit signature per row."""
    return " ".join(map(str, struct.unpack_from(f"<{fields['count']}I", data)))


def trapped(data, fields):
    """The row that was kept, if one was."""
    if fields["kept"]:
        fields |= read_fields(TRAPPED, data)


TAILS = {"samples": samples, "entries": entries, "capabilities": capabilities, "bytes": lambda data, _: data.hex(" "),
         "entered": entered, "records": records, "signatures": signatures, "trapped": trapped, "shape": shape}


def read_fields(layout, data):
    """The fields that the layout names, as a dictionary; bytes after them are skipped."""
    fields = {}
    for name, _, letter in (word.partition(":") for word in layout.split()):
        if letter:
            (value,) = struct.unpack_from("<" + letter, data)
            data = data[struct.calcsize("<" + letter) :]
            if value not in MEANINGS.get(name, (value,)):
                raise ValueError(f"{name} {value} has no meaning")
            fields[name] = value.hex(" ") if letter == "4s" else int(LOOKED_AT.get(name, int)(value))
        elif (value := TAILS[name](data, fields)) is not None:
            fields[name] = value
    return fields


def receive(piece, layouts):
    """What is between two zeros: a packet's fields, or the first check of section 1, in its order, that it fails."""
    packet = unstuff(piece)
    if packet is None:
        return {"damage": "stuffing"}
    if not 16 <= len(packet) <= 4096:
        return {"damage": "size"}
    header = read_fields(HEADER, packet)
    if zlib.crc32(packet[:-4]) != int.from_bytes(packet[-4:], "little"):
        return {"damage": "crc"}
    if header.pop("version") != 1:
        return {"damage": "version"}
    if header["length"] != len(packet) - 16:
        return {"damage": "length"}
    header["reply"] = header.pop("flags")
    if header["kind"] not in layouts:
        return header | {"refused": "kind"}
    try:
        fields = read_fields(layouts[header["kind"]], packet[12:-4])
    except (struct.error, ValueError):
        return header | {"refused": "payload"}
    return header | {"payload." + name: value for name, value in fields.items()}


def read_head(text):
    """The direction, and what is expected: a dictionary of texts for every packet or damage, in order."""
    direction, events = None, []
    for key, value in re.findall(r"^// ([a-z0-9_.]+) =(?: (.*))?$", text, re.M):
        if key in ("kind", "damage"):
            events.append({})
        if key == "direction":
            direction = value
        elif key != "canonical":
            value = re.sub(r"\b0x[0-9a-f]+", lambda number: str(int(number[0], 16)), value)
            events[-1][key] = f"{events[-1][key]} {value}" if key in events[-1] else value
    return direction, events


def complaints(path):
    """A line for every field of the file in which head and bytes disagree."""
    text = path.read_text(encoding="utf-8")
    direction, expected = read_head(text)
    pieces = bytes.fromhex(re.sub("//.*", "", text)).split(b"\0")[:-1]
    found = [receive(piece, {"host": FROM_HOST, "board": FROM_BOARD}[direction]) for piece in pieces if piece]
    for place, (want, have) in enumerate(zip_longest(expected, found, fillvalue={})):
        for key in want | have:
            if (right := want.get(key, "nothing")) != (value := str(have.get(key, "nothing"))):
                yield f"{path.name}: packet {place}: {key}: expected {right}, found {value}"


if __name__ == "__main__":
    files = sorted((Path(__file__).parent / "vectors").glob("*.hex"))
    faults = [fault for file in files for fault in complaints(file)]
    print(*faults, f"{len(files)} files, {len(faults)} faults", sep="\n")
    sys.exit(1 if faults or not files else 0)
