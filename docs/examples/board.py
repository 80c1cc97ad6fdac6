"""A board behind a TCP port, from WIRE.md and DATAPATH.md alone: datapath 1, one bank of tables, no
frames of its own. docs/board-in-python.md explains its parts in this order.
    python3 board.py PORT
"""

import contextlib
import math
import socket
import struct
import sys
import time
import zlib

MAX_WIDTH, MAX_HEIGHT = 256, 128
IN_BANKS, OUT_BANKS = 2, 2
LATENCY = 12  # L of DATAPATH.md, in pixel clocks
NODES = 65  # of a kernel

# Kinds of packets (WIRE.md, section 3).
HELLO, CAPABILITIES, STATUS, RESET, ECHO = range(5)
TABLE_WRITE, TABLE_READ, TABLE_CRC, COMMIT = range(0x10, 0x14)
CONFIGURE = 0x18
ROW_IN, ROW_OUT, ROW_ACK = range(0x20, 0x23)
REFUSAL = 0x7F

# Refusals (section 6). A board with all seven taps never needs the twelfth.
BAD_VERSION, BAD_KIND, BAD_PAYLOAD, BAD_RANGE, BAD_SESSION, HELD = range(1, 7)
BUSY, NOT_READY, BAD_TABLE_CRC, NO_CREDIT, BAD_ROW = range(7, 12)

# The counters of STATUS that are cleared, in the order of the page.
PACKETS, CRC_ERRORS, FRAMING_ERRORS, FOREIGN_PACKETS, REFUSALS = range(5)
ROWS_IN, ROWS_OUT, ROWS_REPEATED, ROWS_UNNEEDED, SAMPLES_OVER = range(5, 10)

HEADER = struct.Struct("<BBHHBBI")  # version, kind, sequence, length, flags, session, window
PLACE = struct.Struct("<IHHHBB")  # row_sequence, frame, row, width, flags, generation

FACTORS, KERNEL = 0, 1  # tables
ENTRY_BYTES = {FACTORS: 4, KERNEL: 10}
LARGEST_FACTOR = 2**24


class Refused(Exception):
    """A request is not carried out: the code, and its detail."""


def refuse_if(is_wrong, code, detail=0):
    if is_wrong:
        raise Refused(code, detail)


# --- Step 1: packets
def stuff(packet):
    """COBS: no zero is left. Each piece of at most 254 bytes follows its length + 1."""
    stuffed = b""
    rest = packet + b"\0"  # the zero that is imagined at the end
    while rest:
        length = min(rest.index(b"\0"), 254)
        stuffed += bytes([length + 1]) + rest[:length]
        rest = rest[length:]
        if length < 254 or rest == b"\0":
            rest = rest[1:]  # this zero is implied, or was only imagined
    return stuffed


def unstuff(run):
    """The packet in a run of bytes without zeros; None if its last piece is cut short."""
    packet = b""
    while run:
        code = run[0]
        piece, run = run[1:code], run[code:]
        if len(piece) < code - 1:
            return None
        packet += piece
        if code < 255 and run:
            packet += b"\0"
    return packet


def what_is_wrong(packet):
    """The counter for a packet that is dropped; PACKETS for one that arrived whole."""
    if packet is None or not 16 <= len(packet) <= 4096:
        return FRAMING_ERRORS
    if zlib.crc32(packet[:-4]) != int.from_bytes(packet[-4:], "little"):
        return CRC_ERRORS
    version, _, _, length, _, _, _ = HEADER.unpack_from(packet)
    if version != 1 or length != len(packet) - 16:
        return FRAMING_ERRORS
    return PACKETS


