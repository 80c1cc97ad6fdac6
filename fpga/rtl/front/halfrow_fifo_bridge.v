// The board behind an FT2232H or FT232H as asynchronous FIFO: its pins and the link's clock on one side,
// halfrow_bridge and the core's clock on the other. WR# and SIWU# are left alone until a packet has arrived whole:
// only then is the chip known to be a FIFO and no UART that drives these pins itself.
`default_nettype none

module halfrow_fifo_bridge #(
    // halfrow_ft245's times, in link clocks
    parameter SETUP = 1,
    parameter PULSE = 4,
    parameter RECOVER = 6,
    parameter QUIET = 1000,
    parameter STROBE = 32,
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
    input  wire        ft_rxf_n,
    input  wire        ft_txe_n,
    output wire        ft_rd_n,
    output wire        ft_wr_n,
    output wire        ft_siwu_n,
    output wire        ft_control_drive, // of WR# and SIWU#
    input  wire [7:0]  ft_data_in,
    output wire [7:0]  ft_data_out,
    output wire        ft_data_drive,

    input  wire        clk,              // the core's; both resets are held together
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

    reg proven;
    (* ASYNC_REG = "TRUE" *) reg [1:0] armed; // [1] is synchronous to link_clk

    always @(posedge clk)
        if (rst)
            proven <= 1'b0;
        else if (packet_seen)
            proven <= 1'b1;

    // With a reset it stays two registers and becomes no shift register.
    always @(posedge link_clk)
        if (link_rst)
            armed <= 2'b00;
        else
            armed <= {armed[0], proven};

    halfrow_ft245 #(
        .SETUP(SETUP), .PULSE(PULSE), .RECOVER(RECOVER), .QUIET(QUIET), .STROBE(STROBE)
    ) ft245 (
        .clk(link_clk), .rst(link_rst), .armed(armed[1]),
        .ft_rxf_n(ft_rxf_n), .ft_txe_n(ft_txe_n), .ft_rd_n(ft_rd_n), .ft_wr_n(ft_wr_n), .ft_siwu_n(ft_siwu_n),
        .ft_control_drive(ft_control_drive), .ft_data_in(ft_data_in), .ft_data_out(ft_data_out),
        .ft_data_drive(ft_data_drive),
        .rx_valid(link_rx_valid), .rx_data(link_rx_data), .rx_ready(link_rx_ready),
        .tx_valid(link_tx_valid), .tx_data(link_tx_data), .tx_ready(link_tx_ready));

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
