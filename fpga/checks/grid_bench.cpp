// Drives halfrow_core with GRID, as written, as synthesised or with a fault put in, and compares each output of rows with and
// without a grid with datapath.hpp and grid.hpp, to the bit and the clock. It ends at the first difference, with status 1.
//   random N SEED   N cases: shapes, grids, widths, depths, centres, kernels, blankings, gaps, both datapaths from row to row
//   hostile N SEED  the same after grids that are not legal, rows that are too short or too long, and resets in mid row
//   frame FILE      all rows of a frame with the grid that `halfrow tables` wrote to FILE, without a pause between them
// Arguments that start with + are for the model.
#include "core_driver.hpp"
#include "grid.hpp"
#include <fstream>
#include <map>
#include <numeric>

// As the build advertises them (halfrow_board.vh).
constexpr int GRID_WIDTH = 144, GRID_BLANKING = 32;
#ifndef ENTRIES
#define ENTRIES 2048
#endif
// This many clocks before its start a row must be prepared, so that nothing has to wait for it.
constexpr int HEAD_START = 3;

static void golden(Bench &bench) {
    struct Case { int width, height, centre; Shape shape; uint32_t seed; bool wide; uint32_t grid, sources; };
    const Case cases[] = {
        {128, 9, 127, {1, 5}, 0, false, 0xf3f87b0c, 0x45fae881},
        {128, 70, 100, {6, 6}, 1, false, 0xdb248d53, 0x2617fe6d},
        {130, 40, 31, {3, 5}, 2, true, 0x27d84e57, 0x21b519cd},
        {192, 5, 382, {2, 6}, 3, true, 0x9f8f1aa6, 0xc53e6168},
    };
    for (const Case &known : cases) {
        Grid grid = drawn_grid(known.width, known.height, known.shape, known.seed, known.wide);
        uint32_t crc = 0, sources = 0;
        for (uint32_t entry : grid.entries)
            crc = crc32(crc, entry, 4);
        for (int row = 0; row < known.height; row++)
            for (int64_t source : grid.sources(known.centre, row)) {
                sources = crc32(sources, uint32_t(modulo_40(source)), 4);
                sources = crc32(sources, uint32_t(modulo_40(source) >> 32), 4);
            }
        if (crc != known.grid || sources != known.sources)
            bench.fail("a golden value");
    }
}

// The contents of a bank: a grid, or a factor for each row that is played.
struct Tables {
    Grid grid{{0, 6}, 0, 0, {}};
    std::map<int, int64_t> steps;            // of the rows that are played
    Kernel kernel;
    bool has_grid() const { return grid.shape.v != 0; }
};

// Draws entries whose rows lie anywhere in the frame and are mostly legal.
static Grid draw_entries(Bench &bench, Grid grid) {
    const int Z = grid.rows(), width = grid.width, kind = bench.draw(5);
    const int64_t whole = 1 << 24, least = kind == 0 ? 0 : kind == 1 ? whole / 2 : whole - (1 << (10 + bench.draw(13)));
    const int64_t spread = kind == 2 ? 1 << 12 : kind == 3 ? whole - least + 1 + bench.draw(1 << 20) : whole - least + 1;
    grid.entries.assign(grid.size(), whole);
    for (int e = Z; e < grid.size(); e++)
        grid.entries[e] = least + bench.draw(int(spread));
    const double steep = double(least) / whole, room = std::max(0.0, std::min(width / 2 - 2.0, (width - 1) * (1 - steep)));
    const double start = room * bench.draw(1000) / 1000.0;
    for (int b = 0; b < Z; b++) {
        double centred = bench.frame.centre / 2.0 * (1 - std::min(1.0, double(grid.entries[Z + b]) / whole));
        grid.entries[b] = std::clamp<int64_t>(whole + int64_t((start - centred) * 8192), 0, 2 * whole - 1);
    }
    return grid;
}

static Grid draw_grid(Bench &bench, const std::vector<int> &rows, int height) {
    Grid grid{{1 + bench.draw(6), 5 + bench.draw(2)}, bench.frame.width, height, {}};
    // If the frame is too large even for the coarsest rows, the segments become wider.
    while (grid.size() > ENTRIES)
        (grid.shape.v < 6 ? grid.shape.v : grid.shape.k)++;
    for (int tries = 0; tries < 200; tries++) {
        Grid drawn = draw_entries(bench, grid);
        bool is_legal = true;
        for (int row : rows)
            is_legal = is_legal && legal(drawn.sources(bench.frame.centre, row), RING);
        if (is_legal)
            return drawn;
    }
    grid.entries.assign(grid.size(), 1 << 24);
    return grid;
}

