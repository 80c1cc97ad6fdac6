// A board at the pins of its link, as Verilator made it from a netlist or from its sources: packets to it and from it.
// LINK_FIFO: the board of edif_board.v; LINK_BYTES: halfrow_bridge; otherwise a UART.
#pragma once
#include "Vboard.h"
#include "datapath.hpp"
#include <cstdio>
#include <cstdlib>
#include <deque>

constexpr int CLOCKS_A_BIT = 32;
constexpr uint64_t PATIENCE = 20000000;      // clocks to wait for the board

using Bytes = std::vector<uint8_t>;

[[noreturn]] static void fail(const char *what) {
    std::printf("FAIL %s\n", what);
    std::exit(1);
}

static void put(Bytes &bytes, uint64_t value, int count) {
    for (int k = 0; k < count; k++)
        bytes.push_back(value >> 8 * k);
}

static uint64_t get(const Bytes &bytes, size_t from, int count) {
    uint64_t value = 0;
    for (int k = 0; k < count; k++)
        value |= uint64_t(bytes.at(from + k)) << 8 * k;
    return value;
}

static uint32_t crc_of(const Bytes &bytes) {
    uint32_t crc = 0;
    for (uint8_t byte : bytes)
        crc = crc32(crc, byte, 1);
    return crc;
}

static Bytes stuffed(const Bytes &packet) {
    Bytes out{0};
    for (size_t at = 0; at <= packet.size();) {
        size_t end = at;
        while (end < packet.size() && end - at < 254 && packet[end])
            end++;
        out.push_back(end - at + 1);
        out.insert(out.end(), packet.begin() + at, packet.begin() + end);
        if (end - at == 254 && end == packet.size())
            break;
        at = end - at == 254 ? end : end + 1;
    }
    out.push_back(0);
    return out;
}

static Bytes unstuffed(const Bytes &piece) {
    Bytes out;
    for (size_t at = 0; at < piece.size();) {
        size_t code = piece[at++];
        if (code - 1 > piece.size() - at)
            fail("a packet that is cut short");
        for (size_t k = 1; k < code; k++)
            out.push_back(piece[at++]);
        if (code != 255 && at < piece.size())
            out.push_back(0);
    }
    return out;
}

// The link's pins; there is a class for each kind of link. It sends the bytes in `to_board` and passes those that arrive to
// `heard_byte`.
struct Pins {
    Vboard board;
    std::deque<uint8_t> to_board;
    Bytes piece;
    std::deque<Bytes> packets;               // complete ones
    uint64_t clocks = 0;

    void heard_byte(uint8_t byte) {
        if (byte) {
            piece.push_back(byte);
        } else if (!piece.empty()) {
            packets.push_back(unstuffed(piece));
            piece.clear();
        }
    }
};

#ifdef LINK_FIFO
// An FT2232H as an asynchronous FIFO, in clocks of 10.4 ns: a byte is valid two clocks after RD# falls, and after a strobe its
// queue is not ready for six clocks. When neither side drives the data, they are those of a floating bus.
struct Lines : Pins {
    int reading = 0, read_rest = 6, write_rest = 0;
    bool wrote = false;

    static constexpr int CLOCKS_TO_START = 20000;

    Lines() { board.rxf_n = board.txe_n = 1; }

    void clock() {
        board.clk32 = 0;
        board.eval();
        board.clk32 = 1;
        board.eval();
        give();
        take();
        board.eval();
    }

    void give() {
        read_rest -= read_rest > 0;
        if (!board.rd_n) {
            if (board.rxf_n && !reading)
                fail("RD# without a byte");
            reading++;
        } else if (reading) {
            to_board.pop_front();
            reading = 0;
            read_rest = 6;
        }
        board.rxf_n = to_board.empty() || read_rest;
        board.d_given = reading >= 2;
        board.d_in = board.d_given ? to_board.front() : 0;
    }

    void take() {
        write_rest -= write_rest > 0;
        bool writes = !board.wr_n;
        if (writes && !wrote) {
            if (board.txe_n || board.d_given)
                fail("WR# where the chip takes no byte");
            heard_byte(board.d_out);
            write_rest = 6;
        }
        wrote = writes;
        board.txe_n = write_rest != 0;
    }
};
#elif defined(LINK_BYTES)
// Plain bytes. Either side is held up now and then.
struct Lines : Pins {
    static constexpr int CLOCKS_TO_START = 4;

    Lines() { board.camera_frame_valid = board.camera_line_valid = board.millisecond = board.rx_valid = 0; }

    void clock() {
        board.clk = 0;
        board.rst = clocks < CLOCKS_TO_START;
        board.tx_ready = clocks / 4096 % 2 ? 1 : clocks * 2654435761u >> 30 & 1;
        board.rx_valid = !to_board.empty();
        board.rx_data = to_board.empty() ? 0 : to_board.front();
        board.eval();
        bool taken = board.rx_valid && board.rx_ready, given = board.tx_valid && board.tx_ready;
        uint8_t data = board.tx_data;
        board.clk = 1;
        board.eval();
        if (taken)
            to_board.pop_front();
        if (given)
            heard_byte(data);
    }
};
#else
// The two lines of a UART.
struct Lines : Pins {
    static constexpr int CLOCKS_TO_START = 20000;
    int sent = 0, heard = -1;                // clocks into a byte; none is heard: -1
    uint8_t byte = 0;

    Lines() {
        board.ftdi_nrts = 0;
        board.ftdi_txd = 1;
    }

    void clock() {
        board.clk_25mhz = 0;
        board.eval();
        board.clk_25mhz = 1;
        board.eval();
        speak();
        listen();
    }

    void speak() {
        int bit = sent / CLOCKS_A_BIT;
        board.ftdi_txd = to_board.empty() || bit == 9 ? 1 : bit == 0 ? 0 : to_board.front() >> (bit - 1) & 1;
        if (!to_board.empty() && ++sent == 10 * CLOCKS_A_BIT) {
            sent = 0;
            to_board.pop_front();
        }
    }

    void listen() {
        if (heard < 0 && board.ftdi_rxd)
            return;
        heard++;
        int bit = heard / CLOCKS_A_BIT;
        if (heard % CLOCKS_A_BIT != CLOCKS_A_BIT / 2 || bit == 0)
            return;
        if (bit < 9) {
            byte = byte >> 1 | board.ftdi_rxd << 7;
            return;
        }
        if (!board.ftdi_rxd)
            fail("a byte without its stop bit");
        heard = -1;
        heard_byte(byte);
    }
};
#endif

// The packets over those lines.
struct Link {
    Lines lines;

    void start() {
        for (int k = 0; k < Lines::CLOCKS_TO_START; k++)
            edge();
    }

    void edge() {
        lines.clock();
        lines.clocks++;
    }

    Bytes next_packet() {
        for (uint64_t until = lines.clocks + PATIENCE; lines.packets.empty(); edge())
            if (lines.clocks == until)
                fail("no answer within 20 million clocks");
        Bytes packet = lines.packets.front();
        lines.packets.pop_front();
        if (packet.size() < 16 || crc_of(Bytes(packet.begin(), packet.end() - 4)) != get(packet, packet.size() - 4, 4) ||
            get(packet, 4, 2) != packet.size() - 16)
            fail("a packet that is damaged");
        return packet;
    }
};
