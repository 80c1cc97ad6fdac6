// The board with its byte ports.
#pragma once

#include "design.h"

// src/ffi.rs has the same structures.
struct BridgeInputs {
    bool rst, rx_valid;
    uint8_t rx_data;
    bool tx_ready, millisecond;
};

struct BridgeOutputs {
    bool rx_ready, tx_valid;
    uint8_t tx_data;
    bool quiet;
};

template <class Model>
void clock_bridge(Design<Model>& design, const BridgeInputs& in, BridgeOutputs& out) {
    Model& model = *design.model;
    tie_off(model);
    model.clk = 0;
    model.rst = in.rst;
    model.rx_valid = in.rx_valid;
    model.rx_data = in.rx_data;
    model.tx_ready = in.tx_ready;
    model.millisecond = in.millisecond;
    design.settle();
    out.rx_ready = model.rx_ready;
    out.tx_valid = model.tx_valid;
    out.tx_data = model.tx_data;
    out.quiet = model.quiet;
    model.clk = 1;
    design.settle();
}

#define DESIGN(name, Model) OFFER(name, Model, BridgeInputs, BridgeOutputs, clock_bridge)
