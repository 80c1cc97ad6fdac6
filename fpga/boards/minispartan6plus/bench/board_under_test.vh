// The miniSpartan6+ as the boards' benches have it: `dut`, with its pins on their wires. BAUD: nanoseconds a bit.
localparam real BAUD = 83.333;                    // 12 Mbaud
`ifdef LINK_FIFO
    minispartan6plus_fifo dut (
        .clk32(oscillator), .ft_d(d), .ft_rxf_n(rxf_n), .ft_txe_n(txe_n), .ft_rd_n(rd_n), .ft_wr_n(wr_n),
        .ft_siwu_n(siwu_n), .led(led)
        `include "sensor_at_pins.vh"
    );
`else
    minispartan6plus_uart dut (
        .clk32(oscillator), .uart_rxd(rxd), .uart_txd(txd), .uart_cts_n(cts_n), .uart_rts_n(rts_n), .led(led)
        `include "sensor_at_pins.vh"
    );
`endif
