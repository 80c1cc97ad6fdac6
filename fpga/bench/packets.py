#!/usr/bin/env python3
"""Writes the cases of the receiver's and the sender's bench: every frozen packet, then packets and damages drawn by a seed.

packets.py receiver|sender FILE [SEED]

All numbers are hexadecimal. A case of the receiver is its name, the counts of bytes and of events, the bytes, the events in
order. An event is `1` (a wrong CRC), `2` (broken framing), or `0` and a packet. A case of the sender is its name, a packet, the
count of stuffed bytes with both zeros, and the bytes. A packet is kind, sequence, length, flags, session, window, payload.
"""
import random
import struct
import sys
import zlib
from pathlib import Path

PROTOCOL = Path(__file__).parents[2] / "protocol"
sys.path.insert(0, str(PROTOCOL))
sys.dont_write_bytecode = True
from check_vectors import read_head, receive, unstuff  # noqa: E402

SIZES = (0, 1, 237, 238, 239, 491, 492, 493, 494, 4079, 4080)


def stuff(packet):
    """COBS; the loop ends without a further code when the last piece has 254 bytes."""
    out = b""
    while True:
        piece = packet[:254].split(b"\0")[0]
        out += bytes([len(piece) + 1]) + piece
        ends_in_zero = packet[len(piece) : len(piece) + 1] == b"\0" and len(piece) < 254
        packet = packet[len(piece) + ends_in_zero :]
        if not packet and not ends_in_zero:
            return out


def numbers(packet):
    """The fields and the payload of a decoded packet."""
    _, kind, sequence, length, flags, session, window = struct.unpack_from("<BBHHBBI", packet)
    return [kind, sequence, length, flags, session, window, *packet[12:-4]]


def event(piece):
    """The event for the bytes between two zeros, by a reader that shares nothing with the Verilog."""
    damage = receive(piece, {}).get("damage")
    return [1] if damage == "crc" else [2] if damage else [0, *numbers(unstuff(piece))]


def vectors():
    """Name, bytes, each packet's head, and whether a sender makes these bytes."""
    for path in sorted((PROTOCOL / "vectors").glob("*.hex")):
        text = path.read_text(encoding="utf-8")
        data = bytes.fromhex("".join(line for line in text.splitlines() if not line.startswith("//")))
        yield path.stem, data, read_head(text)[1], "// canonical = yes" in text


def judged_by_head(name, data, heads):
    """The events of a vector. A head that does not match the packet's own bytes ends the run."""
    pieces = [piece for piece in data.split(b"\0")[:-1] if piece]
    for piece, head in zip(pieces, heads, strict=True):
        found = event(piece)
        if "damage" in head:
            wanted = 1 if head["damage"] == "crc" else 2
        else:
            wanted = 0
            fields = [int(head[key], 0) for key in ("kind", "sequence", "length", "session", "window")]
            if fields != found[1:4] + found[5:7] or int(head["reply"]) != found[4] & 1:
                sys.exit(f"{name}: the head does not fit the bytes")
        if found[0] != wanted:
            sys.exit(f"{name}: the head does not fit the bytes")
        yield found


def draw_payload(draw, size):
    """Bytes without a zero, only zeros, any bytes, or few zeros."""
    sort, few = draw.randrange(4), draw.choice((4, 300))
    drawn = [(draw.randint(1, 255), draw.randrange(256), draw.randrange(few)) for _ in range(size)]
    return bytes((solid, 0, any_byte, solid if rare else 0)[sort] for solid, any_byte, rare in drawn)


def draw_packet(draw, size, version=1, excess=0):
    """A packet, which may have another version, or more bytes than its header says."""
    body = struct.pack("<BBHHBBI", version, draw.choice((4, 0x20, 0x21)), draw.getrandbits(16), size - excess,
                       draw.getrandbits(1), draw.getrandbits(8), draw.choice((0, draw.getrandbits(32))))
    body += draw_payload(draw, size)
    return body + struct.pack("<I", zlib.crc32(body))


def draw_damage(draw, packet):
    """The stuffed packet after damage that a link may do to it."""
    wire = bytearray(stuff(packet))
    at = draw.randrange(len(wire))
    return bytes(draw.choice((
        lambda: wire[:at], lambda: wire[at:], lambda: wire[:at] + wire[at + 1:], lambda: wire[:at] + b"\xff" + wire[at:],
        lambda: wire[:at] + bytes([wire[at] ^ 1 << draw.randrange(8)]) + wire[at + 1:], lambda: wire + wire, lambda: wire + b"\1",
        lambda: stuff(packet[:draw.randrange(18)]), lambda: bytes(draw.randint(1, 255) for _ in range(draw.randrange(40))),
    ))())


def draw_stream(draw):
    """Packets and damages with one or more zeros after each. The first has no zero before it."""
    size = draw.choice((draw.choice(SIZES), draw.randrange(300)))
    pieces = [draw.choice((
        lambda: stuff(draw_packet(draw, size)), lambda: stuff(draw_packet(draw, size)),
        lambda: draw_damage(draw, draw_packet(draw, size)),
        lambda: stuff(draw_packet(draw, 20, version=draw.choice((0, 2, 129)))),
        lambda: stuff(draw_packet(draw, 20, excess=draw.choice((-1, 1, -4096, -0x8000)))),
    ))() for _ in range(draw.randint(1, 4))]
    return b"".join(piece + bytes(draw.choice((1, 1, 2, 5))) for piece in pieces)


def receiver_cases(draw):
    """Name, bytes and events of each case."""
    for name, data, heads, _ in vectors():
        yield name, data, list(judged_by_head(name, data, heads))
    after = b"\0" + stuff(draw_packet(draw, 5)) + b"\0"
    streams = [("long_run", bytes([255]) * long + after) for long in (4112, 4113, 4114, 8192 + 12, 12300)]
    streams += [("long_zeros", bytes([1]) * long + after) for long in (16, 17, 4097, 4098, 8193 + 12, 12300)]
    streams += [("size", stuff(draw_packet(draw, size)) + after) for size in (*SIZES, 4081, 4085) for _ in range(3)]
    streams += [(f"drawn_{place}", draw_stream(draw)) for place in range(180)]
    for name, data in streams:
        yield name, data, [event(piece) for piece in data.split(b"\0")[:-1] if piece]


def sender_cases(draw):
    """Name, packet and bytes of each case."""
    for name, data, _, canonical in vectors():
        if canonical and numbers(unstuff(data[1:-1]))[3] < 2:
            yield name, numbers(unstuff(data[1:-1])), data
    for size in (*SIZES, *(draw.randrange(600) for _ in range(60))):
        packet = draw_packet(draw, size)
        yield f"size_{size}", numbers(packet), b"\0" + stuff(packet) + b"\0"


def main(side, path, seed="1"):
    """Writes one line per case."""
    draw = random.Random(int(seed))
    with open(path, "w", encoding="ascii") as out:
        for name, first, second in {"receiver": receiver_cases, "sender": sender_cases}[side](draw):
            if side == "receiver":
                values = [len(first), len(second), *first, *(number for found in second for number in found)]
            else:
                values = [*first, len(second), *second]
            print(name, *(f"{value:x}" for value in values), file=out)


if __name__ == "__main__":
    main(*sys.argv[1:])
