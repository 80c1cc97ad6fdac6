"""A board behind a TCP port, from WIRE.md and DATAPATH.md alone: datapath 1, one bank of tables, no frames of its own.
    python3 board.py PORT"""
import contextlib, functools, itertools, math, re, socket, struct, sys, time, zlib

MAX_WIDTH, MAX_HEIGHT, IN_BANKS, OUT_BANKS, LATENCY = 256, 128, 2, 2, 12
CAPABILITIES = b"".join(struct.pack("<BB" + form, tag, struct.calcsize(form), value) for tag, form, value in zip(
    [*range(0x01, 0x10), 0x20], "HHHBBBHHBBBBBBIB", [1, MAX_WIDTH, MAX_HEIGHT, 7, 7, LATENCY, 256, 0, 1, IN_BANKS, OUT_BANKS, 1, 1, 0, 0, 3]))
VERSION, KIND, PAYLOAD, RANGE, SESSION, HELD, BUSY, NOT_READY, TABLE_CRC, CREDIT, ROW = range(1, 12)  # refusals
PACKETS, CRC_ERRORS, FRAMING_ERRORS, FOREIGN, REFUSALS, ROWS_IN, ROWS_OUT, REPEATED, UNNEEDED, OVER = range(10)  # counters
HEADER, SPAN, PLACE = "<BBHHBBI", "<BBBHH", "<IHHHBB"

def stuff(packet):  # in pieces of at most 254 bytes; the zero after a piece, and the one imagined at the end, are not sent
    pieces = [piece.rstrip(b"\0") for piece in re.findall(rb"[^\0]{254}(?:\0\Z)?|[^\0]*\0", packet + b"\0")]
    return b"".join(bytes([1 + len(piece)]) + piece for piece in pieces)

def unstuff(run):
    packet = b""
    while run:
        code, piece, run = run[0], run[1:run[0]], run[run[0]:]
        packet += piece + b"\0" * (code < 255 and run != b"") if len(piece) == code - 1 else bytes(5000)  # cut short: made too long
    return packet

def correct(row, factor, nodes, centre2, bits):  # DATAPATH.md, from *Source coordinate* to *Output sample*
    padded = row[:2] * 2 + row + row[-2:] * 2  # beyond the ends the nearest sample of the same colour
    for j in range(len(row)):
        q = (centre2 * 2**24 + (2 * j - centre2) * factor + 2**11) >> 12
        a = (q >> 13) - ((q >> 13) - j) % 2
        i, t = divmod(q - a * 2**13, 256)
        g0, r1, g4, r5, g6 = (left + ((right - left) * t + 2**7 >> 8) for left, right in zip(nodes[i], nodes[i + 1]))
        G0, R1, G2, R3, G4, R5, G6 = padded[a + 2:a + 9]
        acc = G2 * 2**14 + g0 * (G0 - G2) + g4 * (G4 - G2) + g6 * (G6 - G2) + r1 * (R1 - R3) + r5 * (R5 - R3)
        yield min(max(acc + 2**13 >> 14, 0), 2**bits - 1)

def draws(x):  # WIRE.md, section 5
    while True:
        x ^= x << 13 & 0xFFFFFFFF; x ^= x >> 17; x ^= x << 5 & 0xFFFFFFFF
        yield x or 1  # a seed of 0 is for no gaps

class Refusal(Exception): pass

def refuse_if(wrong, code, detail=0):
    if wrong: raise Refusal(code, detail)

