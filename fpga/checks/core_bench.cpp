// Drives halfrow_core, as written, as synthesised or with a fault put in, and compares each output with datapath.hpp, to the
// bit and the clock. It ends at the first difference, with status 1.
//   golden          the golden values of DATAPATH.md, W = 64
//   random N SEED   N cases: widths, depths, centres, steps, kernels, blankings, gaps, tables changed between rows
//   hostile N SEED  the same after rows that are too short, too long or unprepared, and after resets in mid row
//   frame KERNEL    the golden frame of 1920 x 1080 by its CRC-32: hermite or keys
// Arguments that start with + are for the model.
#include "core_driver.hpp"

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

// One case: some rows through both banks, often without a clock between them.
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
        // The next row is requested right after the start, somewhere in the row, or after it, as late as it can be waited for.
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
        rows(bench, bench.draw(30) ? 2 + bench.draw(3) : 40); // enough to go round any ring
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
    if (kind == 0)                           // a short row is noticed at the clock after it
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

static std::vector<Part> parts_of(Words words) {
    const int widest = std::min(200, RING);
    std::vector<Part> parts;
    while (words.are_left()) {
        const std::string part = words.next("a part");
        if (part == "golden") {
            parts.push_back(golden);
        } else if (part == "frame") {
            const std::string kernel = words.next("KERNEL");
            if (kernel != "hermite" && kernel != "keys")
                words.refuse("there is no golden frame of " + kernel);
            const Interpolant interpolant = kernel == "keys" ? Interpolant::keys : Interpolant::hermite;
            parts.push_back([interpolant](Bench &bench) { golden_frame(bench, interpolant); });
        } else if (part == "random" || part == "hostile") {
            const int count = words.number("N", 1), seed = words.number("SEED", 0);
            const auto cases = part == "random" ? random_cases : hostile_cases;
            parts.push_back([=](Bench &bench) { bench.random.seed(seed), cases(bench, count, widest); });
        } else {
            words.refuse("there is no part " + part);
        }
    }
    return parts;
}

int main(int argc, char **argv) {
    Verilated::commandArgs(argc, argv);
    const std::vector<Part> parts = parts_of({argc, argv, "golden, random N SEED, hostile N SEED, frame hermite, frame keys"});
    Bench bench;
    play_all(bench, parts);
    std::printf("%d taps, %d banks: %lu outputs equal\n", TAPS, TABLE_BANKS, bench.outputs);
    return 0;
}
