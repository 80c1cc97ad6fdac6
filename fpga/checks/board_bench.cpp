// Drives a whole board, as written or as synthesised, at the pins of its link: HELLO, tables, rows, and compares what comes back with
// datapath.hpp, every sample and every latency; behind each frame a burst, if the board makes some, with its signatures. It ends at the first difference, with status 1.
//   board_bench FRAMES SEED
// Words with a + are the model's.
#include "board_link.hpp"
#include <algorithm>
#include <random>

#ifndef TAPS
#define TAPS 7
#endif
#ifndef LEAST_BLANKING
#define LEAST_BLANKING 0
#endif
constexpr int LATENCY = TAPS == 7 ? 12 : 11, RING = 2048;

struct Host {
    Link link;
    std::mt19937 random;
    uint16_t sequence = 0;
    uint8_t session = 0, generation = 0;
    uint32_t window = 0, have = 0;           // rows that may be sent, rows that came back
    uint64_t outputs = 0, signatures = 0, trapped = 0;
    int frame_blanking = -1;                 // the least of a burst; none if the board makes no bursts
    bool has_trap = false;
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

    // One packet of the board's; rows are put aside.
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

    void write(int table, const Bytes &entries, int count) {
        Bytes payload;
        put(payload, table, 1);
        put(payload, 0, 4);                  // bank, port, first
        put(payload, count, 2);
        payload.insert(payload.end(), entries.begin(), entries.end());
        ask(0x10, payload);
    }

