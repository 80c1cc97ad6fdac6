// Drives a whole board, as written or as synthesised, at the pins of its link: HELLO, tables, rows. Compares every sample and
// every latency that comes back with datapath.hpp and grid.hpp. After each frame it has the board make a burst, if the board
// can, and compares its signatures. Every second frame is corrected by a grid, if the board takes grids. It ends at the first
// difference, with status 1.
//   board_bench FRAMES SEED
// Arguments that start with + are for the model.
#include "board_link.hpp"
#include "grid.hpp"
#include "words.hpp"
#include <algorithm>
#include <random>

#ifndef TAPS
#define TAPS 7
#endif
#ifndef LEAST_BLANKING
#define LEAST_BLANKING 0
#endif
constexpr int LATENCY = TAPS == 7 ? 12 : 11, RING = 2048;
constexpr unsigned HEAD = 10, RECORD = 18;   // bytes of a reply to RECORDS in front of its records, and of each

// What rows are made with: a factor for each, or a grid.
struct Tables {
    Frame frame;
    std::vector<int64_t> steps;
    Kernel kernel;
    Grid grid{{0, 6}, 0, 0, {}};

    bool has_grid() const { return grid.shape.v != 0; }
    unsigned height() const { return steps.size(); }

    Row outputs(int row, const Row &samples) const {
        if (!has_grid())
            return corrected(frame, steps[row], kernel, samples);
        std::vector<int64_t> sources = grid.sources(frame.centre, row);
        Row all;
        for (int j = 0; j < frame.width; j++)
            all.push_back(output_at(frame, position_of(sources[j]), kernel, samples, j));
        return all;
    }

    Row burst_row(uint32_t seed, uint16_t number, int row) const { return outputs(row, content(seed, number, row, frame.width, frame.bits)); }

    // The signature of a burst's frame.
    uint32_t signature_of(uint32_t seed, uint16_t number) const {
        uint32_t all = 0;
        for (unsigned row = 0; row < height(); row++)
            all = crc32(all, signature(burst_row(seed, number, row)), 4);
        return all;
    }
};

struct Host {
    Link link;
    std::mt19937 random;
    uint16_t sequence = 0;
    uint8_t session = 0, generation = 0;
    uint32_t window = 0, have = 0;           // rows that may be sent, rows that came back
    uint64_t outputs = 0, signatures = 0, trapped = 0, grids = 0;
    int frame_blanking = -1;                 // the least of a burst; negative if the board makes no bursts
    bool has_trap = false, takes_grids = false;
    int narrow_blanking = 0;                 // for grids; all frames here are narrow
    std::deque<Bytes> rows;                  // ROW_OUT packets

    int draw(int count) { return random() % count; }

    void send(uint8_t kind, const Bytes &payload) {
        Bytes packet;
        put(packet, 1, 1);
        put(packet, kind, 1);
        put(packet, sequence++, 2);
        put(packet, payload.size(), 2);
        put(packet, 0, 1);
        put(packet, session, 1);
        put(packet, have, 4);
        packet.insert(packet.end(), payload.begin(), payload.end());
        put(packet, crc_of(packet), 4);
        for (uint8_t byte : stuffed(packet))
            link.lines.to_board.push_back(byte);
    }

    // Returns one packet from the board. Rows are also put aside.
    Bytes hear() {
        Bytes packet = link.next_packet();
        if (packet[1] == 0x7f)
            fail("a refusal");
        window = get(packet, 8, 4);
        if (packet[1] == 0x21)
            rows.push_back(packet);
        return packet;
    }

    Bytes ask(uint8_t kind, const Bytes &payload) {
        send(kind, payload);
        Bytes reply = hear();
        while (reply[1] == 0x21)
            reply = hear();
        if (reply[1] != kind || get(reply, 2, 2) != uint16_t(sequence - 1))
            fail("an answer to something else");
        return Bytes(reply.begin() + 12, reply.end() - 4);
    }

