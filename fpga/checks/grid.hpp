// A further implementation of datapath 2 of fpga/DATAPATH.md, by its closed form, for the checks of the core.
#pragma once
#include "datapath.hpp"
#include <algorithm>

struct Shape {
    int v, k;
    int port() const { return v | (k == 6) << 3; } // in the form of the core's port
};

struct Grid {
    Shape shape;
    int width, height;
    std::vector<uint32_t> entries;           // column by column

    int segments() const { return (width + (1 << shape.k) - 1) >> shape.k; }
    int rows() const { return ((height - 1) >> shape.v) + 3; }
    int size() const { return (segments() + 2) * rows(); }

    // P[c] of DATAPATH.md.
    int64_t spline(int column, int row) const {
        int64_t t = (row % (1 << shape.v)) << (6 - shape.v), w0 = (64 - t) * (64 - t), w2 = t * t;
        const uint32_t *entry = &entries[column * rows() + (row >> shape.v)];
        return (w0 * entry[0] + (8192 - w0 - w2) * entry[1] + w2 * entry[2] + 4096) >> 13;
    }

    int64_t factor(int node, int row) const { return 8 * std::min<int64_t>(spline(1 + node, row) >> 3, 1 << 21); }

    // S of each column, without a modulus.
    std::vector<int64_t> sources(int64_t centre, int row) const {
        int64_t start = 8 * centre * ((1 << 24) - factor(0, row)) + (spline(0, row) - (1 << 24)) * (1 << 15);
        std::vector<int64_t> all;
        for (int segment = 0; segment < segments(); segment++) {
            int64_t from = factor(segment, row), to = factor(segment + 1, row), length = 1 << shape.k;
            int64_t slope = floor_shift(to - from, 3) * (1 << (6 - shape.k));
            for (int64_t i = 0; i < length && int(all.size()) < width; i++)
                all.push_back(start + i * (16 * from + i * slope));
            start += 8 * length * (from + to);
        }
        return all;
    }
};

inline uint64_t modulo_40(int64_t source) { return uint64_t(source) & ((1ull << 40) - 1); }
inline int64_t position_of(int64_t source) { return modulo_40(source + (1 << 14)) >> 15; }

// Whether a row with these sources is legal for a ring.
inline bool legal(const std::vector<int64_t> &sources, int ring) {
    int64_t half = sources.size() / 2, last = sources.size() - 1;
    int64_t first_column = position_of(sources[0]) >> 13, last_column = position_of(sources[last]) >> 13;
    return sources[0] >= -(1 << 14) && sources[last] < int64_t(1) << 40 && last_column <= last && first_column + 4 <= half + 3
        && last - last_column + half - 1 < ring;
}

// A drawn grid of DATAPATH.md.
inline Grid drawn_grid(int width, int height, Shape shape, uint32_t seed, bool wide) {
    Grid grid{shape, width, height, {}};
    for (int e = 0; e < grid.size(); e++) {
        uint32_t drawn = (e + seed) * 2654435761u;
        grid.entries.push_back(wide ? drawn >> 7 : 14680064 + (drawn >> 12));
    }
    return grid;
}
