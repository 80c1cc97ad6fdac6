// The board behind a UART: its pins and the link's clock on one side, halfrow_bridge and the core's clock on the other.
`default_nettype none

module halfrow_uart_bridge #(
    parameter DIVIDER = 8,                // link clocks a bit
    parameter MAX_WIDTH = 2048,
    parameter MAX_HEIGHT = 2048,
    parameter POWER_UP_WIDTH = MAX_WIDTH,
    parameter POWER_UP_HEIGHT = MAX_HEIGHT,
    parameter RING_BITS = 11,
    parameter TAPS = 7,
    parameter TABLE_BANKS = 2,
    parameter ROW_BANKS_IN = 2,
    parameter ROW_BANKS_OUT = 2,
    parameter TRAP = 1,
    parameter GRID = 0,
    parameter ENTRIES = 2048,
    parameter [31:0] BUILD = 32'd0,
    parameter [7:0] NATURE = 8'd1,
    parameter [8*69-1:0] NAME = "halfrow" // 1 to 68 bytes
) (
    input  wire        link_clk,
    input  wire        link_rst,
    input  wire        rxd,
    output wire        txd,
    output wire        rts_n,
    input  wire        cts_n,

    input  wire        clk, // the core's; both resets are held together
    input  wire        rst,
    input  wire        millisecond,
    input  wire [7:0]  clock_source,
    input  wire [31:0] clock_hz,
    input  wire [63:0] serial,

    input  wire        camera_frame_valid,
    input  wire        camera_line_valid,
    input  wire [11:0] camera_data,
    output wire        isp_frame_valid,
    output wire        isp_line_valid,
    output wire [11:0] isp_data,
    output wire        camera_fault,

    output wire        session_open,
    output wire        packet_seen,
    output wire        quiet
);
    wire link_rx_valid, link_rx_ready, link_tx_valid, link_tx_ready;
    wire [7:0] link_rx_data, link_tx_data;
    wire rx_valid, rx_ready, tx_valid, tx_ready;
    wire [7:0] rx_data, tx_data;

    wire byte_lost;
    wire unused = &{1'b0, byte_lost}; // the packet that it belonged to is counted as damaged

    halfrow_uart #(.DIVIDER(DIVIDER)) uart (
        .clk(link_clk), .rst(link_rst), .rxd(rxd), .txd(txd), .rts_n(rts_n), .cts_n(cts_n),
        .rx_valid(link_rx_valid), .rx_data(link_rx_data), .rx_ready(link_rx_ready),
        .tx_valid(link_tx_valid), .tx_data(link_tx_data), .tx_ready(link_tx_ready), .byte_lost(byte_lost));

    halfrow_async_fifo rx_queue (
        .in_clk(link_clk), .in_rst(link_rst), .in_valid(link_rx_valid), .in_data(link_rx_data),
        .in_ready(link_rx_ready),
        .out_clk(clk), .out_rst(rst), .out_valid(rx_valid), .out_data(rx_data), .out_ready(rx_ready));

    halfrow_async_fifo tx_queue (
        .in_clk(clk), .in_rst(rst), .in_valid(tx_valid), .in_data(tx_data), .in_ready(tx_ready),
        .out_clk(link_clk), .out_rst(link_rst), .out_valid(link_tx_valid), .out_data(link_tx_data),
        .out_ready(link_tx_ready));

    halfrow_bridge #(
        .MAX_WIDTH(MAX_WIDTH), .MAX_HEIGHT(MAX_HEIGHT),
        .POWER_UP_WIDTH(POWER_UP_WIDTH), .POWER_UP_HEIGHT(POWER_UP_HEIGHT),
        .RING_BITS(RING_BITS), .TAPS(TAPS),
        .TABLE_BANKS(TABLE_BANKS), .ROW_BANKS_IN(ROW_BANKS_IN), .ROW_BANKS_OUT(ROW_BANKS_OUT), .TRAP(TRAP),
        .GRID(GRID), .ENTRIES(ENTRIES),
        .BUILD(BUILD), .NATURE(NATURE), .NAME(NAME)
    ) bridge (
        .clk(clk), .rst(rst), .rx_valid(rx_valid), .rx_data(rx_data), .rx_ready(rx_ready),
        .tx_valid(tx_valid), .tx_data(tx_data), .tx_ready(tx_ready),
        .millisecond(millisecond), .clock_source(clock_source), .clock_hz(clock_hz), .serial(serial),
        .camera_frame_valid(camera_frame_valid), .camera_line_valid(camera_line_valid), .camera_data(camera_data),
        .isp_frame_valid(isp_frame_valid), .isp_line_valid(isp_line_valid), .isp_data(isp_data),
        .camera_fault(camera_fault), .session_open(session_open), .packet_seen(packet_seen), .quiet(quiet));
endmodule

`default_nettype wire