    void hello() {
        Bytes payload;
        put(payload, 0x1badcafe, 4);
        put(payload, 0x12345678, 4);
        put(payload, 1, 1);
        put(payload, 1, 1);
        put(payload, 1, 1);
        Bytes reply = ask(0x00, payload);
        if (get(reply, 0, 4) != 0x1badcafe || get(reply, 4, 5) != 0x0131575248)
            fail("the reply to HELLO");
        session = reply.at(9);
        Bytes list = ask(0x01, {});
        int found = 0;
        for (size_t at = 0; at < list.size(); at += 2 + list.at(at + 1))
        {
            found += (list[at] == 0x05 && list.at(at + 2) == TAPS) + (list[at] == 0x06 && list.at(at + 2) == LATENCY);
            if (list[at] == 0x10 && get(list, at + 2, 2) == 1)
                frame_blanking = get(list, at + 6, 2), has_trap = list.at(at + 8);
        }
        for (size_t at = 0; at < list.size(); at += 2 + list.at(at + 1))
            if (list[at] == 0x12 && get(list, at + 2, 2) == 2)
                takes_grids = true, narrow_blanking = list.at(at + 7);
        if (found != 2)
            fail("the capabilities are not those of this build");
    }

    Kernel kernel() {
        Kernel drawn = kernel_of(draw(2) && TAPS == 7 ? Interpolant::keys : Interpolant::hermite);
        if (draw(2))
            for (Node &node : drawn)
                for (int k = 0; k < 5; k++)
                    node[k] = TAPS == 5 && k % 4 == 0 ? 0 : int16_t(random()) >> draw(3);
        return drawn;
    }

    int64_t step(const Frame &frame) {
        for (int tries = 0; tries < 50; tries++) {
            int64_t drawn = draw(2) ? 14648488 - draw(100000) : (1 << 24) - draw(1 << 22);
            if (legal(frame, drawn, RING))
                return drawn;
        }
        return 1 << 24;
    }

    // A grid whose rows lie in the frame: factors between a drawn least one and 1, and offsets drawn until it is legal.
    Grid grid(const Frame &frame, int height) {
        Grid drawn{{1 + draw(6), 5 + draw(2)}, frame.width, height, {}};
        for (int tries = 0; tries < 200; tries++) {
            int spread = 1 << (10 + draw(14));
            drawn.entries.assign(drawn.size(), 1 << 24);
            for (int e = drawn.rows(); e < drawn.size(); e++)
                drawn.entries[e] -= draw(spread);
            for (int b = 0; b < drawn.rows(); b++)
                drawn.entries[b] += draw(8 * 8192) - 4 * 8192;
            bool is_legal = true;
            for (int row = 0; row < height; row++)
                is_legal = is_legal && legal(drawn.sources(frame.centre, row), RING);
            if (is_legal)
                return drawn;
        }
        drawn.entries.assign(drawn.size(), 1 << 24);
        return drawn;
    }

    void write(int table, const Bytes &entries, int count) {
        Bytes payload;
        put(payload, table, 1);
        put(payload, 0, 4);                  // bank, port, first
        put(payload, count, 2);
        payload.insert(payload.end(), entries.begin(), entries.end());
        ask(0x10, payload);
    }

    void configure(const Tables &tables) {
        Bytes settings, factors, nodes, commit;
        put(settings, tables.frame.width, 2);
        put(settings, tables.height(), 2);
        put(settings, tables.frame.centre, 2);
        put(settings, std::max(LEAST_BLANKING, tables.has_grid() ? narrow_blanking : 0) + draw(20), 2);
        put(settings, draw(2) ? random() : 0, 4);
        put(settings, tables.frame.bits, 1);
        ask(0x18, settings);
        for (uint32_t entry : tables.grid.entries)
            put(factors, entry, 4);
        for (int64_t step : tables.steps)
            if (!tables.has_grid())
                put(factors, step, 4);
        for (const Node &node : tables.kernel)
            for (int16_t weight : node)
                put(nodes, uint16_t(weight), 2);
        write(tables.has_grid() ? 3 : 0, factors, factors.size() / 4);
        write(1, nodes, 65);
        put(commit, crc_of(factors), 4);
        put(commit, crc_of(nodes), 4);
        put(commit, generation, 2);          // the frame's number
        put(commit, generation + 1, 1);
        if (tables.has_grid())
            put(commit, tables.grid.shape.v | tables.grid.shape.k << 8, 2);
        ask(0x13, commit);
        generation++;
    }