class Board:
    def __init__(self):
        self.session, self.who, self.heard, self.counters, self.latencies, self.to_host = 0, None, 0, [0] * 10, set(), b""
        self.reset(b"", 2, 0)

    def hello(self, _, nonce, host, oldest, newest, take_over):
        refuse_if(not oldest <= 1 <= newest, VERSION, 1)
        rest = self.heard + 10 - time.monotonic()
        refuse_if(self.who and self.who[0] != host and rest > 0 and not take_over, HELD, math.ceil(10 * rest))
        if self.who != (host, nonce):  # otherwise the reply to this very HELLO was lost
            self.who, self.session, self.heard, self.sent = (host, nonce), self.session % 255 + 1, time.monotonic(), 0
            self.counters, self.latencies = [0] * 10, set()
            self.reset(b"", 0, 0)
        return struct.pack("<I4sBBIQ", nonce, b"HRW1", 1, self.session, 0, 0)

    def status(self, _, clear):
        next_in = next(row for row in itertools.count(self.entered) if row not in self.rows)
        least, most = min(self.latencies, default=0), max(self.latencies, default=0)
        counted = *self.counters, next_in, self.taken, self.left < self.entered, self.generation, least, most
        self.counters, self.latencies = ([0] * 10, set()) if clear else (self.counters, self.latencies)
        return struct.pack("<16I", *counted)

    def reset(self, _, level, next_row):  # the host has the rows before `taken`; out-banks those before `left`, the core before `entered`
        refuse_if(level > 2, PAYLOAD)
        self.rows, self.taken, self.left, self.entered, self.newest = {}, next_row, next_row, next_row, None
        self.who = None if level == 1 else self.who
        if level == 2:
            self.configuration, self.generation = None, 0
            self.tables = [bytearray(struct.pack("<I", 2**24) * MAX_HEIGHT), bytearray(65 * 10)]
        return b""

    def table(self, payload, table, bank, port, first, count, writes=False, reads=False):
        start, length = first * (4, 10)[table % 2], count * (4, 10)[table % 2]
        refuse_if(table > 1 or bank > 1 or writes and len(payload) < 7 + length, PAYLOAD)
        refuse_if(writes and bank == 1, RANGE, first)
        refuse_if(self.left < self.entered, BUSY)
        refuse_if(not writes and port > 0 or start + length > len(self.tables[table]) or reads and length > 4073, RANGE, first)
        for index, (factor,) in enumerate(struct.iter_unpack("<I", payload[7:7 + length]) if writes and table == 0 else ()):
            refuse_if(not 1 <= factor <= 2**24, RANGE, first + index)
        if writes: self.tables[table][start:start + length] = payload[7:7 + length]
        entries = self.tables[table][start:start + length]
        return b"" if writes else payload[:7] + entries if reads else struct.pack("<I", zlib.crc32(entries))

    def commit(self, _, factors_crc, kernel_crc, first_frame, generation):
        if generation == 0 or generation != self.generation:
            refuse_if(not self.configuration, NOT_READY)
            refuse_if(generation == 0, RANGE)
            for table, count, crc in (0, self.configuration[1], factors_crc), (1, 65, kernel_crc):
                refuse_if(self.table(b"", table, 0, 0, 0, count) != struct.pack("<I", crc), TABLE_CRC, table)
            self.generation = generation
        return bytes([generation])

    def configure(self, _, width, height, centre2, blanking, gap_seed, bits):
        refuse_if(self.rows, BUSY)
        legal = {5: bits in (8, 10, 12), 0: 64 <= width <= MAX_WIDTH and width % 2 == 0, 1: 1 <= height <= MAX_HEIGHT,
                 2: centre2 <= 2 * width - 2}
        refuse_if(not all(legal.values()), RANGE, next((field for field in legal if not legal[field]), 0))
        self.configuration = width, height, centre2, gap_seed, bits
        return b""

    def row_in(self, payload, number, frame, row, width, flags, _):
        packed = payload[12:12 + width // 2 * 3]
        refuse_if(len(packed) < width // 2 * 3, PAYLOAD)
        if number < self.entered or number in self.rows:
            is_out = self.taken <= number < self.left
            self.counters[REPEATED if is_out else UNNEEDED] += 1
            return self.row_out(number) if is_out else None
        refuse_if(number >= self.entered + IN_BANKS, CREDIT)
        refuse_if(not self.configuration or not self.generation, NOT_READY)
        (full_width, height, _, _, bits), is_next = self.configuration, number == self.entered
        before = self.newest if is_next else self.rows.get(number - 1, (None,))[0]
        refuse_if(width != full_width or row >= height or flags % 2 != (row == height - 1), ROW)
        refuse_if(row and (before != (frame, row - 1) if before else is_next), ROW)
        samples = [int.from_bytes(packed, "little") >> 12 * j & 0xFFF for j in range(width)]
        self.counters[ROWS_IN] += 1
        self.counters[OVER] += sum(sample >> bits > 0 for sample in samples)
        self.rows[number] = (frame, row), samples

    def play(self):  # rows enter in the order of their numbers, each when its out-bank is free; the row in front leaves meanwhile
        while self.entered in self.rows and self.entered < self.taken + OUT_BANKS:
            self.newest, samples = self.rows[self.entered]
            (frame, row), (width, height, centre2, gap_seed, bits) = self.newest, self.configuration
            nodes, factor = [*struct.iter_unpack("<5h", self.tables[1])], struct.unpack_from("<I", self.tables[0], 4 * row)[0]
            corrected = sum(sample << 12 * j for j, sample in enumerate(correct(samples, factor, nodes, centre2, bits)))
            self.draws = self.draws if row else draws(gap_seed)
            drawn = [next(self.draws) for _ in range(width + (row > 0))]  # in front of the samples' one that lengthens the blanking
            latency, pauses, is_last = width // 2 + LATENCY, sum(x % 8 == 0 for x in drawn[-width:]), row == height - 1
            self.rows[self.entered] = [(self.entered, frame, row, width, is_last, self.generation, latency, latency, pauses), 0, corrected]
            self.entered += 1
            for self.left in range(self.left + 1, self.entered + is_last):  # the row in front, and the last one of a frame too
                self.latencies.add(self.rows[self.left - 1][0][6])
                self.counters[ROWS_OUT] += 1
                self.row_out(self.left - 1)

    def row_out(self, number):
        place, repeats, corrected = self.rows[number]
        packed = corrected.to_bytes(3 * place[3] // 2, "little")
        self.send(0x21, self.sent % 2**16, 0, self.session, struct.pack(PLACE + "HHHH", *place, repeats) + packed)
        self.sent, self.rows[number][1] = self.sent + 1, repeats + 1

    def send(self, kind, sequence, flags, session, payload):
        packet = struct.pack(HEADER, 1, kind, sequence, len(payload), flags, session, self.entered + IN_BANKS) + payload
        self.to_host += b"\0" + stuff(packet + struct.pack("<I", zlib.crc32(packet))) + b"\0"

    def take(self, run):
        packet = unstuff(run)
        version, kind, sequence, length, _, session, window = struct.unpack_from(HEADER, packet + bytes(12))
        is_whole = zlib.crc32(packet[:-4]).to_bytes(4, "little") == packet[-4:]
        fault = (FRAMING_ERRORS if not 16 <= len(packet) <= 4096 else CRC_ERRORS if not is_whole else
                 FRAMING_ERRORS if version != 1 or length != len(packet) - 16 else PACKETS)
        self.counters[fault] += 1
        if fault == PACKETS: self.answer(packet[12:-4], kind, sequence, session, window)

    def answer(self, payload, kind, sequence, session, window):
        try:
            if kind:
                refuse_if(not self.who or session != self.session, SESSION)
                self.heard, self.taken = time.monotonic(), max(self.taken, min(window, self.left))
                self.rows = {number: row for number, row in self.rows.items() if number >= self.taken}
            refuse_if(kind not in REQUESTS, KIND)
            carry_out, form = REQUESTS[kind]
            refuse_if(len(payload) < struct.calcsize(form), PAYLOAD)
            reply = carry_out(self, payload, *struct.unpack_from(form, payload))
        except Refusal as refusal:
            code, detail = refusal.args
            reply, kind = struct.pack("<BBH", code, kind, detail) if kind != 0x22 else None, 0x7F  # a refused ROW_ACK is not answered
            self.counters[FOREIGN] += code == SESSION
            self.counters[REFUSALS] += reply is not None
        if reply is not None: self.send(kind, sequence, 1, session if kind else self.session, reply)
        self.play()

REQUESTS = {0x00: (Board.hello, "<IIBBB"), 0x01: (lambda board, _: CAPABILITIES, "<"), 0x02: (Board.status, "<B"), 0x03: (Board.reset, "<BI"),
            0x04: (lambda board, payload: payload, "<"), 0x10: (functools.partial(Board.table, writes=True), SPAN),
            0x11: (functools.partial(Board.table, reads=True), SPAN), 0x12: (Board.table, SPAN), 0x13: (Board.commit, "<IIHB"),
            0x18: (Board.configure, "<HHHHIB"), 0x20: (Board.row_in, PLACE), 0x22: (lambda board, _: None, "<")}

board, server = Board(), socket.create_server(("127.0.0.1", int(sys.argv[1])))
print(f"a board at tcp:127.0.0.1:{sys.argv[1]}", flush=True)
while True:
    link, run, board.to_host = server.accept()[0], b"", b""
    with link, contextlib.suppress(ConnectionError):  # a host may be killed
        while received := link.recv(2**16):
            *runs, run = (run[:5000] + received).split(b"\0")
            for whole in filter(None, runs): board.take(whole)
            link.sendall(board.to_host)
            board.to_host = b""
