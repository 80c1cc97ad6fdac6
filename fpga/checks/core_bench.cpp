// Drives halfrow_core, as written, as synthesised or with a fault put in, and compares each output with datapath.hpp, to the
// bit and the clock. It ends at the first difference, with status 1.
//   golden          the golden values of DATAPATH.md, W = 64
//   random N SEED   N cases: widths, depths, centres, steps, kernels, blankings, gaps, tables changed between rows
//   hostile N SEED  the same behind rows too short and too long, rows unprepared, resets in mid row
//   frame KERNEL    the golden frame of 1920 x 1080 by its CRC-32: hermite or keys
// Words with a + are the model's.
#include "Vcore.h"
#include "datapath.hpp"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
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
    int gaps = 0;                            // one edge in so many has the enable off
    struct Expected { uint64_t clock; int sample; bool first, last; };
    std::deque<Expected> expected;
    uint64_t pixel_clock = 0, strict_from = 0, outputs = 0;
    uint32_t crc = 0;
    int shorts = 0, longs = 0, unprepared = 0;
    static constexpr int NEVER = -1;
    struct { int column = NEVER, bank, row; } next; // the row behind is prepared with this column of the one that is played

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

    // What a cut row leaves behind may come out until the next row does; from then on nothing but what is expected.
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

    // Reads back through the datapath's ports; the core is empty.
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
    }

    void prepare(int bank, int row) {
        ask(bank, row);
        edge();
    }

    void await_prepared() {
        for (int waited = 0; !core.prepared; waited++) {
            if (waited == 24)
                fail("the row is not prepared");
            edge();
        }
    }

    void expect(const Row &row, int64_t step, const Kernel &kernel) {
        if (strict_from == UNKNOWN)
            strict_from = pixel_clock + frame.width / 2 + LATENCY;
        for (int j = 0; j < frame.width; j++)
            expected.push_back({pixel_clock + j + frame.width / 2 + LATENCY, output(frame, step, kernel, row, j), j == 0,
                                j == frame.width - 1});
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

static void golden(Bench &bench) {
    struct Corner { int bits, centre; int64_t step; Interpolant kernel; uint32_t crc; };
    const Corner corners[] = {
        {12, 0, 1, Interpolant::keys, 0x2ce17723},        {12, 126, 16777215, Interpolant::keys, 0xe38d756b},
        {12, 17, 12345678, Interpolant::wild, 0xf84488c9}, {10, 100, 9000001, Interpolant::hermite, 0x06f1c28b},
        {8, 63, 8388608, Interpolant::wild, 0x741a394d},   {12, 63, 1, Interpolant::linear, 0x0daa9274},
        {12, 126, 8255472, Interpolant::wild, 0xdde42372},
    };
    for (const Corner &corner : corners) {
        if (TAPS == 5 && (corner.kernel == Interpolant::keys || corner.kernel == Interpolant::wild))
            continue;
        bench.reset();
        bench.configure({64, corner.bits, corner.centre});
        Kernel kernel = kernel_of(corner.kernel);
        bench.write_step(0, 5, corner.step);
        bench.write_kernel(0, kernel);
        bench.check_kernel(0, kernel);
        Row row(64);
        for (int j = 0; j < 64; j++)
            row[j] = golden_sample(64, 0, j) >> (12 - corner.bits);
        bench.crc = 0;
        bench.prepare(0, 5);
        bench.await_prepared();
        bench.expect(row, corner.step, kernel);
        bench.play(row, 64);
        bench.flush();
        if (bench.crc != corner.crc)
            bench.fail("a golden value");
    }
}

// One case: some rows through both banks, often with no clock between them.
static void rows(Bench &bench, int count) {
    const int first = bench.draw(2048);
    auto entry = [first](int row) { return (first + 37 * row) % 2048; };
    Kernel kernels[2] = {bench.kernel(), bench.kernel()};
    std::vector<int64_t> steps[2];
    for (int bank = 0; bank < TABLE_BANKS; bank++) {
        bench.write_kernel(bank, kernels[bank]);
        for (int row = 0; row < count; row++) {
            steps[bank].push_back(bench.step());
            bench.write_step(bank, entry(row), steps[bank][row]);
        }
    }
    int blanking = bench.draw(2) ? bench.draw(9) : 0;
    int waits = bench.draw(3) ? 0 : bench.draw(40);
    int bank = bench.draw(TABLE_BANKS);
    bench.prepare(bank, entry(0));
    for (int row = 0; row < count; row++) {
        bench.await_prepared();
        for (int k = 0; k < waits; k++)
            bench.edge();
        for (int k = 0; row && k < blanking; k++)
            bench.pixel(false, false, bench.draw(4096));
        Row samples = bench.content();
        bench.expect(samples, steps[bank][row], kernels[bank]);
        if (row + 1 == count) {
            bench.play(samples, bench.frame.width);
            break;
        }
        // At once behind the start, somewhere in the row, or behind it, as late as the next one can wait for.
        int columns = bench.frame.width, moment = bench.draw(3), next_bank = bench.draw(TABLE_BANKS), next_row = entry(row + 1);
        bench.next = {moment == 0 ? 1 : 1 + bench.draw(columns - 1), next_bank, next_row};
        if (moment == 2)
            bench.next.column = Bench::NEVER;
        bench.play(samples, columns);
        if (moment == 2)
            bench.prepare(next_bank, next_row);
        bank = next_bank;
    }
    bench.flush();
    for (int bank = 0; bank < TABLE_BANKS; bank++) {
        bench.check_kernel(bank, kernels[bank]);
        for (int row = 0; row < count; row++)
            bench.check_step(bank, entry(row), steps[bank][row]);
    }
}

static void random_cases(Bench &bench, int cases, int widest) {
    for (int k = 0; k < cases; k++) {
        bench.reset();
        bench.configure(bench.drawn_frame(bench.draw(4) ? std::min(100, widest) : widest));
        bench.gaps = bench.draw(2) ? 0 : 2 + bench.draw(6);
        bench.shorts = bench.longs = bench.unprepared = 0;
        rows(bench, bench.draw(30) ? 2 + bench.draw(3) : 40); // enough for any ring to go round
        if (bench.shorts || bench.longs || bench.unprepared)
            bench.fail("a good row is flagged");
    }
}

static void disturb(Bench &bench) {
    int kind = bench.draw(4), width = bench.frame.width;
    Row samples = bench.content();
    bench.strict_from = Bench::UNKNOWN;
    bench.shorts = bench.longs = bench.unprepared = 0;
    if (kind != 2) {
        bench.prepare(0, 0);
        bench.await_prepared();
    }
    bench.play(samples, kind == 0 ? 1 + bench.draw(width - 1) : kind == 1 ? width + 1 + bench.draw(width) : width);
    for (int k = bench.draw(3); k > 0; k--)
        bench.pixel(false, false, 0);
    if (kind == 0)                           // a short row is seen at the clock behind it
        bench.pixel(false, false, 0);
    if ((bench.shorts > 0) != (kind == 0) || (bench.longs > 0) != (kind == 1) || (bench.unprepared > 0) != (kind == 2))
        bench.fail("a bad row is not flagged, or a good one is");
    if (kind == 3)
        bench.reset();
}

static void hostile_cases(Bench &bench, int cases, int widest) {
    for (int k = 0; k < cases; k++) {
        bench.reset();
        bench.configure(bench.drawn_frame(widest));
        bench.gaps = bench.draw(2) ? 0 : 2 + bench.draw(6);
        bench.write_step(0, 0, bench.step());
        bench.write_kernel(0, bench.kernel());
        disturb(bench);
        rows(bench, 1 + bench.draw(3));
    }
}

static void golden_frame(Bench &bench, Interpolant interpolant) {
    bench.reset();
    bench.configure({1920, 12, 1919});
    bench.crc = 0;
    Kernel kernel = kernel_of(interpolant);
    bench.write_kernel(0, kernel);
    uint32_t table = 0;
    for (int row = 0; row < 1080; row++) {
        int64_t step = step_of(row, 1080, 1106.697);
        table = crc32(table, step, 4);
        bench.write_step(0, row, step);
    }
    if (table != 0x5f5a7553)
        bench.fail("the golden table");
    for (int row = 0; row < 1080; row++) {
        bench.prepare(0, row);
        bench.await_prepared();
        Row samples(1920);
        for (int j = 0; j < 1920; j++)
            samples[j] = golden_sample(1920, row, j);
        bench.expect(samples, step_of(row, 1080, 1106.697), kernel);
        bench.play(samples, 1920);
    }
    bench.flush();
    if (bench.crc != (interpolant == Interpolant::keys ? 0xd55e261f : 0x3ecf6d03))
        bench.fail("the golden frame");
}

int main(int argc, char **argv) {
    Verilated::commandArgs(argc, argv);
    Bench bench;
    const int widest = std::min(200, RING);
    for (int k = 1; k < argc; k++) {
        const char *what = argv[k];
        int count = k + 1 < argc ? std::atoi(argv[k + 1]) : 0;
        if (std::strcmp(what, "golden") == 0) {
            golden(bench);
        } else if (what[0] == '+') {
            continue;
        } else if (std::strcmp(what, "frame") == 0 && k + 1 < argc) {
            golden_frame(bench, argv[++k][0] == 'k' ? Interpolant::keys : Interpolant::hermite);
        } else if (k + 2 < argc && count > 0) {
            bench.random.seed(std::atoi(argv[k + 2]));
            k += 2;
            std::strcmp(what, "hostile") == 0 ? hostile_cases(bench, count, widest) : random_cases(bench, count, widest);
        } else {
            std::printf("core_bench: what is %s?\n", what);
            return 2;
        }
    }
    std::printf("%d taps, %d banks: %lu outputs equal\n", TAPS, TABLE_BANKS, bench.outputs);
    return 0;
}
