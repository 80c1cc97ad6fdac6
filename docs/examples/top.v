// The least that a board needs around halfrow_uart_bridge: a clock of 96 MHz, a reset, a UART of 12 Mbaud. No camera, one
// lamp. A board of this project has more in its top (fpga/boards/common/board.v).
`default_nettype none

module top (
    input  wire clk,   // 96 MHz: eight clocks a bit
    input  wire rxd,   // from the USB chip
    output wire txd,
    output wire rts_n, // low: the chip may send
    input  wire cts_n, // low: the board may send
    output wire lamp   // a session is open
);
    // The reset of the first sixteen clocks.
    reg [4:0] awake = 5'd0;
    wire rst = !awake[4];
    always @(posedge clk) if (rst) awake <= awake + 5'd1;

    // A pulse each millisecond, by which sessions age.
    reg [16:0] count = 17'd0;
    wire millisecond = count == 17'd95999;
    always @(posedge clk) count <= millisecond ? 17'd0 : count + 17'd1;

    wire isp_frame_valid, isp_line_valid, camera_fault, packet_seen, quiet;
    wire [11:0] isp_data;
    wire unused = &{1'b0, isp_frame_valid, isp_line_valid, isp_data, camera_fault, packet_seen, quiet};

    halfrow_uart_bridge #(.DIVIDER(8), .TRAP(0), .NAME("my first board")) bridge (
        .link_clk(clk), .link_rst(rst), .rxd(rxd), .txd(txd), .rts_n(rts_n), .cts_n(cts_n),
        .clk(clk), .rst(rst), .millisecond(millisecond), .clock_source(8'd2), .clock_hz(32'd96_000_000), .serial(64'd0),
        .camera_frame_valid(1'b0), .camera_line_valid(1'b0), .camera_data(12'd0),
        .isp_frame_valid(isp_frame_valid), .isp_line_valid(isp_line_valid), .isp_data(isp_data), .camera_fault(camera_fault),
        .session_open(lamp), .packet_seen(packet_seen), .quiet(quiet));
endmodule
