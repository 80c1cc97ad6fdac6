// A further implementation of fpga/DATAPATH.md and fpga/AT-SPEED.md, for the checks of the netlist: the table, the kernels, the
// output sample, and the content and the signatures of a burst.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

using Node = std::array<int16_t, 5>;         // g0 r1 g4 r5 g6
using Kernel = std::array<Node, 65>;
using Row = std::vector<int>;

struct Frame {
    int width, bits;
    int64_t centre;                          // C
};

inline int64_t floor_shift(int64_t value, int bits) { return value >= 0 ? value >> bits : -((-value - 1) >> bits) - 1; }

inline int64_t source(const Frame &frame, int64_t step, int64_t column) {
    return (frame.centre << 24) + (2 * column - frame.centre) * step;
}

inline int64_t source_column(const Frame &frame, int64_t step, int64_t column) {
    return floor_shift(source(frame, step, column) + 2048, 25);
}

// The two conditions of DATAPATH.md's section "Ring".
inline bool legal(const Frame &frame, int64_t step, int ring) {
    int64_t half = frame.width / 2, last = frame.width - 1;
    return source_column(frame, step, 0) + 4 <= half + 3 && last - source_column(frame, step, last) + half - 1 < ring;
}

inline int64_t tap(const Row &row, int64_t column) {
    int64_t width = row.size(), parity = column & 1;
    return row[column < 0 ? parity : column >= width ? width - 2 + parity : column];
}

// The output of a column whose source is at q.
inline int output_at(const Frame &frame, int64_t q, const Kernel &kernel, const Row &row, int64_t column) {
    int64_t n = floor_shift(q, 13);
    int64_t base = (n - column) % 2 == 0 ? n : n - 1, x = q - base * 8192, node = x / 256, fraction = x % 256;
    int64_t weight[5], near[7];
    for (int k = 0; k < 5; k++)
        weight[k] = kernel[node][k] + floor_shift((kernel[node + 1][k] - kernel[node][k]) * fraction + 128, 8);
    for (int k = 0; k < 7; k++)
        near[k] = tap(row, base - 2 + k);
    int64_t sum = near[2] * 16384 + weight[0] * (near[0] - near[2]) + weight[2] * (near[4] - near[2])
                + weight[4] * (near[6] - near[2]) + weight[1] * (near[1] - near[3]) + weight[3] * (near[5] - near[3]);
    int64_t rounded = floor_shift(sum + 8192, 14), largest = (1 << frame.bits) - 1;
    return rounded < 0 ? 0 : rounded > largest ? largest : rounded;
}

inline int output(const Frame &frame, int64_t step, const Kernel &kernel, const Row &row, int64_t column) {
    return output_at(frame, floor_shift(source(frame, step, column) + 2048, 12), kernel, row, column);
}

inline int64_t step_of(int row, int height, double radius) {
    double y = row - (height - 1) / 2.0;
    if (y * y >= radius * radius)
        return 1 << 24;
    return std::max<int64_t>(1, std::floor(16777216.0 * std::sqrt(radius * radius - y * y) / radius + 0.5));
}

enum class Interpolant { nearest, linear, keys, hermite, wild };

inline Kernel kernel_of(Interpolant interpolant) {
    Kernel kernel;
    for (int node = 0; node < 65; node++) {
        double x = node / 32.0, x2 = x * x, x3 = x2 * x;
        std::array<double, 5> v{};
        switch (interpolant) {
        case Interpolant::nearest: v[2] = x < 1 ? 0 : 1; break;
        case Interpolant::linear: v[2] = x / 2; break;
        case Interpolant::keys: v = {-x3 / 16 + x2 / 4 - x / 4, 0, -3 * x3 / 16 + x2 / 2 + x / 4, 0, x3 / 16 - x2 / 8}; break;
        case Interpolant::hermite: v = {0, -x3 / 8 + x2 / 2 - x / 2, -x3 / 4 + 3 * x2 / 4, x3 / 8 - x2 / 4, 0}; break;
        case Interpolant::wild: break;
        }
        for (int k = 0; k < 5; k++)
            kernel[node][k] = interpolant == Interpolant::wild ? int16_t(((5u * node + k) * 2654435761u >> 16) - 32768)
                                                               : int16_t(std::floor(v[k] * 16384 + 0.5));
    }
    return kernel;
}

inline int golden_sample(int width, int64_t row, int64_t column) { return uint32_t((row * width + column) * 2654435761u) >> 20; }

inline uint32_t crc32(uint32_t crc, uint32_t value, int bytes) {
    crc = ~crc;
    for (int bit = 0; bit < 8 * bytes; bit++)
        crc = crc >> 1 ^ ((crc ^ value >> bit) & 1 ? 0xedb88320 : 0);
    return ~crc;
}

inline uint32_t drawn_after(uint32_t x) {
    x ^= x << 13;
    x ^= x >> 17;
    return x ^ x << 5;
}

// A row of a burst (AT-SPEED.md, "Content").
inline Row content(uint32_t seed, uint16_t frame, int row, int width, int bits) {
    uint32_t first = drawn_after((seed ^ (uint32_t(frame) * 4096 + row)) | 0x80000000), x = first;
    int largest = (1 << bits) - 1, period = first >> 2 & 3, phase = first >> 4;
    Row samples;
    for (int j = 0; j < width; j++) {
        x = drawn_after(x);
        int level = x >> 20 & largest;
        switch (first & 3) {
        case 0: samples.push_back(level); break;
        case 1: samples.push_back(x >> 31 ? largest : 0); break;
        case 2: samples.push_back((j >> period) + phase & 1 ? largest : 0); break;
        default: samples.push_back(j == 0 || x % 16 == 0 ? level : samples.back());
        }
    }
    return samples;
}

// The outputs of a row with the factor `step`.
inline Row corrected(const Frame &frame, int64_t step, const Kernel &kernel, const Row &samples) {
    Row outputs;
    for (int j = 0; j < frame.width; j++)
        outputs.push_back(output(frame, step, kernel, samples, j));
    return outputs;
}

inline uint32_t signature(const Row &row) {
    uint32_t crc = 0;
    for (int sample : row)
        crc = crc32(crc, sample, 2);
    return crc;
}