static void write_tables(Bench &bench, int bank, const Tables &tables, const std::vector<int> &rows) {
    bench.write_kernel(bank, tables.kernel);
    bench.shapes[bank] = tables.has_grid() ? tables.grid.shape.port() : bench.draw(2) << 3;
    for (size_t e = 0; e < tables.grid.entries.size(); e++)
        bench.write_step(bank, e, tables.grid.entries[e]);
    for (int row : rows)
        if (!tables.has_grid())
            bench.write_step(bank, row, tables.steps.at(row));
}

static Tables draw_tables(Bench &bench, int bank, const std::vector<int> &rows, int height) {
    Tables tables;
    tables.kernel = bench.kernel();
    if (bench.draw(3))
        tables.grid = draw_grid(bench, rows, height);
    for (int row : rows)
        tables.steps[row] = bench.step();
    write_tables(bench, bank, tables, rows);
    return tables;
}

static Row outputs(const Bench &bench, const Tables &tables, int row, const Row &samples) {
    std::vector<int64_t> sources;
    if (tables.has_grid())
        sources = tables.grid.sources(bench.frame.centre, row);
    Row all;
    for (int j = 0; j < bench.frame.width; j++)
        all.push_back(tables.has_grid() ? output_at(bench.frame, position_of(sources[j]), tables.kernel, samples, j)
                                        : output(bench.frame, tables.steps.at(row), tables.kernel, samples, j));
    return all;
}

// Plays a row and the blanking after it. The next row is requested with the column `asked`, or after the blanking. A row that
// is requested as early as possible must be ready when its turn comes.
static void play_row(Bench &bench, const Row &samples, int asked, int bank, int row, int blanking) {
    bench.next = {asked, bank, row};
    bench.play(samples, bench.frame.width);
    for (int k = 0; k < blanking; k++)
        bench.pixel(false, false, bench.draw(4096));
    if (asked == Bench::NEVER)
        bench.prepare(bank, row);
}

// With `eager`, each row is requested with the first column of the one before it, otherwise at any moment.
static void play(Bench &bench, const Tables *tables, const std::vector<int> &rows, int blanking, bool eager) {
    int bank = bench.draw(TABLE_BANKS);
    bench.prepare(bank, rows[0]);
    for (size_t number = 0; number < rows.size(); number++) {
        bench.await_prepared();
        Row samples = bench.content();
        bench.expect(outputs(bench, tables[bank], rows[number], samples));
        if (number + 1 == rows.size()) {
            bench.play(samples, bench.frame.width);
            break;
        }
        int moment = eager ? 0 : bench.draw(4), width = bench.frame.width, next_bank = bench.draw(TABLE_BANKS);
        int asked = moment < 2 ? 1 : moment == 2 ? 1 + bench.draw(width / 2 - 1) : Bench::NEVER;
        play_row(bench, samples, asked, next_bank, rows[number + 1], blanking);
        if (moment < 3 && bench.late() > -HEAD_START)
            bench.fail("a row that was asked for early is prepared late");
        bank = next_bank;
    }
    bench.flush();
}

// `held_up`: clocks for which an earlier row may still keep the grid's reader busy in vain.
static void one_case(Bench &bench, int held_up) {
    int height = 2 + bench.draw(bench.draw(2) ? 20 : 2047), count = 2 + bench.draw(4);
    std::vector<int> rows{bench.draw(height)};
    while (int(rows.size()) < std::min(count, height))
        rows.push_back((rows.back() + 1 + bench.draw(2) * bench.draw(height / count + 1)) % height);
    bench.core.last_row = height - 1;
    Tables tables[2];
    for (int bank = 0; bank < TABLE_BANKS; bank++)
        tables[bank] = draw_tables(bench, bank, rows, height);
    int narrow = bench.frame.width < GRID_WIDTH ? GRID_BLANKING + held_up : 0;
    play(bench, tables, rows, narrow + (bench.draw(2) ? bench.draw(9) : 0), false);
}

