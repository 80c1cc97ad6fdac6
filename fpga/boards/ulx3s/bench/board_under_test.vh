// The ULX3S as the boards' benches have it: `dut`, with its pins on their wires. BAUD: nanoseconds a bit.
localparam real BAUD = 333.333;                   // 3 Mbaud
`ifdef LINK_FIFO
    wire unused_rxd;
    ulx3s_fifo dut (
        .clk_25mhz(oscillator), .ft_d(d), .ft_rxf_n(rxf_n), .ft_txe_n(txe_n), .ft_rd_n(rd_n), .ft_wr_n(wr_n),
        .ft_siwu_n(siwu_n), .ftdi_rxd(unused_rxd), .wifi_gpio0(1'b1), .wifi_en(1'b1), .led(led)
        `include "sensor_at_pins.vh"
    );
`else
    assign rts_n = 1'b0;                          // it has none
    ulx3s_uart dut (
        .clk_25mhz(oscillator), .ftdi_txd(rxd), .ftdi_rxd(txd), .ftdi_nrts(cts_n), .wifi_gpio0(1'b1), .wifi_en(1'b1), .led(led)
        `include "sensor_at_pins.vh"
    );
`endif