    void send_row(uint32_t number, int row, bool last, const Row &samples) {
        Bytes payload;
        put(payload, number, 4);
        put(payload, generation - 1, 2);
        put(payload, row, 2);
        put(payload, samples.size(), 2);
        put(payload, last, 1);
        put(payload, 0, 1);
        for (size_t j = 0; j < samples.size(); j += 2)
            put(payload, samples[j] | samples[j + 1] << 12, 3);
        send(0x20, payload);
    }

    void check_row(const Tables &tables, int row, const Row &samples) {
        const Frame &frame = tables.frame;
        const Row all_due = tables.outputs(row, samples);
        while (rows.empty())
            hear();
        Bytes out = rows.front();
        rows.pop_front();
        if (get(out, 12, 4) != have || get(out, 16, 2) != generation - 1u || get(out, 18, 2) != unsigned(row) || out.at(23) != generation)
            fail("another row, or tables of another generation");
        if (get(out, 24, 2) != frame.width / 2u + LATENCY || get(out, 26, 2) != frame.width / 2u + LATENCY)
            fail("a latency that is not W/2 + L");
        for (int j = 0; j < frame.width; j++) {
            int sample = get(out, 32 + j / 2 * 3, 3) >> 12 * (j % 2) & 0xfff, due = all_due[j];
            if (sample != due) {
                std::printf("row %d, column %d: %d, due %d\n", row, j, sample, due);
                fail("a sample differs");
            }
            outputs++;
        }
        if (get(out, 32 + frame.width / 2 * 3, 4) != signature(samples))
            fail("what entered is not what was sent");
        have++;
        send(0x22, {});
    }

    // Checks the record of a frame (AT-SPEED.md, "Record").
    void check_record(const Bytes &record, const Tables &tables, uint32_t due) {
        unsigned latency = tables.frame.width / 2 + LATENCY;
        if (get(record, 0, 4) != due)
            fail("a signature differs");
        if (get(record, 4, 4) != tables.frame.width * tables.height() || get(record, 8, 2) != tables.height())
            fail("a record counts other samples or rows");
        if (get(record, 10, 2) != latency || get(record, 12, 2) != latency)
            fail("a latency of a burst is not W/2 + L");
        if (get(record, 14, 2) != 0 || record.at(16) != generation)
            fail("a record has pauses, or another generation");
        signatures++;
    }

    // Waits for records from number `from` on. The reply has at least one.
    Bytes records(uint32_t name, unsigned from, unsigned frames) {
        const uint64_t until = link.lines.clocks + PATIENCE;
        while (link.lines.clocks < until) {
            Bytes asked;
            put(asked, from, 4);
            const Bytes reply = ask(0x31, asked);
            const unsigned count = reply.at(9);
            if (get(reply, 0, 4) != name || get(reply, 4, 4) != from || count > frames - from || reply.size() != HEAD + RECORD * count)
                fail("records of another burst, or more than there are");
            if (count)
                return reply;
        }
        fail("no record within 20 million clocks");
    }