class Board:
    def __init__(self):
        self.session = 0
        self.holder = None  # the host's number and its nonce
        self.last_heard = 0
        self.rows_sent = 0  # ROW_OUT packets of this session
        self.to_host = b""
        self.clear_counters()
        self.reset(b"", 2, 0)

    def take(self, run):
        """Takes what came between two zeros."""
        packet = unstuff(run)
        counter = what_is_wrong(packet)
        self.counters[counter] += 1
        if counter == PACKETS:
            _, kind, sequence, _, _, session, window = HEADER.unpack_from(packet)
            self.answer(kind, sequence, session, window, packet[12:-4])

    def answer(self, kind, sequence, session, window, payload):
        try:
            reply = self.carry_out(kind, session, window, payload)
            if reply is not None:
                self.send(kind, sequence, 1, self.session if kind == HELLO else session, reply)
        except Refused as refused:
            code, detail = refused.args
            self.counters[FOREIGN_PACKETS] += code == BAD_SESSION
            if kind != ROW_ACK:
                self.counters[REFUSALS] += 1
                reply = struct.pack("<BBH", code, kind, detail)
                self.send(REFUSAL, sequence, 1, session, reply)
        self.play()

    def carry_out(self, kind, session, window, payload):
        """The payload of the reply, or None. Looks at session, kind and payload, in this order."""
        if kind != HELLO:
            refuse_if(self.holder is None or session != self.session, BAD_SESSION)
            self.last_heard = time.monotonic()
            self.acknowledge(window)
        refuse_if(kind not in REQUESTS, BAD_KIND)
        request, fields = REQUESTS[kind]
        refuse_if(len(payload) < struct.calcsize(fields), BAD_PAYLOAD)
        return request(self, payload, *struct.unpack_from(fields, payload))

    def send(self, kind, sequence, flags, session, payload):
        window = min(self.entered + IN_BANKS, 2**32 - 1)
        packet = HEADER.pack(1, kind, sequence, len(payload), flags, session, window) + payload
        packet += struct.pack("<I", zlib.crc32(packet))
        self.to_host += b"\0" + stuff(packet) + b"\0"

    # --- Step 2: HELLO, CAPABILITIES, STATUS, RESET and ECHO

    def hello(self, _payload, nonce, host, oldest, newest, take_over):
        refuse_if(not oldest <= 1 <= newest, BAD_VERSION, 1)
        seconds_left = self.last_heard + 10 - time.monotonic()
        is_held = self.holder is not None and self.holder[0] != host and seconds_left > 0
        refuse_if(is_held and not take_over, HELD, math.ceil(10 * seconds_left))
        self.last_heard = time.monotonic()
        if self.holder != (host, nonce):  # otherwise the reply to this very HELLO was lost
            self.holder = (host, nonce)
            self.session = self.session % 255 + 1
            self.rows_sent = 0
            self.clear_counters()
            self.reset(b"", 0, 0)
        return struct.pack("<I4sBBIQ", nonce, b"HRW1", 1, self.session, 0, 0)

    def capabilities(self, _payload):
        listed = [
            (0x01, "<H", 1),  # datapath
            (0x02, "<H", MAX_WIDTH),
            (0x03, "<H", MAX_HEIGHT),
            (0x04, "<B", 0b111),  # depths: 8, 10 and 12 bits
            (0x05, "<B", 7),  # taps
            (0x06, "<B", LATENCY),
            (0x07, "<H", 256),  # ring: samples in the line memory
            (0x08, "<H", 0),  # least_blanking
            (0x09, "<B", 1),  # table_banks
            (0x0A, "<B", IN_BANKS),
            (0x0B, "<B", OUT_BANKS),
            (0x0C, "<B", 1),  # step_ports
            (0x0D, "<B", 1),  # kernel_ports
            (0x0E, "<B", 0),  # clock_source: none of its own
            (0x0F, "<I", 0),  # clock_hz: not known
            (0x20, "<B", 3),  # nature: a mock
        ]
        values = [(tag, struct.pack(form, value)) for tag, form, value in listed]
        return b"".join(bytes([tag, len(value)]) + value for tag, value in values)

    def status(self, _payload, clear):
        next_row_in = self.entered
        while next_row_in in self.waiting:
            next_row_in += 1
        is_busy = self.left < self.entered
        counted = [*self.counters, next_row_in, self.taken, is_busy, self.generation]
        counted += [min(self.latencies, default=0), max(self.latencies, default=0)]
        if clear:
            self.clear_counters()
        return struct.pack("<16I", *counted)

    def clear_counters(self):
        self.counters = [0] * 10
        self.latencies = set()

    def reset(self, _payload, level, next_row):
        refuse_if(level > 2, BAD_PAYLOAD)
        self.drop_rows(next_row)
        if level == 1:
            self.holder = None
        if level == 2:
            self.configuration = None
            self.generation = 0
            factors = struct.pack("<I", LARGEST_FACTOR) * MAX_HEIGHT  # nothing is stretched
            weights = bytes(NODES * ENTRY_BYTES[KERNEL])
            self.tables = {FACTORS: bytearray(factors), KERNEL: bytearray(weights)}
        return b""

    # --- Step 3: CONFIGURE and tables

    def configure(self, _payload, width, height, centre2, _blanking, gap_seed, bits):
        refuse_if(self.waiting or self.played, BUSY)
        refuse_if(bits not in (8, 10, 12), BAD_RANGE, 5)
        refuse_if(not 64 <= width <= MAX_WIDTH or width % 2 == 1, BAD_RANGE, 0)
        refuse_if(not 1 <= height <= MAX_HEIGHT, BAD_RANGE, 1)
        refuse_if(centre2 > 2 * width - 2, BAD_RANGE, 2)
        self.configuration = width, height, centre2, gap_seed, bits
        return b""

    def table_write(self, payload, table, bank, _port, first, count):
        refuse_if(table not in self.tables or bank > 1, BAD_PAYLOAD)
        start, end = first * ENTRY_BYTES[table], (first + count) * ENTRY_BYTES[table]
        entries = payload[7 : 7 + end - start]
        refuse_if(len(entries) < end - start, BAD_PAYLOAD)
        refuse_if(bank == 1, BAD_RANGE, first)
        refuse_if(self.left < self.entered, BUSY)
        refuse_if(end > len(self.tables[table]), BAD_RANGE, first)
        if table == FACTORS:
            for index, (factor,) in enumerate(struct.iter_unpack("<I", entries), first):
                refuse_if(not 1 <= factor <= LARGEST_FACTOR, BAD_RANGE, index)
        self.tables[table][start:end] = entries
        return b""

    def table_read(self, payload, table, bank, port, first, count):
        entries = self.read(table, bank, port, first, count)
        refuse_if(len(payload[:7] + entries) > 4080, BAD_RANGE, first)  # more than a packet holds
        return payload[:7] + entries

    def table_crc(self, _payload, table, bank, port, first, count):
        return struct.pack("<I", zlib.crc32(self.read(table, bank, port, first, count)))

    def read(self, table, bank, port, first, count):
        refuse_if(table not in self.tables or bank > 1, BAD_PAYLOAD)
        refuse_if(self.left < self.entered, BUSY)
        start, end = first * ENTRY_BYTES[table], (first + count) * ENTRY_BYTES[table]
        refuse_if(port > 0 or end > len(self.tables[table]), BAD_RANGE, first)
        return bytes(self.tables[table][start:end])

    def commit(self, _payload, factors_crc, kernel_crc, _first_frame, generation):
        if generation == 0 or generation != self.generation:  # otherwise it has been done
            refuse_if(self.configuration is None, NOT_READY)
            refuse_if(generation == 0, BAD_RANGE)
            height = self.configuration[1]
            for table, count, crc in (FACTORS, height, factors_crc), (KERNEL, NODES, kernel_crc):
                entries = self.read(table, 0, 0, 0, count)
                refuse_if(zlib.crc32(entries) != crc, BAD_TABLE_CRC, table)
            self.generation = generation
        return bytes([generation])

    # --- Step 4: rows

    def drop_rows(self, next_row):
        self.taken = next_row  # the host has the rows before this one
        self.left = next_row  # the rows from `taken` to before this one wait in output banks
        self.entered = next_row  # those to before this one are in the core: at most one row
        self.waiting = {}  # rows in input banks: number -> frame, row, samples
        self.played = {}  # rows in the core and in output banks: number -> what their ROW_OUT says
        self.newest = None  # frame and row of the last one that entered the core

    def acknowledge(self, window):
        self.taken = max(self.taken, min(window, self.left))
        self.played = {number: row for number, row in self.played.items() if number >= self.taken}

    def row_in(self, payload, number, frame, row, width, flags, _generation):
        packed = payload[PLACE.size : PLACE.size + width // 2 * 3]
        refuse_if(len(packed) < width // 2 * 3, BAD_PAYLOAD)
        if number < self.entered or number in self.waiting:
            if self.taken <= number < self.left:  # its ROW_OUT was lost
                self.counters[ROWS_REPEATED] += 1
                self.row_out(number)
            else:
                self.counters[ROWS_UNNEEDED] += 1
            return
        refuse_if(number >= min(self.entered + IN_BANKS, 2**32 - 1), NO_CREDIT)
        refuse_if(self.configuration is None or self.generation == 0, NOT_READY)
        self.refuse_out_of_place(number, frame, row, width, flags)

        pairs = int.from_bytes(packed, "little")  # 12 bits a sample
        samples = [(pairs >> 12 * j) % 2**12 for j in range(width)]
        bits = self.configuration[4]
        self.counters[ROWS_IN] += 1
        self.counters[SAMPLES_OVER] += sum(sample >= 2**bits for sample in samples)
        self.waiting[number] = frame, row, samples

    def refuse_out_of_place(self, number, frame, row, width, flags):
        configured_width, height = self.configuration[:2]
        refuse_if(width != configured_width or row >= height, BAD_ROW)
        refuse_if(flags % 2 != (row == height - 1), BAD_ROW)
        if row > 0 and number == self.entered:  # row 0 may follow any row
            refuse_if(self.newest != (frame, row - 1), BAD_ROW)
        if row > 0 and number - 1 in self.waiting:  # otherwise its predecessor has not come yet
            refuse_if(self.waiting[number - 1][:2] != (frame, row - 1), BAD_ROW)

    def play(self):
        """Rows enter in the order of their numbers, each as soon as its output bank is free."""
        while self.entered in self.waiting and self.entered < self.taken + OUT_BANKS:
            self.enter(*self.waiting.pop(self.entered))

    def enter(self, frame, row, samples):
        width, height, centre2, gap_seed, bits = self.configuration
        factor = struct.unpack_from("<I", self.tables[FACTORS], row * ENTRY_BYTES[FACTORS])[0]
        nodes = list(struct.iter_unpack("<5h", self.tables[KERNEL]))
        corrected = enumerate(correct(samples, factor, nodes, centre2, bits))
        packed = sum(sample << 12 * j for j, sample in corrected).to_bytes(width // 2 * 3, "little")
        if row == 0:
            self.gaps = gap_draws(gap_seed)
        else:
            next(self.gaps)  # lengthens the blanking before the row
        pauses = sum(next(self.gaps) % 8 == 0 for _ in range(width))
        is_last = row == height - 1
        place = PLACE.pack(self.entered, frame, row, width, is_last, self.generation)
        latency = width // 2 + LATENCY
        reported = place + struct.pack("<HHH", latency, latency, pauses)
        self.played[self.entered] = [reported, 0, packed]
        self.newest = frame, row
        self.entered += 1
        # A row's second half leaves while the next row enters; the last one of a frame at once.
        while self.left < (self.entered if is_last else self.entered - 1):
            self.left += 1
            self.counters[ROWS_OUT] += 1
            self.latencies.add(latency)
            self.row_out(self.left - 1)

    def row_out(self, number):
        reported, repeats, packed = self.played[number]
        payload = reported + struct.pack("<H", repeats) + packed
        self.send(ROW_OUT, self.rows_sent % 2**16, 0, self.session, payload)
        self.rows_sent += 1
        self.played[number][1] += 1


# What carries out a request, and the fields with which its payload begins.
REQUESTS = {
    HELLO: (Board.hello, "<IIBBB"),
    CAPABILITIES: (Board.capabilities, "<"),
    STATUS: (Board.status, "<B"),
    RESET: (Board.reset, "<BI"),
    ECHO: (lambda board, payload: payload, "<"),
    TABLE_WRITE: (Board.table_write, "<BBBHH"),
    TABLE_READ: (Board.table_read, "<BBBHH"),
    TABLE_CRC: (Board.table_crc, "<BBBHH"),
    COMMIT: (Board.commit, "<IIHB"),
    CONFIGURE: (Board.configure, "<HHHHIB"),
    ROW_IN: (Board.row_in, PLACE.format),
    ROW_ACK: (lambda board, payload: None, "<"),  # its window has been looked at
}


# --- Step 5: the arithmetic (DATAPATH.md, from "Source coordinate" to "Output sample")
def correct(samples, factor, nodes, centre2, bits):
    # Beyond the ends stand the nearest samples of the same colour: `padded[4]` is column 0.
    padded = 2 * samples[:2] + samples + 2 * samples[-2:]
    for j in range(len(samples)):
        s = centre2 * 2**24 + (2 * j - centre2) * factor
        q = (s + 2**11) >> 12
        n = q >> 13
        a = n if n % 2 == j % 2 else n - 1
        x = q - a * 2**13
        i, t = x >> 8, x % 256
        pairs = zip(nodes[i], nodes[i + 1])
        g0, r1, g4, r5, g6 = (w + (((w_next - w) * t + 2**7) >> 8) for w, w_next in pairs)
        G0, R1, G2, R3, G4, R5, G6 = padded[a + 2 : a + 9]
        acc = G2 * 2**14 + g0 * (G0 - G2) + g4 * (G4 - G2) + g6 * (G6 - G2)
        acc += r1 * (R1 - R3) + r5 * (R5 - R3)
        yield min(max((acc + 2**13) >> 14, 0), 2**bits - 1)


# --- Step 6: time (WIRE.md, section 5)
def gap_draws(seed):
    """What the gap generator draws in a frame; a seed of 0 is for no gaps."""
    x = seed
    while True:
        x ^= (x << 13) % 2**32
        x ^= x >> 17
        x ^= (x << 5) % 2**32
        yield x if seed != 0 else 1


port = int(sys.argv[1])
server = socket.create_server(("127.0.0.1", port))
print(f"a board at tcp:127.0.0.1:{port}", flush=True)
board = Board()
while True:  # one host after another
    link, _ = server.accept()
    board.to_host = run = b""
    with link, contextlib.suppress(ConnectionError):  # a host may be killed
        while received := link.recv(2**16):
            *runs, run = (run[:5000] + received).split(b"\0")  # a longer run is no packet
            for whole in filter(None, runs):
                board.take(whole)
            link.sendall(board.to_host)
            board.to_host = b""
