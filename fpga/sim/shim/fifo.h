// The board behind an FT245.
#pragma once

#include "pins.h"

// src/ffi.rs has the same structures.
struct FifoInputs {
    bool link_edge, core_edge, rst, rxf_n, txe_n;
    uint8_t data;
    bool millisecond;
};

struct FifoOutputs {
    bool rd_n, wr_n, siwu_n, control_drive;
    uint8_t data;
    bool data_drive, quiet;
};

template <class Model>
void clock_fifo(Design<Model>& design, const FifoInputs& in, FifoOutputs& out) {
    Model& model = *design.model;
    model.ft_rxf_n = in.rxf_n;
    model.ft_txe_n = in.txe_n;
    model.ft_data_in = in.data;
    clock_edges(design, in);
    out.rd_n = model.ft_rd_n;
    out.wr_n = model.ft_wr_n;
    out.siwu_n = model.ft_siwu_n;
    out.control_drive = model.ft_control_drive;
    out.data = model.ft_data_out;
    out.data_drive = model.ft_data_drive;
    out.quiet = model.quiet;
}

#define DESIGN(name, Model) OFFER(name, Model, FifoInputs, FifoOutputs, clock_fifo)
