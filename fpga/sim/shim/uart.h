// The board behind a UART.
#pragma once

#include "pins.h"

// src/ffi.rs has the same structures.
struct UartInputs {
    bool link_edge, core_edge, rst, rxd, cts_n, millisecond;
};

struct UartOutputs {
    bool txd, rts_n, quiet;
};

template <class Model>
void clock_uart(Design<Model>& design, const UartInputs& in, UartOutputs& out) {
    Model& model = *design.model;
    model.rxd = in.rxd;
    model.cts_n = in.cts_n;
    clock_edges(design, in);
    out.txd = model.txd;
    out.rts_n = model.rts_n;
    out.quiet = model.quiet;
}

#define DESIGN(name, Model) OFFER(name, Model, UartInputs, UartOutputs, clock_uart)
