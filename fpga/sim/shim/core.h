// The core alone.
#pragma once

#include "design.h"

// src/ffi.rs has the same structures.
struct CoreInputs {
    bool rst, enable;
    uint8_t depth;
    bool prepare, prepare_bank, in_valid, in_start, step_write, node_write, table_bank;
    uint16_t width, centre2, prepare_row, in_sample, table_entry;
    uint32_t table_data[3];
};

struct CoreOutputs {
    bool prepared, out_valid, out_start, out_last, row_short, row_long, row_unprepared;
    uint16_t out_sample;
};

template <class Model>
void clock_core(Design<Model>& design, const CoreInputs& in, CoreOutputs& out) {
    Model& model = *design.model;
    model.clk = 0;
    model.rst = in.rst;
    model.enable = in.enable;
    model.depth = in.depth;
    model.prepare = in.prepare;
    model.prepare_bank = in.prepare_bank;
    model.in_valid = in.in_valid;
    model.in_start = in.in_start;
    model.step_write = in.step_write;
    model.node_write = in.node_write;
    model.table_bank = in.table_bank;
    model.table_read = 0;
    model.width = in.width;
    model.centre2 = in.centre2;
    model.prepare_row = in.prepare_row;
    model.in_sample = in.in_sample;
    model.table_entry = in.table_entry;
    for (int word = 0; word < 3; ++word) model.table_data[word] = in.table_data[word];
    design.settle();
    out.prepared = model.prepared;
    out.out_valid = model.out_valid;
    out.out_start = model.out_start;
    out.out_last = model.out_last;
    out.row_short = model.row_short;
    out.row_long = model.row_long;
    out.row_unprepared = model.row_unprepared;
    out.out_sample = model.out_sample;
    model.clk = 1;
    design.settle();
}

#define DESIGN(name, Model) OFFER(name, Model, CoreInputs, CoreOutputs, clock_core)