    // Fresh content has another frame each time; trapped content repeats one frame.
    void burst(const Tables &tables, uint32_t seed, uint16_t number, bool fresh) {
        constexpr unsigned FRAMES = 3;
        const uint32_t name = 2 * generation + fresh;
        Bytes start;
        put(start, name, 4);
        put(start, FRAMES, 4);
        put(start, seed, 4);
        put(start, number, 2);
        put(start, frame_blanking + draw(50), 2);
        put(start, fresh ? 0 : 3, 1);
        ask(0x30, start);
        for (unsigned got = 0; got < FRAMES;) {
            const Bytes reply = records(name, got, FRAMES);
            for (auto record = reply.begin() + HEAD; record < reply.end(); record += RECORD, got++)
                check_record({record, record + RECORD}, tables, tables.signature_of(seed, number + (fresh ? got : 0)));
        }
    }

    // Runs a burst with a wrong expected signature for one row, and checks that this row is trapped.
    void trap(const Tables &tables) {
        const int width = tables.frame.width;
        uint32_t seed = random();
        uint16_t number = random();
        unsigned wrong = draw(tables.height());
        std::vector<Row> due;
        Bytes expected;
        put(expected, 0, 2);
        put(expected, tables.height(), 2);
        for (unsigned row = 0; row < tables.height(); row++) {
            due.push_back(tables.burst_row(seed, number, row));
            put(expected, signature(due[row]) ^ (row == wrong ? 1u << draw(32) : 0), 4);
        }
        ask(0x32, expected);
        burst(tables, seed, number, false);
        Bytes kept = ask(0x33, {});
        if (kept.at(0) != 1 || get(kept, 1, 4) != 0 || get(kept, 5, 2) != wrong || get(kept, 7, 2) != unsigned(width)
            || get(kept, 9, 4) != signature(due[wrong]) || kept.size() != 13u + width / 2 * 3)
            fail("another row is trapped");
        for (int j = 0; j < width; j++)
            if (int(get(kept, 13 + j / 2 * 3, 3) >> 12 * (j % 2) & 0xfff) != due[wrong][j])
                fail("a sample of the trapped row differs");
        trapped++;
    }

    Tables drawn_tables() {
        int width = 64 + 2 * draw(20);
        Tables tables{{width, 8 + 2 * draw(3), draw(2) ? width - 1 : draw(2 * width - 1)}, std::vector<int64_t>(3 + draw(2)), kernel()};
        for (int64_t &factor : tables.steps)
            factor = step(tables.frame);
        if (takes_grids && generation % 2)
            tables.grid = grid(tables.frame, tables.height());
        return tables;
    }

    void play() {
        const Tables tables = drawn_tables();
        std::vector<Row> samples(tables.height(), Row(tables.frame.width));
        for (Row &row : samples)
            for (int &sample : row)
                sample = draw(1 << tables.frame.bits);
        configure(tables);
        uint32_t first = have;
        for (unsigned row = 0, sent = 0; row < tables.height(); row++) {
            while (sent < tables.height() && (sent <= row || first + sent < window)) {
                send_row(first + sent, sent, sent + 1 == tables.height(), samples[sent]);
                sent++;
            }
            check_row(tables, row, samples[row]);
        }
        grids += tables.has_grid();
        if (frame_blanking >= 0)
            burst(tables, random(), random(), true);
        if (has_trap)
            trap(tables);
    }
};

int main(int argc, char **argv) {
    Verilated::commandArgs(argc, argv);
    Words words(argc, argv, "FRAMES SEED");
    const int frames = words.number("FRAMES", 1), seed = words.number("SEED", 0);
    if (words.are_left())
        words.refuse("there is no word " + words.next("a word"));
    Host host;
    host.random.seed(seed);
    host.link.start();
    host.hello();
    for (int k = 0; k < frames; k++)
        host.play();
    if (!host.outputs || (host.frame_blanking >= 0 && !host.signatures) || (host.has_trap && !host.trapped))
        fail("nothing was judged of what the board can do");
    if (host.takes_grids && !host.grids)
        fail("no frame had a grid");
    std::printf("%d taps: %lu samples, %lu signatures and %lu trapped rows equal, %lu frames with grids, %lu clocks\n", TAPS, host.outputs,
                host.signatures, host.trapped, host.grids, host.link.lines.clocks);
    return 0;
}
