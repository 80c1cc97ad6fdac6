// Drives halfrow_core clock by clock, for core_bench.cpp and grid_bench.cpp, and compares each output with what is expected.
#pragma once
#include "Vcore.h"
#include "datapath.hpp"
#include "words.hpp"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <functional>
#include <random>

#ifndef TAPS
#define TAPS 7
#endif
#ifndef TABLE_BANKS
#define TABLE_BANKS 2
#endif
#ifndef RING_BITS
#define RING_BITS 11
#endif
constexpr int LATENCY = TAPS == 7 ? 12 : 11, RING = 1 << RING_BITS;

struct Bench {
    static constexpr uint64_t UNKNOWN = ~0ull;
    Vcore core;
    std::mt19937 random;
    Frame frame{64, 12, 63};
    int gaps = 0;                            // at one edge in this many, on average, the enable is off; 0 for none
    struct Expected { uint64_t clock; int sample; bool first, last; };
    std::deque<Expected> expected;
    uint64_t pixel_clock = 0, strict_from = 0, outputs = 0;
    uint32_t crc = 0;
    int64_t clock = 0, prepared_since = 0;
    int shorts = 0, longs = 0, unprepared = 0;
    static constexpr int NEVER = -1;
    int shapes[2] = {0, 0};                  // of the banks, in the form of prepare_shape
    int patience = 24;                       // clocks that a row may take to be prepared
    struct { int column = NEVER, bank, row; } next; // the next row, requested with this column of the one that is played

    int draw(int count) { return random() % count; }

    [[noreturn]] void fail(const char *what) {
        std::printf("FAIL %s: W %d, C %d, B %d, pixel clock %lu, output %lu\n", what, frame.width, int(frame.centre), frame.bits,
                    pixel_clock, outputs);
        std::exit(1);
    }

    void edge() {
        core.clk = 0;
        core.eval();
        core.clk = 1;
        core.eval();
        core.prepare = 0;
        clock++;
        if (!core.prepared)
            prepared_since = clock + 1;
        shorts += core.row_short;
        longs += core.row_long;
        unprepared += core.row_unprepared;
    }

    void reset() {
        core.rst = 1;
        core.enable = core.in_valid = core.prepare = 0;
        next.column = NEVER;
        edge();
        core.rst = 0;
        expected.clear();
        strict_from = pixel_clock;
    }

    void pixel(bool valid, bool start, int sample) {
        core.in_valid = valid;
        core.in_start = start;
        core.in_sample = sample;
        while (gaps && draw(gaps) == 0) {
            core.enable = 0;
            edge();
        }
        core.enable = 1;
        core.clk = 0;
        core.eval();
        look();
        edge();
        core.enable = core.in_valid = core.in_start = 0;
        pixel_clock++;
    }

    // What a cut row leaves behind may come out until the outputs of the next row begin; from then on only expected outputs
    // may.
    void look() {
        if (!expected.empty() && expected.front().clock == pixel_clock) {
            Expected want = expected.front();
            expected.pop_front();
            if (!core.out_valid || core.out_start != want.first || core.out_last != want.last)
                fail("an output is missing or wrongly marked");
            if (core.out_sample != want.sample) {
                std::printf("column sample %d, expected %d\n", int(core.out_sample), want.sample);
                fail("a sample differs");
            }
            crc = crc32(crc, core.out_sample, 2);
            outputs++;
        } else if (core.out_valid && pixel_clock >= strict_from) {
            fail("an output that nobody expects");
        }
    }

    void configure(const Frame &with) {
        frame = with;
        core.width = frame.width;
        core.centre2 = frame.centre;
        core.depth = (frame.bits - 8) / 2;
    }

    void write_step(int bank, int row, int64_t step) {
        core.step_write = 1;
        core.table_bank = bank;
        core.table_entry = row;
        core.table_data[0] = step;
        edge();
        core.step_write = 0;
    }

    void write_kernel(int bank, const Kernel &kernel) {
        for (int node = 0; node < 65; node++) {
            core.node_write = 1;
            core.table_bank = bank;
            core.table_entry = node;
            for (int k = 0; k < 3; k++)
                core.table_data[k] = uint16_t(kernel[node][2 * k]) | (k < 2 ? uint32_t(uint16_t(kernel[node][2 * k + 1])) << 16 : 0);
            edge();
            core.node_write = 0;
        }
    }