// A row of a grid with any entries: whole, cut, too long, or cut by a reset. Its output is not defined.
static void disturb(Bench &bench) {
    int kind = bench.draw(4), width = bench.frame.width, height = 1 + bench.draw(40), bits = 20 + bench.draw(6);
    Tables tables;
    tables.kernel = bench.kernel();
    tables.grid = drawn_grid(width, height, {1 + bench.draw(6), 5 + bench.draw(2)}, bench.random(), true);
    for (uint32_t &entry : tables.grid.entries)
        entry = bench.draw(4) ? entry : bench.draw(1 << bits);
    bench.core.last_row = height - 1;
    write_tables(bench, 0, tables, {});
    bench.prepare(0, bench.draw(height));
    if (bench.draw(8))
        bench.await_prepared();
    bench.strict_from = Bench::UNKNOWN;
    bench.play(bench.content(), kind == 0 ? 1 + bench.draw(width - 1) : kind == 1 ? width + 1 + bench.draw(width) : width);
    for (int k = 1 + bench.draw(3); k > 0; k--)
        bench.pixel(false, false, 0);
    if (kind == 3)
        bench.reset();
}

static void expect_no_flag(Bench &bench) {
    if (bench.shorts || bench.longs || bench.unprepared)
        bench.fail("a good row is flagged");
}

static void cases(Bench &bench, int count, bool hostile) {
    for (int k = 0; k < count; k++) {
        bench.reset();
        bench.configure(bench.drawn_frame(bench.draw(3) ? 200 : bench.draw(3) ? 260 : std::min(2592, RING)));
        bench.gaps = bench.draw(2) ? 0 : 2 + bench.draw(6);
        if (hostile)
            disturb(bench);
        bench.shorts = bench.longs = bench.unprepared = 0;
        one_case(bench, hostile ? 9 : 0);
        expect_no_flag(bench);
    }
}

static Grid grid_of(Bench &bench, const char *path) {
    std::ifstream file(path);
    std::string head;
    Grid grid{};
    int bits = 0, centre = 0;
    std::getline(file, head);
    std::getline(file, head);
    if (std::sscanf(head.c_str(), "// datapath=2 width=%d height=%d bits=%d centre2=%d v=%d k=%d", &grid.width, &grid.height, &bits,
                    &centre, &grid.shape.v, &grid.shape.k) != 6)
        bench.fail("what the file of a grid begins with");
    for (uint32_t entry; file >> std::hex >> entry;)
        grid.entries.push_back(entry);
    if (int(grid.entries.size()) != grid.size() || grid.size() > ENTRIES)
        bench.fail("how many entries the file of a grid has");
    bench.configure({grid.width, bits, centre});
    return grid;
}

static void whole_frame(Bench &bench, const char *path) {
    bench.reset();
    const Grid grid = grid_of(bench, path);
    std::vector<int> rows(grid.height);
    std::iota(rows.begin(), rows.end(), 0);
    for (int row : rows)
        if (!legal(grid.sources(bench.frame.centre, row), RING))
            bench.fail("a row of the grid is not legal");
    Tables tables[2];
    for (int bank = 0; bank < TABLE_BANKS; bank++) {
        tables[bank].grid = grid;
        tables[bank].kernel = kernel_of(Interpolant::hermite);
        write_tables(bench, bank, tables[bank], rows);
    }
    bench.core.last_row = grid.height - 1;
    bench.gaps = 0;
    play(bench, tables, rows, 0, true);
    expect_no_flag(bench);
}

static std::vector<Part> parts_of(Words words) {
    std::vector<Part> parts;
    while (words.are_left()) {
        const std::string part = words.next("a part");
        if (part == "frame") {
            const std::string path = words.next("FILE");
            parts.push_back([path](Bench &bench) { whole_frame(bench, path.c_str()); });
        } else if (part == "random" || part == "hostile") {
            const int count = words.number("N", 1), seed = words.number("SEED", 0);
            const bool hostile = part == "hostile";
            parts.push_back([=](Bench &bench) { bench.random.seed(seed), cases(bench, count, hostile); });
        } else {
            words.refuse("there is no part " + part);
        }
    }
    return parts;
}

int main(int argc, char **argv) {
    Verilated::commandArgs(argc, argv);
    const std::vector<Part> parts = parts_of({argc, argv, "random N SEED, hostile N SEED, frame FILE"});
    Bench bench;
    bench.patience = 100;
    golden(bench);
    play_all(bench, parts);
    std::printf("%d taps, %d banks, both datapaths: %lu outputs equal\n", TAPS, TABLE_BANKS, bench.outputs);
    return 0;
}
