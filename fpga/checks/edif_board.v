// The miniSpartan6+'s FIFO top with its shared pins taken apart, for board_bench.cpp: what the chip drives goes in, what lies on the pins comes
// out. A pin that nobody drives is high.
`default_nettype none

module top (
    input  wire       clk32,
    input  wire       d_given,             // the chip drives the data
    input  wire [7:0] d_in,
    output wire [7:0] d_out,
    input  wire       rxf_n,
    input  wire       txe_n,
    output wire       rd_n,
    output wire       wr_n,
    output wire       siwu_n,
    output wire [7:0] led
);
    wire [7:0] d;

    assign d = d_given ? d_in : 8'hzz;
    assign d_out = d;
    pullup (wr_n);
    pullup (siwu_n);

    minispartan6plus_fifo board (
        .clk32(clk32), .ft_d(d), .ft_rxf_n(rxf_n), .ft_txe_n(txe_n), .ft_rd_n(rd_n), .ft_wr_n(wr_n), .ft_siwu_n(siwu_n), .led(led));
endmodule

`default_nettype wire