    // Reads back through the datapath's ports. The core must be empty.
    void check_kernel(int bank, const Kernel &kernel) {
        for (int node = 0; node < 65; node++) {
            show(bank, node);
            for (int k = 0; k < 5; k++)
                if (int16_t(core.node_port_0[k / 2] >> 16 * (k % 2)) != kernel[node][k]
                    || int16_t(core.node_port_1[k / 2] >> 16 * (k % 2)) != kernel[node][k])
                    fail("a node reads back wrong");
        }
        core.table_read = 0;
    }

    void check_step(int bank, int row, int64_t step) {
        show(bank, row);
        if (core.step_port != step)
            fail("a step reads back wrong");
        core.table_read = 0;
    }

    void show(int bank, int entry) {
        core.table_read = 1;
        core.table_bank = bank;
        core.table_entry = entry;
        for (int clock = 0; clock < 3; clock++)
            edge();
        core.eval();
    }

    void ask(int bank, int row) {
        core.prepare = 1;
        core.prepare_row = row;
        core.prepare_bank = bank;
        core.prepare_shape = shapes[bank];
    }

    void prepare(int bank, int row) {
        ask(bank, row);
        edge();
    }

    void await_prepared() {
        for (int waited = 0; !core.prepared; waited++) {
            if (waited == patience)
                fail("the row is not prepared");
            edge();
        }
    }

    // Waits until the row is prepared. Returns minus the number of clocks since then.
    int64_t late() {
        await_prepared();
        return prepared_since - clock;
    }

    void expect(const Row &row, int64_t step, const Kernel &kernel) {
        Row outputs;
        for (int j = 0; j < frame.width; j++)
            outputs.push_back(output(frame, step, kernel, row, j));
        expect(outputs);
    }

    void expect(const Row &outputs) {
        if (strict_from == UNKNOWN)
            strict_from = pixel_clock + frame.width / 2 + LATENCY;
        for (int j = 0; j < frame.width; j++)
            expected.push_back({pixel_clock + j + frame.width / 2 + LATENCY, outputs[j], j == 0, j == frame.width - 1});
    }

    void play(const Row &row, int count) {
        for (int j = 0; j < count; j++) {
            if (j == next.column)
                ask(next.bank, next.row);
            pixel(true, j == 0, row[j % row.size()]);
        }
        next.column = NEVER;
    }

    void flush() {
        for (int k = 0; k < frame.width / 2 + LATENCY + 4; k++)
            pixel(false, false, draw(4096));
        if (!expected.empty())
            fail("outputs are missing");
    }

    Row content() {
        Row row(frame.width);
        int kind = draw(4), full = (1 << frame.bits) - 1;
        for (int j = 0; j < frame.width; j++)
            row[j] = kind == 0 ? draw(full + 1) : kind == 1 ? draw(2) * full : kind == 2 ? (j / 2 & 1) * full : draw(4096);
        return row;
    }

    Kernel kernel() {
        int kind = draw(8);
        if (kind < 4) {
            Kernel known = kernel_of(static_cast<Interpolant>(kind));
            return TAPS == 5 && kind == int(Interpolant::keys) ? kernel_of(Interpolant::hermite) : known;
        }
        Kernel drawn;
        for (Node &node : drawn)
            for (int k = 0; k < 5; k++)
                node[k] = TAPS == 5 && k % 4 == 0 ? 0 : kind == 4 ? (draw(2) ? 32767 : -32768) : int16_t(random()) >> draw(3);
        return drawn;
    }

    int64_t step() {
        for (int tries = 0; tries < 50; tries++) {
            int kind = draw(5);
            int64_t drawn = kind == 0 ? 1 + draw(1 << 24) : kind == 1 ? (1 << 24) - draw(1000) : kind == 2 ? 14648488 - draw(100000)
                            : kind == 3 ? 1 + draw(4) : (1 << 24) - draw(1 << 22);
            if (legal(frame, drawn, RING))
                return drawn;
        }
        return 1 << 24;
    }

    Frame drawn_frame(int widest) {
        int width = 64 + 2 * draw((widest - 64) / 2 + 1), kind = draw(4);
        return {width, 8 + 2 * draw(3), kind < 2 ? width - 1 : kind == 2 ? draw(2) * (2 * width - 2) : draw(2 * width - 1)};
    }
};

using Part = std::function<void(Bench &)>;   // of a bench's call

// One that judged nothing would pass whatever the core does.
inline void play_all(Bench &bench, const std::vector<Part> &parts) {
    for (const Part &part : parts) {
        const uint64_t before = bench.outputs;
        part(bench);
        if (bench.outputs == before)
            bench.fail("a part of the call has judged nothing");
    }
}