    void configure(const Frame &frame, const std::vector<int64_t> &steps, const Kernel &kernel) {
        Bytes settings, factors, nodes, commit;
        put(settings, frame.width, 2);
        put(settings, steps.size(), 2);
        put(settings, frame.centre, 2);
        put(settings, LEAST_BLANKING + draw(20), 2);
        put(settings, draw(2) ? random() : 0, 4);
        put(settings, frame.bits, 1);
        ask(0x18, settings);
        for (int64_t step : steps)
            put(factors, step, 4);
        for (const Node &node : kernel)
            for (int16_t weight : node)
                put(nodes, uint16_t(weight), 2);
        write(0, factors, steps.size());
        write(1, nodes, 65);
        put(commit, crc_of(factors), 4);
        put(commit, crc_of(nodes), 4);
        put(commit, generation, 2);          // the frame's number
        put(commit, generation + 1, 1);
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

    void check_row(const Frame &frame, int row, int64_t step, const Kernel &kernel, const Row &samples) {
        while (rows.empty())
            hear();
        Bytes out = rows.front();
        rows.pop_front();
        if (get(out, 12, 4) != have || get(out, 16, 2) != generation - 1u || get(out, 18, 2) != unsigned(row) || out.at(23) != generation)
            fail("another row, or tables of another generation");
        if (get(out, 24, 2) != frame.width / 2u + LATENCY || get(out, 26, 2) != frame.width / 2u + LATENCY)
            fail("a latency that is not W/2 + L");
        for (int j = 0; j < frame.width; j++) {
            int sample = get(out, 32 + j / 2 * 3, 3) >> 12 * (j % 2) & 0xfff, due = output(frame, step, kernel, samples, j);
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

    // A record of frame n, AT-SPEED.md's Record.
    void check_record(const Bytes &record, const Frame &frame, const std::vector<int64_t> &steps, uint32_t due) {
        unsigned latency = frame.width / 2 + LATENCY;
        if (get(record, 0, 4) != due)
            fail("a signature differs");
        if (get(record, 4, 4) != frame.width * steps.size() || get(record, 8, 2) != steps.size())
            fail("a record counts other samples or rows");
        if (get(record, 10, 2) != latency || get(record, 12, 2) != latency)
            fail("a latency of a burst is not W/2 + L");
        if (get(record, 14, 2) != 0 || record.at(16) != generation)
            fail("a record has pauses, or another generation");
        signatures++;
    }

    // Fresh content has other frames each time, trapped content the same.
    void burst(const Frame &frame, const std::vector<int64_t> &steps, const Kernel &kernel, uint32_t seed, uint16_t number, bool fresh) {
        constexpr unsigned FRAMES = 3, RECORD = 18, HEAD = 10;
        Bytes start;
        put(start, 2 * generation + fresh, 4); // its name
        put(start, FRAMES, 4);
        put(start, seed, 4);
        put(start, number, 2);
        put(start, frame_blanking + draw(50), 2);
        put(start, fresh ? 0 : 3, 1);
        ask(0x30, start);
        for (unsigned got = 0; got < FRAMES;) {
            Bytes from;
            put(from, got, 4);
            Bytes reply = ask(0x31, from);
            for (unsigned k = 0, count = reply.at(9); k < count; k++, got++) {
                auto record = reply.begin() + HEAD + RECORD * k;
                check_record({record, record + RECORD}, frame, steps, signature(frame, steps, kernel, seed, number + (fresh ? got : 0)));
            }
        }
    }

    // A burst of which one row is expected to be another.
    void trap(const Frame &frame, const std::vector<int64_t> &steps, const Kernel &kernel) {
        uint32_t seed = random();
        uint16_t number = random();
        unsigned wrong = draw(steps.size());
        std::vector<Row> due;
        Bytes expected;
        put(expected, 0, 2);
        put(expected, steps.size(), 2);
        for (size_t row = 0; row < steps.size(); row++) {
            due.push_back(corrected(frame, steps[row], kernel, content(seed, number, row, frame.width, frame.bits)));
            put(expected, signature(due[row]) ^ (row == wrong ? 1u << draw(32) : 0), 4);
        }
        ask(0x32, expected);
        burst(frame, steps, kernel, seed, number, false);
        Bytes kept = ask(0x33, {});
        if (kept.at(0) != 1 || get(kept, 1, 4) != 0 || get(kept, 5, 2) != wrong || get(kept, 7, 2) != unsigned(frame.width)
            || get(kept, 9, 4) != signature(due[wrong]) || kept.size() != 13u + frame.width / 2 * 3)
            fail("another row is trapped");
        for (int j = 0; j < frame.width; j++)
            if (int(get(kept, 13 + j / 2 * 3, 3) >> 12 * (j % 2) & 0xfff) != due[wrong][j])
                fail("a sample of the trapped row differs");
        trapped++;
    }

    void play() {
        int width = 64 + 2 * draw(20);
        Frame frame{width, 8 + 2 * draw(3), draw(2) ? width - 1 : draw(2 * width - 1)};
        std::vector<int64_t> steps(3 + draw(2));
        std::vector<Row> samples;
        for (int64_t &factor : steps) {
            factor = step(frame);
            samples.emplace_back(width);
            for (int &sample : samples.back())
                sample = draw(1 << frame.bits);
        }
        Kernel weights = kernel();
        configure(frame, steps, weights);
        uint32_t first = have;
        for (size_t row = 0, sent = 0; row < steps.size(); row++) {
            while (sent < steps.size() && (sent <= row || first + sent < window)) {
                send_row(first + sent, sent, sent + 1 == steps.size(), samples[sent]);
                sent++;
            }
            check_row(frame, row, steps[row], weights, samples[row]);
        }
        if (frame_blanking >= 0)
            burst(frame, steps, weights, random(), random(), true);
        if (has_trap)
            trap(frame, steps, weights);
    }
};

int main(int argc, char **argv) {
    Verilated::commandArgs(argc, argv);
    if (argc < 3) {
        std::printf("board_bench FRAMES SEED\n");
        return 2;
    }
    Host host;
    host.random.seed(std::atoi(argv[2]));
    host.link.start();
    host.hello();
    for (int k = 0; k < std::atoi(argv[1]); k++)
        host.play();
    std::printf("%d taps: %lu samples, %lu signatures and %lu trapped rows equal, %lu clocks\n", TAPS, host.outputs, host.signatures,
                host.trapped, host.link.lines.clocks);
    return 0;
}
