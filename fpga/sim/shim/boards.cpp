// The boards that ship: with byte ports, behind a UART and behind an FT245.

#include "Bridge.h"
#include "FifoBridge.h"
#include "UartBridge.h"
#include "bridge.h"

// One step of both clocks, of which those rise that `in` names. Unlike elsewhere the outputs are then those behind the
// edge, which is when pins change.
template <class Model, class Inputs>
void clock_edges(Design<Model>& design, const Inputs& in) {
    Model& model = *design.model;
    tie_off(model);
    model.clk = 0;
    model.link_clk = 0;
    model.rst = in.rst;
    model.link_rst = in.rst;
    model.millisecond = in.millisecond;
    design.settle();
    model.clk = in.core_edge;
    model.link_clk = in.link_edge;
    design.settle();
}

// The same structures stand in src/ffi.rs.
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

DESIGN(bridge, Bridge, BridgeInputs, BridgeOutputs, clock_bridge)
DESIGN(uart, UartBridge, UartInputs, UartOutputs, clock_uart)
DESIGN(fifo, FifoBridge, FifoInputs, FifoOutputs, clock_fifo)
