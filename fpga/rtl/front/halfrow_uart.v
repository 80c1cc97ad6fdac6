// A UART with hardware handshake as a stream of bytes each way. 12 Mbaud is 8 clocks a bit at 96 MHz.
`default_nettype none

module halfrow_uart #(
    parameter DIVIDER = 8 // clocks a bit, 6 to 65535
) (
    input  wire       clk,
    input  wire       rst,

    input  wire       rxd,
    output wire       txd,
    output reg        rts_n = 1'b1, // high: the other side should stop; it may send 23 bytes more
    input  wire       cts_n,

    output wire       rx_valid,
    output wire [7:0] rx_data,
    input  wire       rx_ready,
    input  wire       tx_valid,
    input  wire [7:0] tx_data,
    output wire       tx_ready,
    output reg        byte_lost // pulse: one came without its stop bit, or nobody had room for it
);
    generate // what a build cannot have
        if (DIVIDER < 6 || DIVIDER > 65535) halfrow_illegal_DIVIDER is_6_to_65535 ();
    endgenerate

    localparam [5:0] ALMOST_FULL = 6'd40;

    wire valid, ready, framing_error;
    wire [7:0] data;
    wire [5:0] used;

    halfrow_uart_rx #(.DIVIDER(DIVIDER)) receiver (
        .clk(clk), .rst(rst), .rxd(rxd), .valid(valid), .data(data), .framing_error(framing_error));

    halfrow_fifo #(.WIDTH(8), .BITS(6)) fifo (
        .clk(clk), .rst(rst), .in_valid(valid), .in_data(data), .in_ready(ready),
        .out_valid(rx_valid), .out_data(rx_data), .out_ready(rx_ready), .used(used));

    halfrow_uart_tx #(.DIVIDER(DIVIDER)) sender (
        .clk(clk), .rst(rst), .valid(tx_valid), .data(tx_data), .ready(tx_ready), .cts_n(cts_n), .txd(txd));

    always @(posedge clk) begin
        rts_n <= rst || used >= ALMOST_FULL;
        byte_lost <= !rst && (framing_error || (valid && !ready));
    end
endmodule

`default_nettype wire
